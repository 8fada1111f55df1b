/* m x'' = -k x + F, with F the force of the coupling spring. Exact for constant F. Source: see oscillator_left/model.c. */
#include <math.h>

#include "model.h"

#define X(NAME) (v->value[NAME][0])

void model_initialise(Values *v, double time)
{
    (void)time;
    X(DISPLACEMENT) = X(DISPLACEMENT_START);
    X(VELOCITY) = 0.0;
}

void model_outputs(Values *v, double time) { (void)v, (void)time; }

void model_step(Values *v, double time, double size)
{
    (void)time;
    const double A[9] = {0, 1, 0, -X(STIFFNESS) / X(MASS), 0, X(FORCE_IN) / X(MASS), 0, 0, 0};
    double x[3] = {X(DISPLACEMENT), X(VELOCITY), 1.0};
    linear_step(3, A, size, x);
    X(DISPLACEMENT) = x[0];
    X(VELOCITY) = x[1];
}

double model_next_event(const Values *v, double time) { return (void)v, (void)time, HUGE_VAL; }
