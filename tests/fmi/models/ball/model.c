/* A ball dropped from 1 m that loses part of its speed at each impact (a state event), with a closed form in
 * Co-Simulation; in Model Exchange its height is the event indicator. */
#include <math.h>
#include "plain.h"

const char MODEL_TOKEN[] = "ball";
const size_t MODEL_STATES = 2, MODEL_INDICATORS = 1;
enum { HEIGHT = 1, VELOCITY = 2, HEIGHT_RATE = 3, VELOCITY_RATE = 4, RESTITUTION = 5, IMPACTS = 6, PUSH = 7 };
const unsigned MODEL_FIRST_STATE = HEIGHT, MODEL_FIRST_DERIVATIVE = HEIGHT_RATE;
static const double GRAVITY = 9.81;
ALL_SCALARS NO_DISCRETE_INPUTS NO_STEP_EVENTS

void model_start(Values *v) { v->number[HEIGHT][0] = 1.0; v->number[RESTITUTION][0] = 0.5; }
void model_outputs(Values *v) {
    v->number[HEIGHT_RATE][0] = v->number[VELOCITY][0];
    v->number[VELOCITY_RATE][0] = v->number[PUSH][0] - GRAVITY;
}
void model_indicators(const Values *v, double *z) { z[0] = v->number[HEIGHT][0]; }

Event model_event(Values *v) {
    Event e = {0};
    if (v->number[HEIGHT][0] <= 1e-9 && v->number[VELOCITY][0] < 0.0) {
        v->number[HEIGHT][0] = 0.0;
        v->number[VELOCITY][0] *= -v->number[RESTITUTION][0];
        v->whole[IMPACTS][0]++;
        e.states = true;
    }
    return e;
}

Step model_step(Values *v, double end) {
    double a = v->number[PUSH][0] - GRAVITY, h = v->number[HEIGHT][0], w = v->number[VELOCITY][0], size = end - v->time;
    double impact = a < 0.0 ? (-w - sqrt(w * w - 2.0 * a * h)) / a : HUGE_VAL;
    Step s = {.reached = end};
    if (impact > 1e-12 && impact <= size) { s.event = true; size = impact; s.reached = v->time + impact; }
    v->number[HEIGHT][0] = s.event ? 0.0 : h + w * size + 0.5 * a * size * size;
    v->number[VELOCITY][0] = w + a * size;
    v->time = s.reached;
    return s;
}
