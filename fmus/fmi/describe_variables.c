/* ModelVariables and ModelStructure, from the table. FMI 3.0 has one variable per row, FMI 2.0 one per element. */
#include <stdio.h>
#include <string.h>

#include "describe.h"
#include "variables.h"

/* Whether the blank-separated list `names` holds `name`; with is_initial also if it holds `@name`, which means: in
 * Initialization Mode alone. */
static bool holds(const char *names, const char *name, bool is_initial)
{
    const size_t length = strlen(name);
    for (const char *at = strstr(names, name); at != NULL; at = strstr(at + 1, name)) {
        const char *begin = is_initial && at > names && at[-1] == '@' ? at - 1 : at;
        if ((begin == names || begin[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) {
            return true;
        }
    }
    return false;
}

/* Whether unknown i depends directly on variable j. In Initialization Mode the states themselves are computed from the
 * parameters, which are listed all. */
static bool depends_on(size_t i, size_t j, bool is_initial)
{
    const Role role = model_variables[j].role;
    if (is_initial && (role == ROLE_PARAMETER || role == ROLE_FLAG)) {
        return true;
    }
    return holds(model_variables[i].depends, model_variables[j].name, is_initial) &&
           !(is_initial && role == ROLE_STATE);
}

static void write_causality(Role role)
{
    switch (role) {
    case ROLE_TIME: printf(" causality=\"independent\" variability=\"continuous\""); break;
    case ROLE_STRUCTURE: printf(" causality=\"structuralParameter\" variability=\"fixed\""); break;
    case ROLE_INPUT: printf(" causality=\"input\" variability=\"continuous\""); break;
    case ROLE_STATE:
    case ROLE_OUTPUT: printf(" causality=\"output\" variability=\"continuous\" initial=\"calculated\""); break;
    case ROLE_DERIVATIVE: printf(" causality=\"local\" variability=\"continuous\" initial=\"calculated\""); break;
    default: printf(" causality=\"parameter\" variability=\"fixed\"");
    }
}

static bool has_start(Role role)
{
    return role == ROLE_INPUT || role == ROLE_PARAMETER;
}

/* Melting points [K]: 1300 degC of NiTi (data sheets of suppliers: 1300 to 1310 degC), 265 degC of nylon 6,6. */
static double melting_point(Limit limit)
{
    return limit == SOLID_NITI ? 1573.15 : limit == SOLID_NYLON ? 538.15 : 0.0;
}

/* Attributes of a real variable but its causality, start and derivative. */
static void write_quantity(const Variable *v)
{
    printf(" unit=\"%s\"", v->unit);
    if (v->limit != ANY) {
        printf(" min=\"0\"");
    }
    if (melting_point(v->limit) > 0.0) {
        printf(" max=\"%.17g\"", melting_point(v->limit));
    }
    if (v->nominal != 1.0) {
        printf(" nominal=\"%.17g\"", v->nominal);
    }
}

static void write_arrays(void)
{
    size_t rank = 0;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        const Variable *v = &model_variables[i];
        if (v->role == ROLE_HIDDEN) {
            continue;
        }
        const char *type = v->role == ROLE_STRUCTURE ? "UInt64" : v->role == ROLE_FLAG ? "Boolean" : "Float64";
        printf("    <%s name=\"%s\" valueReference=\"%zu\" description=\"%s\"", type, v->name, i, v->description);
        write_causality(v->role);
        if (v->role == ROLE_STRUCTURE) {
            printf(" min=\"%d\" max=\"%d\" start=\"%d\"", MINIMUM_COILS, MAXIMUM_COILS, (int)v->start);
        } else if (v->role == ROLE_FLAG) {
            printf(" start=\"%s\"", v->start != 0.0 ? "true" : "false");
        } else {
            write_quantity(v);
            if (v->role == ROLE_DERIVATIVE) {
                printf(" derivative=\"%zu\"", role_member(ROLE_STATE, rank++));
            }
            if (has_start(v->role)) {
                printf(" start=\"%.17g\"", v->start);
            }
        }
        if (v->extent == PER_COIL) {
            printf(">\n      <Dimension valueReference=\"%d\"/>\n    </%s>\n", VAR_coils, type);
        } else {
            printf("/>\n");
        }
    }
}

static void write_structure(void)
{
    const char *const elements[] = {"Output", "ContinuousStateDerivative", "InitialUnknown"};
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = 0; i < VARIABLE_COUNT; i++) {
            const Role role = model_variables[i].role;
            const bool is_output = role == ROLE_STATE || role == ROLE_OUTPUT, is_derivative = role == ROLE_DERIVATIVE;
            if (!(pass == 0 ? is_output : pass == 1 ? is_derivative : is_output || is_derivative)) {
                continue;
            }
            printf("    <%s valueReference=\"%zu\" dependencies=\"", elements[pass], i);
            const char *separator = "";
            for (size_t j = 0; j < VARIABLE_COUNT; j++) {
                if (depends_on(i, j, pass == 2)) {
                    printf("%s%zu", separator, j);
                    separator = " ";
                }
            }
            printf("\"/>\n");
        }
    }
}

void write_variables_fmi3(void)
{
    printf("  <ModelVariables>\n");
    write_arrays();
    printf("  </ModelVariables>\n  <ModelStructure>\n");
    write_structure();
    printf("  </ModelStructure>\n");
}

/* Where the first element of variable i stands among the scalars of FMI 2.0, from 1. */
static size_t first_index(size_t i)
{
    size_t index = 1;
    for (size_t j = 0; j < i; j++) {
        const Role role = model_variables[j].role;
        index += role == ROLE_HIDDEN || role == ROLE_STRUCTURE ? 0 : variable_size(&model_variables[j], COILS);
    }
    return index;
}

/* Position of the first element of variable i in the block of values: its FMI 2.0 value reference. */
static size_t first_reference(size_t i)
{
    size_t reference = 0;
    for (size_t j = 0; j < i; j++) {
        reference += variable_size(&model_variables[j], COILS);
    }
    return reference;
}

/* `power[3]`, and `der(temperature[3])` for `der(temperature)`. */
static void write_name(const Variable *v, size_t element)
{
    const size_t length = strlen(v->name);
    if (v->extent == SCALAR) {
        printf("%s", v->name);
    } else if (v->name[length - 1] == ')') {
        printf("%.*s[%zu])", (int)length - 1, v->name, element + 1);
    } else {
        printf("%s[%zu]", v->name, element + 1);
    }
}

static void write_scalar(size_t i, size_t element, size_t rank)
{
    const Variable *v = &model_variables[i];
    printf("    <ScalarVariable name=\"");
    write_name(v, element);
    printf("\" valueReference=\"%zu\" description=\"%s\"", first_reference(i) + element, v->description);
    write_causality(v->role);
    if (v->role == ROLE_FLAG) {
        printf("><Boolean start=\"%s\"/></ScalarVariable>\n", v->start != 0.0 ? "true" : "false");
        return;
    }
    printf("><Real");
    write_quantity(v);
    if (v->role == ROLE_DERIVATIVE) {
        printf(" derivative=\"%zu\"", first_index(role_member(ROLE_STATE, rank)) + element);
    }
    if (has_start(v->role)) {
        printf(" start=\"%.17g\"", v->start);
    }
    printf("/></ScalarVariable>\n");
}

/* One section of ModelStructure. An element depends on the same element of other arrays, and on scalars. */
static void write_unknowns(const char *section, bool outputs, bool derivatives, bool is_initial)
{
    if (!outputs && role_count(ROLE_DERIVATIVE) == 0) {
        return; /* the schema wants at least one */
    }
    printf("    <%s>\n", section);
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        const Variable *v = &model_variables[i];
        const bool is_output = v->role == ROLE_STATE || v->role == ROLE_OUTPUT;
        if (!((outputs && is_output) || (derivatives && v->role == ROLE_DERIVATIVE))) {
            continue;
        }
        for (size_t element = 0; element < variable_size(v, COILS); element++) {
            printf("      <Unknown index=\"%zu\" dependencies=\"", first_index(i) + element);
            const char *separator = "";
            for (size_t j = 0; j < VARIABLE_COUNT; j++) {
                if (depends_on(i, j, is_initial)) {
                    printf("%s%zu", separator, first_index(j) + (model_variables[j].extent == PER_COIL ? element : 0));
                    separator = " ";
                }
            }
            printf("\"/>\n");
        }
    }
    printf("    </%s>\n", section);
}

void write_variables_fmi2(void)
{
    printf("  <ModelVariables>\n");
    size_t rank = 0;
    for (size_t i = 0; i < VARIABLE_COUNT; i++) {
        const Role role = model_variables[i].role;
        if (role == ROLE_HIDDEN || role == ROLE_STRUCTURE) {
            continue;
        }
        for (size_t element = 0; element < variable_size(&model_variables[i], COILS); element++) {
            write_scalar(i, element, rank);
        }
        rank += role == ROLE_DERIVATIVE;
    }
    printf("  </ModelVariables>\n  <ModelStructure>\n");
    write_unknowns("Outputs", true, false, false);
    write_unknowns("Derivatives", false, true, false);
    write_unknowns("InitialUnknowns", true, true, true);
    printf("  </ModelStructure>\n");
}
