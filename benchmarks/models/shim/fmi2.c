/* FMI 2.0 for Co-Simulation. */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "instance.h"

#define CHECK(condition) ((condition) ? fmi2OK : fmi2Error)

static void report(void *environment, const char *name, const char *text)
{
    const fmi2CallbackFunctions *callbacks = environment;
    if (callbacks && callbacks->logger)
        callbacks->logger(callbacks->componentEnvironment, name, fmi2Error, "logStatusError", "%s", text);
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
                              const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    return type == fmi2CoSimulation ? instance_create(name, token, (void *)callbacks, report) : NULL;
}

void fmi2FreeInstance(fmi2Component c) { instance_free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_given, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean stop_given, fmi2Real stop)
{
    (void)tolerance_given, (void)tolerance, (void)stop_given, (void)stop;
    Instance *instance = c;
    instance->time = start;
    return CHECK(instance->mode == INSTANTIATED);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return CHECK(instance_initialise(c, ((Instance *)c)->time)); }

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    Instance *instance = c;
    if (instance->mode != INITIALIZATION)
        return fmi2Error;
    instance_refresh(instance);
    instance->mode = STEP;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    Instance *instance = c;
    const bool is_allowed = instance->mode == STEP;
    instance->mode = TERMINATED;
    return CHECK(is_allowed);
}

fmi2Status fmi2Reset(fmi2Component c) { return CHECK(instance_reset(c)); }

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t n, fmi2Real values[])
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        if (!instance_get(c, references[i], values, n, &used))
            return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t n, const fmi2Real values[])
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        if (!instance_set(c, references[i], values, n, &used))
            return fmi2Error;
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real size, fmi2Boolean no_set)
{
    bool is_event;
    (void)no_set;
    return CHECK(instance_step(c, time, size, &is_event));
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    Snapshot *snapshot = instance_snapshot(c, *state);
    if (snapshot)
        *state = snapshot;
    return CHECK(snapshot);
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) { return CHECK(instance_restore(c, state)); }

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)c;
    *size = snapshot_size(state);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    (void)c;
    if (size < snapshot_size(state))
        return fmi2Error;
    memcpy(bytes, state, snapshot_size(state));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
{
    const Instance *instance = c;
    if (size != sizeof(Snapshot) + instance->elements * sizeof(double) || !(*state = malloc(size)))
        return fmi2Error;
    memcpy(*state, bytes, size);
    return fmi2OK;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    *value = ((Instance *)c)->time;
    return CHECK(kind == fmi2LastSuccessfulTime);
}

/* What these models have none of; an empty list is no error. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
#define ABSENT_TYPE(Name) \
    fmi2Status fmi2Get##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##Name v[]) \
    { \
        return CHECK(n == 0); \
    } \
    fmi2Status fmi2Set##Name(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2##Name v[]) \
    { \
        return CHECK(n == 0); \
    }
ABSENT_TYPE(Integer)
ABSENT_TYPE(Boolean)
ABSENT_TYPE(String)

#define ABSENT(Name, ...) \
    fmi2Status fmi2##Name(fmi2Component c, __VA_ARGS__) { return fmi2Error; }
ABSENT(GetDirectionalDerivative, const fmi2ValueReference u[], size_t n, const fmi2ValueReference k[], size_t m,
       const fmi2Real s[], fmi2Real v[])
ABSENT(SetRealInputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], const fmi2Real v[])
ABSENT(GetRealOutputDerivatives, const fmi2ValueReference r[], size_t n, const fmi2Integer o[], fmi2Real v[])
ABSENT(GetStatus, const fmi2StatusKind kind, fmi2Status *value)
ABSENT(GetIntegerStatus, const fmi2StatusKind kind, fmi2Integer *value)
ABSENT(GetBooleanStatus, const fmi2StatusKind kind, fmi2Boolean *value)
ABSENT(GetStringStatus, const fmi2StatusKind kind, fmi2String *value)
fmi2Status fmi2CancelStep(fmi2Component c) { return fmi2Error; }
