/* Counts the ticks of a periodic, a countdown and a triggered input clock, and ticks an output clock at every second
 * periodic tick. The countdown clock is wound up by the second tick of the periodic one. */
#include "plain.h"

const char MODEL_TOKEN[] = "clocks";
NO_STATES ALL_SCALARS NO_STEP_EVENTS NO_INDICATORS STEP_TO_END
enum { PERIODIC = 1, COUNTDOWN = 2, TRIGGERED = 3, OUTPUT = 4, PERIODIC_TICKS = 11, COUNTDOWN_TICKS = 12,
       TRIGGERED_TICKS = 13, SAMPLE = 14, SAMPLED = 15, WHEN = 16, WHEN_COUNTDOWN = 17 };

bool model_is_discrete(unsigned r) { return r == SAMPLE; }
void model_start(Values *v) { v->number[PERIODIC][0] = 0.3; v->number[PERIODIC][1] = 0.1; }
void model_outputs(Values *v) { (void)v; }

Event model_event(Values *v) {
    Event e = {0};
    if (v->whole[OUTPUT][0]) { v->whole[OUTPUT][0] = 0; return e; }
    if (v->whole[PERIODIC][0]) {
        v->whole[PERIODIC_TICKS][0]++;
        v->number[WHEN][0] = v->time;
        if (v->whole[PERIODIC_TICKS][0] == 2) { v->number[COUNTDOWN][0] = 0.25; v->whole[COUNTDOWN][1] = 1; }
        if (v->whole[PERIODIC_TICKS][0] % 2 == 0) { v->whole[OUTPUT][0] = 1; e.again = true; }
    }
    if (v->whole[COUNTDOWN][0]) { v->whole[COUNTDOWN_TICKS][0]++; v->number[WHEN_COUNTDOWN][0] = v->time; }
    if (v->whole[TRIGGERED][0]) { v->whole[TRIGGERED_TICKS][0]++; v->number[SAMPLED][0] = v->number[SAMPLE][0]; }
    v->whole[PERIODIC][0] = v->whole[COUNTDOWN][0] = v->whole[TRIGGERED][0] = 0;
    return e;
}
