#include "instance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points of time closer than this are the same: importers add up steps in floating point. */
static const double SAME_TIME = 1e-9;

void instance_refuse(const Instance *instance, const char *text)
{
    if (instance && instance->report)
        instance->report(instance->environment, instance->name, text);
}

static bool lay_out(Instance *instance)
{
    Values *v = &instance->values;
    size_t total = 0;
    for (int i = 0; i < COUNT; i++)
        total += v->extent[i];
    double *store = malloc(total * sizeof *store);
    if (!store)
        return false;
    free(instance->store);
    instance->store = store;
    instance->elements = total;
    for (int i = 0; i < COUNT; i++) {
        v->value[i] = store;
        store += v->extent[i];
        for (size_t k = 0; k < v->extent[i]; k++)
            v->value[i][k] = START[i];
    }
    return true;
}

bool instance_reset(Instance *instance)
{
    for (int i = 0; i < COUNT; i++)
        instance->values.extent[i] = SIZED_BY[i] < 0 ? 1 : (size_t)START[SIZED_BY[i]];
    instance->time = 0.0;
    instance->mode = INSTANTIATED;
    instance->is_stale = true;
    return lay_out(instance);
}

Instance *instance_create(const char *name, const char *token, void *environment, Report report)
{
    Instance *instance = calloc(1, sizeof *instance);
    if (!instance)
        return NULL;
    instance->environment = environment;
    instance->report = report;
    strncpy(instance->name, name ? name : MODEL_IDENTIFIER, sizeof instance->name - 1);
    if (!token || strcmp(token, INSTANTIATION_TOKEN) != 0) {
        instance_refuse(instance, "the instantiation token is that of another FMU");
    } else if (instance_reset(instance)) {
        return instance;
    }
    instance_free(instance);
    return NULL;
}

void instance_free(Instance *instance)
{
    if (instance)
        free(instance->store);
    free(instance);
}

void instance_refresh(Instance *instance)
{
    if (!instance->is_stale)
        return;
    if (instance->mode < STEP)
        model_initialise(&instance->values, instance->time);
    model_outputs(&instance->values, instance->time);
    instance->is_stale = false;
}

bool instance_get(Instance *instance, unsigned reference, double out[], size_t room, size_t *used)
{
    if (reference == 0 && room - *used >= 1) {
        out[(*used)++] = instance->time;
        return true;
    }
    if (reference >= COUNT || room - *used < instance->values.extent[reference]) {
        instance_refuse(instance, "get: there is no such variable, or the array is too short");
        return false;
    }
    instance_refresh(instance);
    const size_t extent = instance->values.extent[reference];
    memcpy(out + *used, instance->values.value[reference], extent * sizeof *out);
    *used += extent;
    return true;
}

bool instance_set(Instance *instance, unsigned reference, const double in[], size_t room, size_t *used)
{
    const bool is_late = instance->mode >= STEP && reference < COUNT && !IS_INPUT[reference];
    if (reference == 0 || reference >= COUNT || !IS_SETTABLE[reference] || is_late ||
        room - *used < instance->values.extent[reference]) {
        instance_refuse(instance, "set: this variable cannot be set now, or the array is too short");
        return false;
    }
    for (size_t k = 0; k < instance->values.extent[reference]; k++) {
        if (!isfinite(in[*used])) {
            instance_refuse(instance, "set: not a finite number");
            return false;
        }
        instance->values.value[reference][k] = in[(*used)++];
    }
    instance->is_stale = true;
    return true;
}

bool instance_resize(Instance *instance, unsigned reference, uint64_t extent)
{
    if (instance->mode != CONFIGURATION || reference >= COUNT || !IS_STRUCTURAL[reference] || extent < 1 ||
        extent > 1000000) {
        instance_refuse(instance, "this structural parameter cannot be set now, or not to this value");
        return false;
    }
    for (int i = 0; i < COUNT; i++)
        if (SIZED_BY[i] == (int)reference)
            instance->values.extent[i] = (size_t)extent;
    if (!lay_out(instance))
        return false;
    instance->values.value[reference][0] = (double)extent;
    return true;
}

bool instance_initialise(Instance *instance, double time)
{
    if (instance->mode != INSTANTIATED || !isfinite(time)) {
        instance_refuse(instance, "initialization mode: called out of order, or at a time that is not finite");
        return false;
    }
    instance->time = time;
    instance->mode = INITIALIZATION;
    instance->is_stale = true;
    return true;
}

bool instance_step(Instance *instance, double time, double size, bool *is_event)
{
    if (instance->mode != STEP || !(size > 0.0) || !isfinite(size) || fabs(time - instance->time) > SAME_TIME) {
        instance_refuse(instance, "doStep: called out of order, from another time, or with a size that is not positive");
        return false;
    }
    double end = time + size;
    const double event = model_next_event(&instance->values, instance->time + SAME_TIME);
    *is_event = instance->is_event_mode_used && event <= end + SAME_TIME;
    if (*is_event && instance->is_early_return_allowed && event < end - SAME_TIME)
        end = event;
    model_step(&instance->values, time, end - time);
    instance->time = end;
    model_outputs(&instance->values, end);
    instance->is_stale = false;
    return true;
}

size_t snapshot_size(const Snapshot *snapshot)
{
    return sizeof *snapshot + snapshot->elements * sizeof(double);
}

Snapshot *instance_snapshot(Instance *instance, Snapshot *reuse)
{
    Snapshot *snapshot = reuse;
    if (!snapshot || snapshot->elements != instance->elements)
        snapshot = realloc(reuse, sizeof *snapshot + instance->elements * sizeof(double));
    if (!snapshot)
        return NULL;
    snapshot->time = instance->time;
    snapshot->mode = instance->mode;
    snapshot->is_stale = instance->is_stale;
    snapshot->elements = instance->elements;
    memcpy(snapshot->store, instance->store, instance->elements * sizeof(double));
    return snapshot;
}

bool instance_restore(Instance *instance, const Snapshot *snapshot)
{
    if (!snapshot || snapshot->elements != instance->elements) {
        instance_refuse(instance, "this state belongs to an FMU with other structural parameters");
        return false;
    }
    instance->time = snapshot->time;
    instance->mode = snapshot->mode;
    instance->is_stale = snapshot->is_stale;
    memcpy(instance->store, snapshot->store, instance->elements * sizeof(double));
    return true;
}
