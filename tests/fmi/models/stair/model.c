/* Climbs one stair at every multiple of its period (a time event); the height integrates the number of stairs. */
#include "plain.h"

const char MODEL_TOKEN[] = "stair";
const size_t MODEL_STATES = 1, MODEL_INDICATORS = 0;
enum { AREA = 1, AREA_RATE = 2, COUNT = 3, PERIOD = 4, LATEST = 5 };
const unsigned MODEL_FIRST_STATE = AREA, MODEL_FIRST_DERIVATIVE = AREA_RATE;
ALL_SCALARS NO_DISCRETE_INPUTS NO_STEP_EVENTS NO_INDICATORS

void model_start(Values *v) { v->number[PERIOD][0] = 0.3; }
void model_outputs(Values *v) { v->number[AREA_RATE][0] = (double)v->whole[COUNT][0]; }

Event model_event(Values *v) {
    Event e = {.defined = true};
    if (v->time >= (v->whole[COUNT][0] + 1) * v->number[PERIOD][0]) { v->whole[COUNT][0]++; v->number[LATEST][0] = v->time; }
    e.next = (v->whole[COUNT][0] + 1) * v->number[PERIOD][0];
    return e;
}

Step model_step(Values *v, double end) {
    double next = (v->whole[COUNT][0] + 1) * v->number[PERIOD][0];
    Step s = {.reached = end};
    if (next <= end) { s.reached = next; s.event = true; }
    v->number[AREA][0] += (double)v->whole[COUNT][0] * (s.reached - v->time);
    v->time = s.reached;
    return s;
}
