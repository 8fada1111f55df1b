/* What a test model provides; fmi2.c and fmi3.c turn it into an FMU. Values are addressed by value reference, which is
 * the same in both FMI versions. */
#ifndef MODEL_H
#define MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { VARIABLES = 64, ELEMENTS = 24, BYTES = 32 };

/* Everything that a model knows: saving a state is a copy of this block. */
typedef struct {
    double time;
    double number[VARIABLES][ELEMENTS];      /* Float64, Float32, Real; interval [0] and shift [1] of a clock */
    int64_t whole[VARIABLES][ELEMENTS];      /* integers, Boolean, Enumeration; clocks: active [0], interval new [1] */
    char bytes[VARIABLES][ELEMENTS][BYTES];  /* String, Binary */
    size_t length[VARIABLES][ELEMENTS];
} Values;

typedef enum { STEP_DONE, STEP_DISCARDED, STEP_FAILED } Verdict;

/* A part of a Co-Simulation step: how far it came, and whether an event happened there. */
typedef struct {
    double reached;
    bool event, terminate;
    Verdict verdict;
} Step;

/* Result of one iteration in Event Mode. */
typedef struct {
    bool again, terminate, nominals, states, defined;
    double next;
} Event;

extern const char MODEL_TOKEN[];
extern const size_t MODEL_STATES, MODEL_INDICATORS;
/* Value references of the first continuous state and of the first derivative; the others follow. */
extern const unsigned MODEL_FIRST_STATE, MODEL_FIRST_DERIVATIVE;

void model_start(Values *v);
size_t model_size(const Values *v, unsigned reference); /* number of elements */
bool model_is_discrete(unsigned reference);             /* may be set in Event Mode, not in Step Mode */
void model_setup(Values *v, double stop);               /* optional, FMI 2.0: fmi2SetupExperiment; -1: no stop time */
size_t model_state_size(const Values *v);               /* optional: a size of the serialised state that is not its own */
bool model_is_readable(unsigned reference);             /* optional: some FMUs refuse to read their inputs */
void model_outputs(Values *v);                          /* outputs and derivatives */
void model_indicators(const Values *v, double *z);
bool model_completed(Values *v);                        /* completed integrator step: wants Event Mode? */
Event model_event(Values *v);
Step model_step(Values *v, double end);

#endif
