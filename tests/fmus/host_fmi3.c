/* A plain C importer of an FMI 3.0 FMU, run under valgrind: both life cycles, with refusals and saved states.
 * Usage: host TOKEN STATES; the FMU is linked to it. Exit code: the line of the first check that failed (modulo 200, plus 1).
 */
#include <fmi3Functions.h>
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

enum { COILS = 288, REFERENCE_COILS = 1, REFERENCE_DRIVE = 2 };  /* places in the table: asserted by the test */

static int messages = 0;

static void log_message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment, (void)category;
    CHECK(status == fmi3Error && message != NULL && message[0] != '\0');
    messages++;
}

static void resize(fmi3Instance f)
{
    const fmi3ValueReference coils = REFERENCE_COILS;
    const fmi3UInt64 size = COILS, none = 0, huge = UINT64_MAX;
    CHECK(fmi3SetUInt64(f, &coils, 1, &size, 1) == fmi3Error);
    CHECK(fmi3EnterConfigurationMode(f) == fmi3OK);
    CHECK(fmi3SetUInt64(f, &coils, 1, &none, 1) == fmi3Error);
    CHECK(fmi3SetUInt64(f, &coils, 1, &huge, 1) == fmi3Error);
    CHECK(fmi3SetUInt64(f, &coils, 1, &size, 1) == fmi3OK);
    CHECK(fmi3ExitConfigurationMode(f) == fmi3OK);
}

static void set_drive(fmi3Instance f, double value, fmi3Status expected)
{
    const fmi3ValueReference drive = REFERENCE_DRIVE;
    double values[COILS];
    for (int i = 0; i < COILS; i++) {
        values[i] = value;
    }
    CHECK(fmi3SetFloat64(f, &drive, 1, values, COILS) == expected);
    CHECK(fmi3GetFloat64(f, &drive, 1, values, COILS) == fmi3OK);
}

static void step(fmi3Instance f, double time)
{
    bool event, terminate, early;
    double reached;
    CHECK(fmi3DoStep(f, time, 0.5, true, &event, &terminate, &early, &reached) == fmi3OK && reached == time + 0.5);
}

static void co_simulation(const char *token)
{
    fmi3Instance f = fmi3InstantiateCoSimulation("coils", token, NULL, false, true, false, false, NULL, 0, NULL,
                                                 log_message, NULL);
    CHECK(f != NULL);
    resize(f);
    CHECK(fmi3EnterInitializationMode(f, false, 0.0, 0.0, false, 0.0) == fmi3OK);
    set_drive(f, 0.4, fmi3OK);
    CHECK(fmi3ExitInitializationMode(f) == fmi3OK);
    fmi3FMUState state = NULL, copy = NULL;
    for (int i = 0; i < 20; i++) {
        step(f, 0.5 * i);
        CHECK(fmi3GetFMUState(f, &state) == fmi3OK);
    }
    set_drive(f, NAN, fmi3Error);
    size_t size;
    CHECK(fmi3SerializedFMUStateSize(f, state, &size) == fmi3OK);
    fmi3Byte *bytes = malloc(size);
    CHECK(bytes != NULL);
    CHECK(fmi3SerializeFMUState(f, state, bytes, size - 1) == fmi3Error);
    CHECK(fmi3SerializeFMUState(f, state, bytes, size) == fmi3OK);
    CHECK(fmi3DeserializeFMUState(f, bytes, 3, &copy) == fmi3Error && copy == NULL);
    CHECK(fmi3DeserializeFMUState(f, bytes, size, &copy) == fmi3OK);
    CHECK(fmi3Reset(f) == fmi3OK); /* back to the number of coils at the start */
    CHECK(fmi3SetFMUState(f, copy) == fmi3OK);
    step(f, 10.0);
    CHECK(fmi3FreeFMUState(f, &state) == fmi3OK && fmi3FreeFMUState(f, &copy) == fmi3OK);
    CHECK(fmi3FreeFMUState(f, &copy) == fmi3OK);
    free(bytes);
    CHECK(fmi3Terminate(f) == fmi3OK);
    fmi3FreeInstance(f);
}

static void model_exchange(const char *token, size_t variables)
{
    fmi3Instance f = fmi3InstantiateModelExchange("coils", token, NULL, false, false, NULL, log_message);
    CHECK(f != NULL);
    resize(f);
    CHECK(fmi3EnterInitializationMode(f, true, 1e-6, 0.0, true, 1.0) == fmi3OK);
    CHECK(fmi3ExitInitializationMode(f) == fmi3OK);
    bool flags[5];
    double next;
    CHECK(fmi3UpdateDiscreteStates(f, flags, flags + 1, flags + 2, flags + 3, flags + 4, &next) == fmi3OK);
    CHECK(fmi3EnterContinuousTimeMode(f) == fmi3OK);
    set_drive(f, 0.4, fmi3OK);
    size_t count;
    CHECK(fmi3GetNumberOfContinuousStates(f, &count) == fmi3OK && count == variables * COILS);
    double *states = malloc(count * sizeof *states), *rates = malloc(count * sizeof *rates);
    CHECK(states != NULL && rates != NULL);
    CHECK(fmi3GetNominalsOfContinuousStates(f, states, count) == fmi3OK);
    CHECK(fmi3GetContinuousStates(f, states, count) == fmi3OK);
    CHECK(fmi3GetContinuousStates(f, states, count + 1) == fmi3Error);
    for (int i = 1; i <= 100; i++) {
        CHECK(fmi3SetTime(f, 0.01 * i) == fmi3OK);
        CHECK(fmi3GetContinuousStateDerivatives(f, rates, count) == fmi3OK);
        for (size_t j = 0; j < count; j++) {
            states[j] += 0.01 * rates[j];
        }
        CHECK(fmi3SetContinuousStates(f, states, count) == fmi3OK);
        CHECK(fmi3CompletedIntegratorStep(f, true, flags, flags + 1) == fmi3OK);
    }
    free(states);
    free(rates);
    fmi3FreeInstance(f); /* without terminating it */
}

int main(int argc, char **argv)
{
    CHECK(argc == 3);
    CHECK(fmi3InstantiateModelExchange("coils", "another", NULL, false, false, NULL, log_message) == NULL);
    CHECK(fmi3InstantiateModelExchange("coils", NULL, NULL, false, false, NULL, NULL) == NULL);
    co_simulation(argv[1]);
    model_exchange(argv[1], (size_t)atoi(argv[2]));
    fmi3FreeInstance(NULL);
    printf("%d refusals\n", messages);
    return 0;
}
