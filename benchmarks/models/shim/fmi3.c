/* FMI 3.0 for Co-Simulation, with arrays, structural parameters, event mode and early return. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fmi3Functions.h"
#include "instance.h"

#define CHECK(condition) ((condition) ? fmi3OK : fmi3Error)

typedef struct {
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} Importer;

static void report(void *environment, const char *name, const char *text)
{
    const Importer *importer = environment;
    (void)name;
    if (importer->log)
        importer->log(importer->environment, fmi3Error, "logStatusError", text);
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean event_mode_used, fmi3Boolean early_return,
                                         const fmi3ValueReference intermediate[], size_t n,
                                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)resources, (void)visible, (void)logging, (void)intermediate, (void)n, (void)update;
    Importer *importer = malloc(sizeof *importer);
    if (!importer)
        return NULL;
    *importer = (Importer){environment, log};
    Instance *instance = instance_create(name, token, importer, report);
    if (!instance) {
        free(importer);
        return NULL;
    }
    instance->is_event_mode_used = event_mode_used;
    instance->is_early_return_allowed = early_return;
    return instance;
}

void fmi3FreeInstance(fmi3Instance c)
{
    if (c)
        free(((Instance *)c)->environment);
    instance_free(c);
}

static fmi3Status change_mode(Instance *instance, Mode from, Mode to)
{
    if (instance->mode != from) {
        instance_refuse(instance, "this mode cannot be entered from the present one");
        return fmi3Error;
    }
    instance->mode = to;
    return fmi3OK;
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) { return change_mode(c, INSTANTIATED, CONFIGURATION); }
fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) { return change_mode(c, CONFIGURATION, INSTANTIATED); }
fmi3Status fmi3EnterEventMode(fmi3Instance c) { return change_mode(c, STEP, EVENT); }
fmi3Status fmi3EnterStepMode(fmi3Instance c) { return change_mode(c, EVENT, STEP); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_given, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean stop_given, fmi3Float64 stop)
{
    (void)tolerance_given, (void)tolerance, (void)stop_given, (void)stop;
    return CHECK(instance_initialise(c, start));
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    Instance *instance = c;
    if (instance->mode == INITIALIZATION)
        instance_refresh(instance);
    return change_mode(instance, INITIALIZATION, instance->is_event_mode_used ? EVENT : STEP);
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *again, fmi3Boolean *stop, fmi3Boolean *nominals,
                                    fmi3Boolean *continuous, fmi3Boolean *is_next_known, fmi3Float64 *next)
{
    Instance *instance = c;
    *again = *stop = *nominals = *continuous = false;
    *next = model_next_event(&instance->values, instance->time);
    *is_next_known = *next < HUGE_VAL;
    return CHECK(instance->mode == EVENT);
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) { return CHECK(((Instance *)c)->mode == EVENT); }

fmi3Status fmi3Terminate(fmi3Instance c)
{
    Instance *instance = c;
    const bool is_allowed = instance->mode == STEP || instance->mode == EVENT;
    instance->mode = TERMINATED;
    return CHECK(is_allowed);
}

fmi3Status fmi3Reset(fmi3Instance c) { return CHECK(instance_reset(c)); }

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference references[], size_t n, fmi3Float64 values[],
                          size_t room)
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        if (references[i] < COUNT && IS_STRUCTURAL[references[i]])
            return fmi3Error;
        else if (!instance_get(c, references[i], values, room, &used))
            return fmi3Error;
    return CHECK(used == room);
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference references[], size_t n, const fmi3Float64 values[],
                          size_t room)
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        if (!instance_set(c, references[i], values, room, &used))
            return fmi3Error;
    return CHECK(used == room);
}

fmi3Status fmi3GetUInt64(fmi3Instance c, const fmi3ValueReference references[], size_t n, fmi3UInt64 values[],
                         size_t room)
{
    Instance *instance = c;
    for (size_t i = 0; i < n; i++)
        if (references[i] >= COUNT || !IS_STRUCTURAL[references[i]])
            return fmi3Error;
        else
            values[i] = (fmi3UInt64)instance->values.value[references[i]][0];
    return CHECK(room == n);
}

fmi3Status fmi3SetUInt64(fmi3Instance c, const fmi3ValueReference references[], size_t n, const fmi3UInt64 values[],
                         size_t room)
{
    for (size_t i = 0; i < n; i++)
        if (!instance_resize(c, references[i], values[i]))
            return fmi3Error;
    return CHECK(room == n);
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 size, fmi3Boolean no_set, fmi3Boolean *is_event,
                      fmi3Boolean *terminate, fmi3Boolean *early_return, fmi3Float64 *last)
{
    Instance *instance = c;
    bool needs_event_mode;
    (void)no_set;
    if (!instance_step(instance, time, size, &needs_event_mode))
        return fmi3Error;
    *is_event = needs_event_mode;
    *terminate = false;
    *last = instance->time;
    *early_return = needs_event_mode && instance->time < time + size;
    return fmi3OK;
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state)
{
    Snapshot *snapshot = instance_snapshot(c, *state);
    if (snapshot)
        *state = snapshot;
    return CHECK(snapshot);
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) { return CHECK(instance_restore(c, state)); }

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state)
{
    (void)c;
    free(*state);
    *state = NULL;
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size)
{
    (void)c;
    *size = snapshot_size(state);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[], size_t size)
{
    (void)c;
    if (size < snapshot_size(state))
        return fmi3Error;
    memcpy(bytes, state, snapshot_size(state));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
{
    const Instance *instance = c;
    if (size != sizeof(Snapshot) + instance->elements * sizeof(double) || !(*state = malloc(size)))
        return fmi3Error;
    memcpy(*state, bytes, size);
    return fmi3OK;
}
