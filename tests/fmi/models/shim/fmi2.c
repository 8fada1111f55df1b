#include <stdlib.h>
#include <string.h>
#include "fmi2Functions.h"
#include "instance.h"

#define REFUSED fmi2Error

static double last_successful;
static bool has_terminated;

static void refuse(Instance *instance, const char *function, const char *why) {
    const fmi2CallbackFunctions *callbacks = instance->environment;
    callbacks->logger(callbacks->componentEnvironment, instance->name, fmi2Error, "error", "%s %s", function, why);
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) {
    (void)c; (void)on; (void)n; (void)categories; return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
        const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging) {
    (void)location; (void)visible; (void)logging;
    if (strcmp(guid, MODEL_TOKEN)) return NULL;
    Instance *instance = callbacks->allocateMemory(1, sizeof *instance);
    memset(instance, 0, sizeof *instance);
    instance->environment = (void *)callbacks;
    instance->is_co_simulation = type == fmi2CoSimulation;
    strncpy(instance->name, name, 63);
    instance->state.mode = INSTANTIATED;
    model_start(&V);
    return instance;
}
void fmi2FreeInstance(fmi2Component c) { ((const fmi2CallbackFunctions *)((Instance *)c)->environment)->freeMemory(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop, fmi2Real stop) {
    IN_MODES(INSTANTIATED, "fmi2SetupExperiment")
    (void)has_tolerance; (void)tolerance;
    V.time = start; model_setup(&V, has_stop ? stop : -1.0); return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    IN_MODES(INSTANTIATED, "fmi2EnterInitializationMode") instance->state.mode = INITIALISATION; return fmi2OK;
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    IN_MODES(INITIALISATION, "fmi2ExitInitializationMode")
    if (instance->is_co_simulation) { /* no Event Mode: the first event happens here */
        Event e;
        do { e = model_event(&V); } while (e.again);
    }
    instance->state.mode = instance->is_co_simulation ? STEP : EVENT; return fmi2OK;
}
fmi2Status fmi2Terminate(fmi2Component c) { IN_MODES(EVENT | STEP | CONTINUOUS, "fmi2Terminate") instance->state.mode = TERMINATED; return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) {
    Instance *instance = c; memset(&V, 0, sizeof V); model_start(&V); instance->state.mode = INSTANTIATED; return fmi2OK;
}

#define ACCESS(Name, type, field)                                                                               \
    fmi2Status fmi2Get##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, type values[]) {          \
        IN_MODES(~(FAILED | INSTANTIATED), "fmi2Get" #Name)                                                     \
        model_outputs(&V);                                                                                      \
        for (size_t i = 0; i < n; i++) {                                                                        \
            if (!model_is_readable(r[i])) { refuse(instance, "fmi2Get" #Name, "refuses this variable"); return fmi2Error; } \
            values[i] = (type)V.field[r[i]][0];                                                                 \
        }                                                                                                       \
        return fmi2OK;                                                                                          \
    }                                                                                                           \
    fmi2Status fmi2Set##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, const type values[]) {    \
        IN_MODES(~FAILED, "fmi2Set" #Name)                                                                      \
        for (size_t i = 0; i < n; i++) {                                                                        \
            if (instance->state.mode == CONTINUOUS && model_is_discrete(r[i])) {                                \
                refuse(instance, "a discrete input", "cannot be set in Continuous-Time Mode"); return fmi2Error; \
            }                                                                                                   \
            V.field[r[i]][0] = values[i];                                                                       \
        }                                                                                                       \
        return fmi2OK;                                                                                          \
    }
ACCESS(Real, fmi2Real, number)
ACCESS(Integer, fmi2Integer, whole)
ACCESS(Boolean, fmi2Boolean, whole)
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String values[]) {
    IN_MODES(~(FAILED | INSTANTIATED), "fmi2GetString")
    model_outputs(&V);
    for (size_t i = 0; i < n; i++) values[i] = V.bytes[r[i]][0];
    return fmi2OK;
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2String values[]) {
    IN_MODES(~FAILED, "fmi2SetString")
    for (size_t i = 0; i < n; i++) strncpy(V.bytes[r[i]][0], values[i], BYTES - 1);
    return fmi2OK;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (!*state) *state = malloc(sizeof(State));
    memcpy(*state, &((Instance *)c)->state, sizeof(State)); return fmi2OK;
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { memcpy(&((Instance *)c)->state, state, sizeof(State)); return fmi2OK; }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) { (void)c; free(*state); *state = NULL; return fmi2OK; }
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) { Instance *instance = c; (void)state; *size = model_state_size(&V) ? model_state_size(&V) : sizeof(State); return fmi2OK; }
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte data[], size_t size) { (void)c; memcpy(data, state, size); return fmi2OK; }
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte data[], size_t size, fmi2FMUstate *state) {
    (void)c; if (!*state) *state = malloc(size);
    memcpy(*state, data, size); return fmi2OK;
}

fmi2Status fmi2EnterEventMode(fmi2Component c) { IN_MODES(CONTINUOUS, "fmi2EnterEventMode") instance->state.mode = EVENT; return fmi2OK; }
fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) { IN_MODES(EVENT, "fmi2EnterContinuousTimeMode") instance->state.mode = CONTINUOUS; return fmi2OK; }
fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    IN_MODES(EVENT, "fmi2NewDiscreteStates")
    Event e = model_event(&V);
    info->newDiscreteStatesNeeded = e.again; info->terminateSimulation = e.terminate; info->nominalsOfContinuousStatesChanged = e.nominals;
    info->valuesOfContinuousStatesChanged = e.states; info->nextEventTimeDefined = e.defined; info->nextEventTime = e.next;
    return fmi2OK;
}
fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean final, fmi2Boolean *event, fmi2Boolean *terminate) {
    IN_MODES(CONTINUOUS, "fmi2CompletedIntegratorStep") (void)final; *event = model_completed(&V); *terminate = 0; return fmi2OK;
}
fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) { IN_MODES(CONTINUOUS, "fmi2SetTime") V.time = time; return fmi2OK; }
fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    IN_MODES(CONTINUOUS, "fmi2SetContinuousStates")
    for (size_t i = 0; i < n; i++) V.number[MODEL_FIRST_STATE + i][0] = x[i];
    return fmi2OK;
}
fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    Instance *instance = c; for (size_t i = 0; i < n; i++) x[i] = V.number[MODEL_FIRST_STATE + i][0]; return fmi2OK;
}
fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dx[], size_t n) {
    IN_MODES(CONTINUOUS, "fmi2GetDerivatives")
    model_outputs(&V);
    for (size_t i = 0; i < n; i++) dx[i] = V.number[MODEL_FIRST_DERIVATIVE + i][0];
    return fmi2OK;
}
fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) { Instance *instance = c; (void)n; model_indicators(&V, z); return fmi2OK; }
fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real x[], size_t n) { (void)c; for (size_t i = 0; i < n; i++) x[i] = 1; return fmi2OK; }

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real size, fmi2Boolean final) {
    IN_MODES(STEP, "fmi2DoStep")
    (void)final;
    if (time - V.time > 1e-9 || V.time - time > 1e-9) { refuse(instance, "fmi2DoStep", "does not begin where the last step ended"); return fmi2Error; }
    Step s = step_through(instance, time + size);
    last_successful = s.reached; has_terminated = s.terminate;
    if (s.verdict == STEP_FAILED) { instance->state.mode = FAILED; refuse(instance, "fmi2DoStep", "fails as it was told to"); return fmi2Error; }
    if (s.verdict == STEP_DISCARDED || s.terminate) return fmi2Discard;
    return fmi2OK;
}
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) { (void)c; (void)kind; *value = last_successful; return fmi2OK; }
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) { (void)c; (void)kind; *value = has_terminated; return fmi2OK; }

/* What no test model offers. */
#define ABSENT(name, ...) fmi2Status name(__VA_ARGS__) { return fmi2Error; }
ABSENT(fmi2GetDirectionalDerivative, fmi2Component c, const fmi2ValueReference u[], size_t nu, const fmi2ValueReference k[], size_t nk, const fmi2Real dk[], fmi2Real du[])
ABSENT(fmi2SetRealInputDerivatives, fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], const fmi2Real v[])
ABSENT(fmi2GetRealOutputDerivatives, fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], fmi2Real v[])
ABSENT(fmi2CancelStep, fmi2Component c)
ABSENT(fmi2GetStatus, fmi2Component c, const fmi2StatusKind k, fmi2Status *v)
ABSENT(fmi2GetIntegerStatus, fmi2Component c, const fmi2StatusKind k, fmi2Integer *v)
ABSENT(fmi2GetStringStatus, fmi2Component c, const fmi2StatusKind k, fmi2String *v)
