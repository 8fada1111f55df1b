/* One instance behind both FMI versions: values, states and what has been called. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "model.h"

typedef enum { CONFIGURATION, INSTANTIATED, INITIALIZATION, STEP, EVENT, TERMINATED } Mode;
typedef void (*Report)(void *environment, const char *name, const char *text);

typedef struct {
    Values values;
    double *store; /* holds every element, one after the other */
    size_t elements;
    double time;
    Mode mode;
    bool is_stale; /* something was set since the outputs were computed */
    bool is_event_mode_used, is_early_return_allowed;
    char name[64];
    void *environment;
    Report report;
} Instance;

typedef struct {
    double time;
    Mode mode;
    bool is_stale;
    size_t elements;
    double store[];
} Snapshot;

Instance *instance_create(const char *name, const char *token, void *environment, Report report);
void instance_free(Instance *instance);
bool instance_reset(Instance *instance); /* false: no memory */
void instance_refuse(const Instance *instance, const char *text);

/* All of one variable's elements; `used` advances through the caller's array. False: no such variable or no room. */
bool instance_get(Instance *instance, unsigned reference, double out[], size_t room, size_t *used);
bool instance_set(Instance *instance, unsigned reference, const double in[], size_t room, size_t *used);
bool instance_resize(Instance *instance, unsigned reference, uint64_t extent);

void instance_refresh(Instance *instance); /* outputs, where something was set since they were computed */
bool instance_initialise(Instance *instance, double time);
/* Advance to `time + size`, or to an event before it where the importer allows that; false: refused. */
bool instance_step(Instance *instance, double time, double size, bool *is_event);

Snapshot *instance_snapshot(Instance *instance, Snapshot *reuse);
bool instance_restore(Instance *instance, const Snapshot *snapshot);
size_t snapshot_size(const Snapshot *snapshot);

#endif
