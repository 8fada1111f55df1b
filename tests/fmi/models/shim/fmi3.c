#include <stdlib.h>
#include <string.h>
#include "fmi3Functions.h"
#include "instance.h"

#define REFUSED fmi3Error

static void refuse(Instance *instance, const char *function, const char *why) {
    char text[160];
    strncpy(text, function, 80); text[80] = 0; strcat(text, " "); strncat(text, why, 70);
    ((fmi3LogMessageCallback)instance->log)(instance->environment, fmi3Error, "error", text);
}

const char *fmi3GetVersion(void) { return "3.0"; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[]) {
    (void)c; (void)on; (void)n; (void)categories; return fmi3OK;
}

static Instance *create(fmi3String name, fmi3String token, void *environment, fmi3LogMessageCallback log) {
    Instance *instance = calloc(1, sizeof *instance);
    instance->environment = environment; instance->log = (void (*)(void))log;
    if (strcmp(token, MODEL_TOKEN)) { refuse(instance, "instantiation", "with another token"); free(instance); return NULL; }
    strncpy(instance->name, name, 63);
    instance->state.mode = INSTANTIATED;
    model_start(&V);
    return instance;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
        fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log) {
    (void)path; (void)visible; (void)logging;
    return create(name, token, environment, log);
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
        fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference required[], size_t n,
        fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    (void)path; (void)visible; (void)logging; (void)required; (void)n; (void)update;
    Instance *instance = create(name, token, environment, log);
    if (instance) { instance->is_co_simulation = true; instance->uses_events = events; instance->is_early_allowed = early; }
    return instance;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String path, fmi3Boolean visible,
        fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
        fmi3ClockUpdateCallback update, fmi3LockPreemptionCallback lock, fmi3UnlockPreemptionCallback unlock) {
    (void)name; (void)token; (void)path; (void)visible; (void)logging; (void)environment; (void)log; (void)update;
    (void)lock; (void)unlock; return NULL;
}

void fmi3FreeInstance(fmi3Instance c) { free(c); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
        fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
    IN_MODES(INSTANTIATED, "fmi3EnterInitializationMode")
    (void)has_tolerance; (void)tolerance; (void)has_stop; (void)stop;
    V.time = start; instance->state.mode = INITIALISATION;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    IN_MODES(INITIALISATION, "fmi3ExitInitializationMode")
    instance->state.mode = instance->is_co_simulation && !instance->uses_events ? STEP : EVENT;
    return fmi3OK;
}

fmi3Status fmi3EnterEventMode(fmi3Instance c) {
    IN_MODES(STEP | CONTINUOUS, "fmi3EnterEventMode")
    if (instance->is_co_simulation && !instance->uses_events) { refuse(instance, "Event Mode", "is not used"); return fmi3Error; }
    instance->state.mode = EVENT; return fmi3OK;
}
fmi3Status fmi3EnterStepMode(fmi3Instance c) { IN_MODES(EVENT, "fmi3EnterStepMode") instance->state.mode = STEP; return fmi3OK; }
fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) {
    IN_MODES(EVENT, "fmi3EnterContinuousTimeMode") instance->state.mode = CONTINUOUS; return fmi3OK;
}
fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) {
    IN_MODES(INSTANTIATED, "fmi3EnterConfigurationMode") instance->state.mode = CONFIGURATION; return fmi3OK;
}
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) {
    IN_MODES(CONFIGURATION, "fmi3ExitConfigurationMode") instance->state.mode = INSTANTIATED; return fmi3OK;
}
fmi3Status fmi3Terminate(fmi3Instance c) {
    IN_MODES(EVENT | STEP | CONTINUOUS, "fmi3Terminate") instance->state.mode = TERMINATED; return fmi3OK;
}
fmi3Status fmi3Reset(fmi3Instance c) {
    Instance *instance = c; memset(&V, 0, sizeof V); model_start(&V); instance->state.mode = INSTANTIATED; return fmi3OK;
}

static bool is_settable(Instance *instance, unsigned r) {
    if (instance->state.mode == STEP && instance->uses_events && model_is_discrete(r)) {
        refuse(instance, "a discrete input", "cannot be set in Step Mode"); return false;
    }
    if (instance->state.mode == CONTINUOUS && model_is_discrete(r)) {
        refuse(instance, "a discrete input", "cannot be set in Continuous-Time Mode"); return false;
    }
    return instance->state.mode & ~(TERMINATED | FAILED);
}

/* Every element of every reference, in order; stops where the caller's array ends. */
#define ACCESS(Name, type, field, cast)                                                                          \
    fmi3Status fmi3Get##Name(fmi3Instance c, const fmi3ValueReference r[], size_t n, type values[], size_t count) { \
        IN_MODES(~(FAILED | INSTANTIATED | CONFIGURATION), "fmi3Get" #Name)                                      \
        model_outputs(&V);                                                                                       \
        size_t k = 0;                                                                                            \
        for (size_t i = 0; i < n; i++) {                                                                         \
            if (!model_is_readable(r[i])) { refuse(instance, "fmi3Get" #Name, "refuses this variable"); return fmi3Error; } \
            for (size_t j = 0; j < model_size(&V, r[i]); j++) {                                                  \
                if (k == count) { refuse(instance, "fmi3Get" #Name, "has too few values"); return fmi3Error; }   \
                values[k++] = (cast)V.field[r[i]][j];                                                            \
            }                                                                                                    \
        }                                                                                                        \
        return k == count ? fmi3OK : fmi3Error;                                                                  \
    }                                                                                                            \
    fmi3Status fmi3Set##Name(fmi3Instance c, const fmi3ValueReference r[], size_t n, const type values[], size_t count) { \
        IN_MODES(~FAILED, "fmi3Set" #Name)                                                                       \
        size_t k = 0;                                                                                            \
        for (size_t i = 0; i < n; i++) {                                                                         \
            if (!is_settable(instance, r[i])) return fmi3Error;                                                  \
            for (size_t j = 0; j < model_size(&V, r[i]); j++) {                                                  \
                if (k == count) { refuse(instance, "fmi3Set" #Name, "has too few values"); return fmi3Error; }   \
                V.field[r[i]][j] = values[k++];                                                                  \
            }                                                                                                    \
        }                                                                                                        \
        return k == count ? fmi3OK : fmi3Error;                                                                  \
    }
ACCESS(Float32, fmi3Float32, number, float)
ACCESS(Float64, fmi3Float64, number, double)
ACCESS(Int8, fmi3Int8, whole, fmi3Int8)
ACCESS(UInt8, fmi3UInt8, whole, fmi3UInt8)
ACCESS(Int16, fmi3Int16, whole, fmi3Int16)
ACCESS(UInt16, fmi3UInt16, whole, fmi3UInt16)
ACCESS(Int32, fmi3Int32, whole, fmi3Int32)
ACCESS(UInt32, fmi3UInt32, whole, fmi3UInt32)
ACCESS(Int64, fmi3Int64, whole, fmi3Int64)
ACCESS(UInt64, fmi3UInt64, whole, fmi3UInt64)
ACCESS(Boolean, fmi3Boolean, whole, fmi3Boolean)

#define EACH_ELEMENT size_t k = 0; for (size_t i = 0; i < n; i++) for (size_t j = 0; j < model_size(&V, r[i]); j++)

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3String values[], size_t count) {
    IN_MODES(~(FAILED | INSTANTIATED | CONFIGURATION), "fmi3GetString")
    model_outputs(&V);
    EACH_ELEMENT values[k++] = V.bytes[r[i]][j];
    return k == count ? fmi3OK : fmi3Error;
}
fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3String values[], size_t count) {
    IN_MODES(~FAILED, "fmi3SetString")
    EACH_ELEMENT { V.length[r[i]][j] = strlen(values[k]); strncpy(V.bytes[r[i]][j], values[k++], BYTES - 1); }
    return k == count ? fmi3OK : fmi3Error;
}
fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n, size_t sizes[], fmi3Binary values[], size_t count) {
    IN_MODES(~(FAILED | INSTANTIATED | CONFIGURATION), "fmi3GetBinary")
    model_outputs(&V);
    EACH_ELEMENT { sizes[k] = V.length[r[i]][j]; values[k++] = (fmi3Binary)V.bytes[r[i]][j]; }
    return k == count ? fmi3OK : fmi3Error;
}
fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n, const size_t sizes[], const fmi3Binary values[], size_t count) {
    IN_MODES(~FAILED, "fmi3SetBinary")
    EACH_ELEMENT {
        if (sizes[k] > BYTES) { refuse(instance, "fmi3SetBinary", "takes 32 bytes at most"); return fmi3Error; }
        V.length[r[i]][j] = sizes[k]; memcpy(V.bytes[r[i]][j], values[k], sizes[k]); k++;
    }
    return k == count ? fmi3OK : fmi3Error;
}
fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Clock values[]) {
    IN_MODES(EVENT, "fmi3GetClock")
    for (size_t i = 0; i < n; i++) values[i] = V.whole[r[i]][0] != 0;
    return fmi3OK;
}
fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Clock values[]) {
    IN_MODES(EVENT, "fmi3SetClock")
    for (size_t i = 0; i < n; i++) V.whole[r[i]][0] = values[i];
    return fmi3OK;
}
fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]) {
    IN_MODES(EVENT, "fmi3GetIntervalDecimal")
    for (size_t i = 0; i < n; i++) {
        intervals[i] = V.number[r[i]][0];
        qualifiers[i] = V.whole[r[i]][1] ? fmi3IntervalChanged : V.number[r[i]][0] > 0 ? fmi3IntervalUnchanged : fmi3IntervalNotYetKnown;
        V.whole[r[i]][1] = 0;
    }
    return fmi3OK;
}
fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 shifts[]) {
    IN_MODES(EVENT, "fmi3GetShiftDecimal")
    for (size_t i = 0; i < n; i++) shifts[i] = V.number[r[i]][1];
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    Instance *instance = c;
    if (!*state) *state = malloc(sizeof(State));
    memcpy(*state, &instance->state, sizeof(State)); return fmi3OK;
}
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { memcpy(&((Instance *)c)->state, state, sizeof(State)); return fmi3OK; }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) { (void)c; free(*state); *state = NULL; return fmi3OK; }
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) { Instance *instance = c; (void)state; *size = model_state_size(&V) ? model_state_size(&V) : sizeof(State); return fmi3OK; }
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte data[], size_t size) { (void)c; memcpy(data, state, size); return fmi3OK; }
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte data[], size_t size, fmi3FMUState *state) {
    (void)c; if (size != sizeof(State)) return fmi3Error;
    if (!*state) *state = malloc(size);
    memcpy(*state, data, size); return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate, fmi3Boolean *nominals,
        fmi3Boolean *states, fmi3Boolean *defined, fmi3Float64 *next) {
    IN_MODES(EVENT, "fmi3UpdateDiscreteStates")
    Event e = model_event(&V);
    *again = e.again; *terminate = e.terminate; *nominals = e.nominals; *states = e.states; *defined = e.defined; *next = e.next;
    return fmi3OK;
}
fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean final, fmi3Boolean *event, fmi3Boolean *terminate) {
    IN_MODES(CONTINUOUS, "fmi3CompletedIntegratorStep")
    (void)final; *event = model_completed(&V); *terminate = false; return fmi3OK;
}
fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) { IN_MODES(CONTINUOUS, "fmi3SetTime") V.time = time; return fmi3OK; }
fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    IN_MODES(CONTINUOUS, "fmi3SetContinuousStates")
    for (size_t i = 0; i < n; i++) V.number[MODEL_FIRST_STATE + i][0] = x[i];
    return fmi3OK;
}
fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    Instance *instance = c; for (size_t i = 0; i < n; i++) x[i] = V.number[MODEL_FIRST_STATE + i][0]; return fmi3OK;
}
fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dx[], size_t n) {
    IN_MODES(CONTINUOUS, "fmi3GetContinuousStateDerivatives")
    model_outputs(&V);
    for (size_t i = 0; i < n; i++) dx[i] = V.number[MODEL_FIRST_DERIVATIVE + i][0];
    return fmi3OK;
}
fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) {
    IN_MODES(CONTINUOUS | EVENT, "fmi3GetEventIndicators") (void)n; model_indicators(&V, z); return fmi3OK;
}
fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) { (void)c; for (size_t i = 0; i < n; i++) x[i] = 1; return fmi3OK; }
fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *n) { (void)c; *n = MODEL_INDICATORS; return fmi3OK; }
fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *n) { (void)c; *n = MODEL_STATES; return fmi3OK; }

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 size, fmi3Boolean final, fmi3Boolean *event,
        fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *reached) {
    IN_MODES(STEP, "fmi3DoStep")
    (void)final;
    if (time - V.time > 1e-9 || V.time - time > 1e-9) { refuse(instance, "fmi3DoStep", "does not begin where the last step ended"); return fmi3Error; }
    Step s = step_through(instance, time + size);
    *event = s.event && instance->uses_events; *terminate = s.terminate; *early = s.reached < time + size; *reached = s.reached;
    if (s.verdict == STEP_FAILED) { instance->state.mode = FAILED; refuse(instance, "fmi3DoStep", "fails as it was told to"); return fmi3Error; }
    return s.verdict == STEP_DISCARDED ? fmi3Discard : fmi3OK;
}

/* What no test model offers. */
#define ABSENT(name, ...) fmi3Status name(__VA_ARGS__) { return fmi3Error; }
ABSENT(fmi3GetNumberOfVariableDependencies, fmi3Instance c, fmi3ValueReference r, size_t *n)
ABSENT(fmi3GetVariableDependencies, fmi3Instance c, fmi3ValueReference r, size_t a[], fmi3ValueReference b[], size_t d[], fmi3DependencyKind e[], size_t n)
ABSENT(fmi3GetDirectionalDerivative, fmi3Instance c, const fmi3ValueReference u[], size_t nu, const fmi3ValueReference k[], size_t nk, const fmi3Float64 s[], size_t ns, fmi3Float64 d[], size_t nd)
ABSENT(fmi3GetAdjointDerivative, fmi3Instance c, const fmi3ValueReference u[], size_t nu, const fmi3ValueReference k[], size_t nk, const fmi3Float64 s[], size_t ns, fmi3Float64 d[], size_t nd)
ABSENT(fmi3GetIntervalFraction, fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[], fmi3IntervalQualifier q[])
ABSENT(fmi3GetShiftFraction, fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3UInt64 a[], fmi3UInt64 b[])
ABSENT(fmi3SetIntervalDecimal, fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 a[])
ABSENT(fmi3SetIntervalFraction, fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[])
ABSENT(fmi3SetShiftDecimal, fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 a[])
ABSENT(fmi3SetShiftFraction, fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3UInt64 a[], const fmi3UInt64 b[])
ABSENT(fmi3EvaluateDiscreteStates, fmi3Instance c)
ABSENT(fmi3GetOutputDerivatives, fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Int32 o[], fmi3Float64 v[], size_t nv)
ABSENT(fmi3ActivateModelPartition, fmi3Instance c, fmi3ValueReference r, fmi3Float64 t)
