/* Arrays with a structural parameter; the offset tells the elements apart. */
#include <math.h>

#include "model.h"

void model_initialise(Values *v, double time) { (void)v, (void)time; }

void model_outputs(Values *v, double time)
{
    (void)time;
    for (size_t k = 0; k < v->extent[Y]; k++)
        v->value[Y][k] = v->value[GAIN][0] * v->value[U][k] + v->value[OFFSET][0] * (double)(k + 1);
}

void model_step(Values *v, double time, double size) { (void)v, (void)time, (void)size; }

double model_next_event(const Values *v, double time) { return (void)v, (void)time, HUGE_VAL; }
