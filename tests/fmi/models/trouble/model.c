/* Integrates its input exactly, and makes trouble as its parameters say: refuses long steps (all or after half of them),
 * fails, terminates, says that its state is of another size, gives NaN, or returns early without an event. Its input cannot be read. */
#include <math.h>
#include "plain.h"

const char MODEL_TOKEN[] = "trouble";
const size_t MODEL_STATES = 1, MODEL_INDICATORS = 0;
enum { INTEGRAL = 1, RATE = 2, INPUT = 3, LONGEST = 4, IS_PARTIAL = 5, FAILS = 6, TERMINATES = 7, BREAKS = 8, RETURNS = 9, SUM = 10, STATE_SIZE = 11 };
const unsigned MODEL_FIRST_STATE = INTEGRAL, MODEL_FIRST_DERIVATIVE = RATE;
ALL_SCALARS NO_DISCRETE_INPUTS NO_STEP_EVENTS NO_INDICATORS

size_t model_state_size(const Values *v) { return (size_t)v->number[STATE_SIZE][0]; }
bool model_is_readable(unsigned r) { return r != INPUT; }

void model_start(Values *v) {
    for (int r = LONGEST; r <= RETURNS; r++) v->number[r][0] = 1e9;
    v->number[INPUT][0] = 1.0;
}
void model_outputs(Values *v) {
    v->number[RATE][0] = v->time >= v->number[BREAKS][0] ? NAN : v->number[INPUT][0];
    v->number[SUM][0] = v->number[INTEGRAL][0] + 10.0 * v->number[INPUT][0];
}
Event model_event(Values *v) {
    Event e = {.terminate = v->time >= v->number[TERMINATES][0], .defined = true, .next = v->number[TERMINATES][0]};
    return e;
}

Step model_step(Values *v, double end) {
    double size = end - v->time;
    Step s = {.reached = end};
    if (size > v->number[LONGEST][0] + 1e-12) {
        s.verdict = STEP_DISCARDED;
        size = v->whole[IS_PARTIAL][0] ? size / 2 : 0.0;
    } else if (end >= v->number[FAILS][0] - 1e-12) {
        s.verdict = STEP_FAILED;
    } else if (end >= v->number[TERMINATES][0] - 1e-12) {
        s.terminate = true;
    } else if (size > v->number[RETURNS][0] + 1e-12) {
        size = v->number[RETURNS][0];
    }
    v->number[INTEGRAL][0] += v->number[INPUT][0] * size;
    s.reached = size == end - v->time ? end : v->time + size;
    v->time = s.reached;
    if (end >= v->number[BREAKS][0]) v->number[INTEGRAL][0] = NAN;
    return s;
}
