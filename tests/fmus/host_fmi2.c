/* A plain C importer of an FMI 2.0 FMU, run under valgrind: both life cycles, with refusals and saved states.
 * Usage: host GUID STATES; the FMU is linked to it. Exit code: the line of the first check that failed (modulo 200, plus 1).
 */
#include <fmi2Functions.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "line %d\n", __LINE__); \
            exit(__LINE__ % 200 + 1); \
        } \
    } while (0)

enum { COILS = 36, FIRST_DRIVE = 2 };  /* value reference of power[1] or voltage[1]: asserted by the test */

static int messages = 0;

static void log_message(fmi2ComponentEnvironment environment, fmi2String name, fmi2Status status, fmi2String category,
                        fmi2String message, ...)
{
    (void)environment, (void)category;
    CHECK(status == fmi2Error && name[0] == 'c' && message != NULL && message[0] != '\0');
    messages++;
}

static const fmi2CallbackFunctions callbacks = {log_message, calloc, free, NULL, NULL};

static void set_drive(fmi2Component c, double value, fmi2Status expected)
{
    fmi2ValueReference references[COILS];
    double values[COILS];
    for (int i = 0; i < COILS; i++) {
        references[i] = FIRST_DRIVE + (unsigned)(i * 7) % COILS; /* not in order */
        values[i] = value;
    }
    CHECK(fmi2SetReal(c, references, COILS, values) == expected);
    CHECK(fmi2GetReal(c, references, COILS, values) == fmi2OK);
}

static void co_simulation(const char *guid)
{
    fmi2Component c = fmi2Instantiate("coils", fmi2CoSimulation, guid, NULL, &callbacks, fmi2False, fmi2True);
    CHECK(c != NULL);
    CHECK(fmi2SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0) == fmi2OK);
    CHECK(fmi2EnterInitializationMode(c) == fmi2OK);
    set_drive(c, 0.4, fmi2OK);
    CHECK(fmi2ExitInitializationMode(c) == fmi2OK);
    fmi2FMUstate state = NULL, copy = NULL;
    for (int i = 0; i < 20; i++) {
        CHECK(fmi2DoStep(c, 0.5 * i, 0.5, fmi2True) == fmi2OK);
        CHECK(fmi2GetFMUstate(c, &state) == fmi2OK);
    }
    set_drive(c, NAN, fmi2Error);
    size_t size;
    CHECK(fmi2SerializedFMUstateSize(c, state, &size) == fmi2OK);
    fmi2Byte *bytes = malloc(size);
    CHECK(bytes != NULL);
    CHECK(fmi2SerializeFMUstate(c, state, bytes, size - 1) == fmi2Error);
    CHECK(fmi2SerializeFMUstate(c, state, bytes, size) == fmi2OK);
    CHECK(fmi2DeSerializeFMUstate(c, bytes, 3, &copy) == fmi2Error && copy == NULL);
    CHECK(fmi2DeSerializeFMUstate(c, bytes, size, &copy) == fmi2OK);
    CHECK(fmi2Reset(c) == fmi2OK);
    CHECK(fmi2SetFMUstate(c, copy) == fmi2OK);
    CHECK(fmi2DoStep(c, 10.0, 0.5, fmi2True) == fmi2OK);
    CHECK(fmi2FreeFMUstate(c, &state) == fmi2OK && fmi2FreeFMUstate(c, &copy) == fmi2OK);
    free(bytes);
    CHECK(fmi2Terminate(c) == fmi2OK);
    fmi2FreeInstance(c);
}

static void model_exchange(const char *guid, size_t count)
{
    fmi2Component c = fmi2Instantiate("coils", fmi2ModelExchange, guid, NULL, &callbacks, fmi2False, fmi2False);
    CHECK(c != NULL);
    CHECK(fmi2SetupExperiment(c, fmi2True, 1e-6, 0.0, fmi2True, 1.0) == fmi2OK);
    CHECK(fmi2EnterInitializationMode(c) == fmi2OK && fmi2ExitInitializationMode(c) == fmi2OK);
    fmi2EventInfo info;
    CHECK(fmi2NewDiscreteStates(c, &info) == fmi2OK && !info.newDiscreteStatesNeeded);
    CHECK(fmi2EnterContinuousTimeMode(c) == fmi2OK);
    set_drive(c, 0.4, fmi2OK);
    double *states = malloc(count * sizeof *states), *rates = malloc(count * sizeof *rates);
    CHECK(states != NULL && rates != NULL);
    CHECK(fmi2GetContinuousStates(c, states, count) == fmi2OK);
    CHECK(fmi2GetContinuousStates(c, states, count - 1) == fmi2Error);
    for (int i = 1; i <= 100; i++) {
        fmi2Boolean event, terminate;
        CHECK(fmi2SetTime(c, 0.01 * i) == fmi2OK);
        CHECK(fmi2GetDerivatives(c, rates, count) == fmi2OK);
        for (size_t j = 0; j < count; j++) {
            states[j] += 0.01 * rates[j];
        }
        CHECK(fmi2SetContinuousStates(c, states, count) == fmi2OK);
        CHECK(fmi2CompletedIntegratorStep(c, fmi2True, &event, &terminate) == fmi2OK);
    }
    free(states);
    free(rates);
    fmi2FreeInstance(c); /* without terminating it */
}

int main(int argc, char **argv)
{
    CHECK(argc == 3);
    CHECK(fmi2Instantiate("coils", fmi2CoSimulation, "another", NULL, &callbacks, fmi2False, fmi2False) == NULL);
    co_simulation(argv[1]);
    model_exchange(argv[1], (size_t)atoi(argv[2]));
    fmi2FreeInstance(NULL);
    printf("%d refusals\n", messages);
    return 0;
}
