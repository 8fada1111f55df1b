/* m v' = k c + d (u - v) - m g - F,  c' = u - v,  z' = v, with u the velocity of the ground and F the force of the
 * suspension. Exact for constant u and F. Source: see chassis/model.c.
 */
#include <math.h>

#include "model.h"

static const double GRAVITY = 9.80665; /* m/s^2, as in the public case */

#define X(NAME) (v->value[NAME][0])

void model_initialise(Values *v, double time)
{
    (void)time;
    X(COMPRESSION) = (X(MASS) + X(LOAD)) * GRAVITY / X(STIFFNESS);
    X(VELOCITY) = 0.0;
    X(Z) = X(Z_START);
}

void model_outputs(Values *v, double time)
{
    (void)time;
    X(FORCE) = X(STIFFNESS) * X(COMPRESSION) + X(DAMPING) * (X(VELOCITY_IN) - X(VELOCITY));
}

void model_step(Values *v, double time, double size)
{
    (void)time;
    const double k = X(STIFFNESS) / X(MASS), d = X(DAMPING) / X(MASS), u = X(VELOCITY_IN);
    /* compression, velocity, height, 1 */
    const double A[16] = {0, -1, 0, u, k, -d, 0, d * u - GRAVITY - X(FORCE_IN) / X(MASS), 0, 1, 0, 0, 0, 0, 0, 0};
    double x[4] = {X(COMPRESSION), X(VELOCITY), X(Z), 1.0};
    linear_step(4, A, size, x);
    X(COMPRESSION) = x[0];
    X(VELOCITY) = x[1];
    X(Z) = x[2];
}

double model_next_event(const Values *v, double time) { return (void)v, (void)time, HUGE_VAL; }
