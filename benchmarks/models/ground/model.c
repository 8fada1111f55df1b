/* z steps by the amplitude a at time t1; the velocity is its derivative behind a first-order filter,
 * a w exp(-w (t - t1)) with w = 2 pi f. Closed form, nothing is integrated. Source: see chassis/model.c.
 */
#include <math.h>

#include "model.h"

static const double PI = 3.14159265358979323846;
/* An importer that adds up its steps arrives a rounding error beside the step; this is still the step. */
static const double SAME_TIME = 1e-9;

void model_initialise(Values *v, double time) { (void)v, (void)time; }

void model_outputs(Values *v, double time)
{
    const double since = time - v->value[STEP_TIME][0], w = 2.0 * PI * v->value[BANDWIDTH][0];
    const double a = since > -SAME_TIME ? v->value[AMPLITUDE][0] : 0.0;
    v->value[Z][0] = a;
    v->value[VELOCITY][0] = a == 0.0 ? 0.0 : a * w * exp(-w * since);
}

void model_step(Values *v, double time, double size) { (void)v, (void)time, (void)size; }

double model_next_event(const Values *v, double time)
{
    return v->value[STEP_TIME][0] > time ? v->value[STEP_TIME][0] : HUGE_VAL;
}
