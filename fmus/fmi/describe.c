/* Writes modelDescription.xml (`describe 2`, `describe 3`) or buildDescription.xml (`describe build`) of the model that
 * it is compiled with to standard output. Run by make; not part of the FMU. */
#include "describe.h"

#include <stdio.h>
#include <string.h>

#include "variables.h"

/* The units of all models with their exponents of the SI base units. A config.h with further ones defines MODEL_UNITS,
 * rows of this table with a comma after each. */
static const struct {
    const char *name;
    int kg, m, s, A, K;
} units[] = {
    {"1", 0, 0, 0, 0, 0},           {"s", 0, 0, 1, 0, 0},       {"K", 0, 0, 0, 0, 1},      {"m", 0, 1, 0, 0, 0},
    {"m^2", 0, 2, 0, 0, 0},         {"m^3", 0, 3, 0, 0, 0},     {"W", 1, 2, -3, 0, 0},     {"J", 1, 2, -2, 0, 0},
    {"ohm", 1, 2, -3, -2, 0},       {"N/m", 1, 0, -2, 0, 0},    {"K/s", 0, 0, -1, 0, 1},   {"1/K", 0, 0, 0, 0, -1},
    {"1/s", 0, 0, -1, 0, 0},        {"kg/m^3", 1, -3, 0, 0, 0}, {"J/(kg*K)", 0, 2, -2, 0, -1},
    {"W/(m^2*K)", 1, 0, -3, 0, -1}, {"N", 1, 1, -2, 0, 0},      {"Pa", 1, -1, -2, 0, 0},   {"Pa/K", 1, -1, -2, 0, -1},
    {"J/kg", 0, 2, -2, 0, 0},       {"ohm*m", 1, 3, -3, -2, 0}, {"J/K", 1, 2, -2, 0, -1},  {"W/K", 1, 2, -3, 0, -1},
    {"V", 1, 2, -3, -1, 0},         {"A", 0, 0, 0, 1, 0},       {"C", 0, 0, 1, 1, 0},      {"m^2/s", 0, 2, -1, 0, 0},
    {"F/m^3", -1, -5, 4, 2, 0},     {"m^3/C", 0, 3, -1, -1, 0},
#ifdef MODEL_UNITS
    MODEL_UNITS
#endif
};

static void write_exponent(const char *base, int exponent)
{
    if (exponent != 0) {
        printf(" %s=\"%d\"", base, exponent);
    }
}

/* Whether every unit of the table is known. */
static bool write_units(void)
{
    printf("  <UnitDefinitions>\n");
    size_t found = 0;
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        size_t uses = 0;
        for (size_t j = 0; j < VARIABLE_COUNT; j++) {
            uses += strcmp(model_variables[j].unit, units[i].name) == 0;
        }
        found += uses;
        if (uses > 0) {
            printf("    <Unit name=\"%s\">\n      <BaseUnit", units[i].name);
            write_exponent("kg", units[i].kg);
            write_exponent("m", units[i].m);
            write_exponent("s", units[i].s);
            write_exponent("A", units[i].A);
            write_exponent("K", units[i].K);
            printf("/>\n    </Unit>\n");
        }
    }
    printf("  </UnitDefinitions>\n");
    return found == VARIABLE_COUNT;
}

static void write_header(int version)
{
    char token[TOKEN_SIZE];
    instantiation_token(version, token);
    const bool is_3 = version == 3;
    printf("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription\n  fmiVersion=\"%d.0\"\n"
           "  modelName=\"%s\"\n  %s=\"%s\"\n  description=\"%s\"\n  license=\"GPL-3.0-or-later\"\n"
           "  generationTool=\"describe.c\"\n  variableNamingConvention=\"structured\"%s>\n",
           version, MODEL_IDENTIFIER, is_3 ? "instantiationToken" : "guid", token, MODEL_DESCRIPTION,
           is_3 ? "" : "\n  numberOfEventIndicators=\"0\"");
#ifdef MODEL_CO_SIMULATION_ONLY
    const int first = 1;
#else
    const int first = 0;
#endif
    for (int interface = first; interface < 2; interface++) {
        const char *state = is_3 ? "State" : "state";
        printf("  <%s\n    modelIdentifier=\"%s\"\n    canGetAndSetFMU%s=\"true\"\n    canSerializeFMU%s=\"true\"\n",
               interface == 0 ? "ModelExchange" : "CoSimulation", MODEL_IDENTIFIER, state, state);
        if (interface == 0) {
            printf("    %s",
                   is_3 ? "needsCompletedIntegratorStep=\"true\"" : "completedIntegratorStepNotNeeded=\"false\"");
        } else {
            printf("    canHandleVariableCommunicationStepSize=\"true\"");
        }
        if (is_3) {
            printf("/>\n");
        } else {
            printf("\n    canNotUseMemoryManagementFunctions=\"true\">\n    <SourceFiles>\n");
            write_source_files("      ", version);
            printf("    </SourceFiles>\n  </%s>\n", interface == 0 ? "ModelExchange" : "CoSimulation");
        }
    }
}

static const char *const shared_sources[] = {"model.c", "variables.c", "instance.c", "states.c", "snapshot.c"};
static const char *const version_sources[] = {"", "_state", "_model_exchange", "_absent"};

void write_source_files(const char *indent, int version)
{
    const char *element = version == 3 ? "SourceFile" : "File";
    for (size_t i = 0; i < sizeof shared_sources / sizeof *shared_sources; i++) {
        printf("%s<%s name=\"%s\"/>\n", indent, element, shared_sources[i]);
    }
    for (size_t i = 0; i < sizeof version_sources / sizeof *version_sources; i++) {
        printf("%s<%s name=\"fmi%d%s.c\"/>\n", indent, element, version, version_sources[i]);
    }
}

static void write_build_description(void)
{
    printf("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n"
           "  <BuildConfiguration modelIdentifier=\"%s\">\n    <SourceFileSet language=\"C99\">\n", MODEL_IDENTIFIER);
    write_source_files("      ", 3);
    printf("    </SourceFileSet>\n    <Library name=\"m\"/>\n  </BuildConfiguration>\n</fmiBuildDescription>\n");
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: describe 2|3|build\n");
        return 2;
    }
    if (strcmp(argv[1], "build") == 0) {
        write_build_description();
        return 0;
    }
    const int version = strcmp(argv[1], "2") == 0 ? 2 : 3;
    write_header(version);
    if (!write_units()) {
        fprintf(stderr, "describe: config.h uses a unit that describe.c does not define\n");
        return 1;
    }
    printf("  <LogCategories>\n    <Category name=\"logStatusError\" description=\"Why a call was refused\"/>\n"
           "  </LogCategories>\n  <DefaultExperiment startTime=\"0.0\" stopTime=\"%.17g\" stepSize=\"%.17g\"/>\n",
           MODEL_STOP_TIME, MODEL_STEP_SIZE);
    if (version == 2) {
        write_variables_fmi2();
    } else {
        write_variables_fmi3();
    }
    printf("</fmiModelDescription>\n");
    return 0;
}
