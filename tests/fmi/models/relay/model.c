/* A heater with a relay: on below the lower bound, off above the upper one (state events). Its input `enabled` switches
 * it at once (an input event), its step events count completed steps beyond a limit. With bounds that practically meet it chatters. */
#include "plain.h"

const char MODEL_TOKEN[] = "relay";
const size_t MODEL_STATES = 1, MODEL_INDICATORS = 1;
enum { LEVEL = 1, RATE = 2, LOWER = 3, UPPER = 4, IS_ON = 5, SWITCHINGS = 6, ENABLED = 7, THRESHOLD = 8, DRIVE = 9, CROSSINGS = 10,
       REPORTS = 11, STEP_EVENTS = 12 };
const unsigned MODEL_FIRST_STATE = LEVEL, MODEL_FIRST_DERIVATIVE = RATE;
ALL_SCALARS
bool model_is_discrete(unsigned r) { return r == ENABLED; }

void model_start(Values *v) {
    v->number[LOWER][0] = 0.4; v->number[UPPER][0] = 0.6; v->whole[ENABLED][0] = 1; v->number[THRESHOLD][0] = 1.0;
    v->number[REPORTS][0] = 1e9;
}
void model_outputs(Values *v) { v->number[RATE][0] = v->whole[IS_ON][0] && v->whole[ENABLED][0] ? 1.0 : -1.0; }
void model_indicators(const Values *v, double *z) {
    z[0] = v->whole[IS_ON][0] ? v->number[UPPER][0] - v->number[LEVEL][0] : v->number[LEVEL][0] - v->number[LOWER][0];
}
bool model_completed(Values *v) {
    if (v->number[LEVEL][0] < v->number[REPORTS][0]) return false;
    v->whole[STEP_EVENTS][0]++; v->number[REPORTS][0] = 1e9; return true;
}

Event model_event(Values *v) {
    Event e = {0};
    bool was_on = v->whole[IS_ON][0];
    double slack = 1e-9;
    if (!was_on && v->number[LEVEL][0] <= v->number[LOWER][0] + slack) v->whole[IS_ON][0] = 1;
    if (was_on && v->number[LEVEL][0] >= v->number[UPPER][0] - slack) v->whole[IS_ON][0] = 0;
    v->whole[SWITCHINGS][0] += was_on != (bool)v->whole[IS_ON][0];
    bool is_above = v->number[DRIVE][0] > v->number[THRESHOLD][0], was_above = v->whole[CROSSINGS][1];
    v->whole[CROSSINGS][0] += is_above && !was_above;
    v->whole[CROSSINGS][1] = is_above;
    return e;
}
Step model_step(Values *v, double end) { (void)v; Step s = {.reached = end, .verdict = STEP_FAILED}; return s; }
