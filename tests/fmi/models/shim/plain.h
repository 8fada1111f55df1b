/* Callbacks of a model that has no use for them. */
#ifndef PLAIN_H
#define PLAIN_H
#include "model.h"
#define NO_STATES                                                                \
    const size_t MODEL_STATES = 0, MODEL_INDICATORS = 0;                         \
    const unsigned MODEL_FIRST_STATE = 0, MODEL_FIRST_DERIVATIVE = 0;
#define ALL_SCALARS                                                              \
    size_t model_size(const Values *v, unsigned r) { (void)v; (void)r; return 1; }
#define NO_DISCRETE_INPUTS                                                       \
    bool model_is_discrete(unsigned r) { (void)r; return false; }
#define NO_INDICATORS                                                            \
    void model_indicators(const Values *v, double *z) { (void)v; (void)z; }
#define NO_STEP_EVENTS                                                           \
    bool model_completed(Values *v) { (void)v; return false; }
#define NO_EVENTS                                                                \
    Event model_event(Values *v) { (void)v; Event e = {0}; return e; }
#define STEP_TO_END                                                              \
    Step model_step(Values *v, double end) { v->time = end; Step s = {.reached = end}; return s; }
#endif
