/* An instance, common to both FMI versions. */
#ifndef INSTANCE_H
#define INSTANCE_H
#include "model.h"

typedef enum { INSTANTIATED = 1, CONFIGURATION = 2, INITIALISATION = 4, EVENT = 8, STEP = 16, CONTINUOUS = 32,
               TERMINATED = 64, FAILED = 128 } Mode;

typedef struct { Values values; Mode mode; } State;

typedef struct {
    State state;
    bool is_co_simulation, uses_events, is_early_allowed;
    double stop;
    void *environment;
    void (*log)(void);
    char name[64];
} Instance;

#define V (instance->state.values)

__attribute__((weak)) void model_setup(Values *v, double stop) { (void)v; (void)stop; }
__attribute__((weak)) size_t model_state_size(const Values *v) { (void)v; return 0; }
__attribute__((weak)) bool model_is_readable(unsigned reference) { (void)reference; return true; }

/* Refuse a call that does not belong to the present mode. */
#define IN_MODES(modes, function)                                                \
    Instance *instance = c;                                                      \
    if (!(instance->state.mode & (modes))) {                                     \
        refuse(instance, function, "is not allowed in this mode");               \
        return REFUSED;                                                          \
    }

/* Many Co-Simulation importers never see an event: it is handled inside the step. */
static inline Step step_through(Instance *instance, double end) {
    for (;;) {
        Step s = model_step(&V, end);
        if (s.verdict != STEP_DONE || s.terminate) return s;
        if (!s.event && (s.reached >= end || instance->is_early_allowed)) return s;
        if (s.event) {
            if (instance->uses_events || instance->is_early_allowed) return s;
            Event e;
            do { e = model_event(&V); } while (e.again && !e.terminate);
            if (e.terminate) { s.terminate = true; return s; }
            if (s.reached >= end) return s;
        }
    }
}
#endif
