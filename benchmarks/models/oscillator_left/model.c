/* m x'' = -(k + kc) x + kc u, with u the displacement of the right mass; force on the right mass kc (x - u).
 * Exact for constant u.
 *
 * Masses 1 kg, wall springs 4 pi^2 N/m, coupling 16 pi^2 N/m, start (1, 0) at rest: V. Schueller, B. Rodenberg,
 * B. Uekermann, H. Bungartz, A simple test case for convergence order in time and energy conservation of black-box
 * coupling schemes, WCCM-APCOM 2022. Closed form x1, x2 = (cos(2 pi t) +- cos(6 pi t)) / 2. There both halves exchange
 * displacements; here one gives a force and the other a displacement.
 */
#include <math.h>

#include "model.h"

#define X(NAME) (v->value[NAME][0])

void model_initialise(Values *v, double time)
{
    (void)time;
    X(DISPLACEMENT) = X(DISPLACEMENT_START);
    X(VELOCITY) = 0.0;
}

void model_outputs(Values *v, double time)
{
    (void)time;
    X(FORCE) = X(COUPLING) * (X(DISPLACEMENT) - X(DISPLACEMENT_IN));
}

void model_step(Values *v, double time, double size)
{
    (void)time;
    const double A[9] = {0, 1, 0, -(X(STIFFNESS) + X(COUPLING)) / X(MASS), 0,
                         X(COUPLING) * X(DISPLACEMENT_IN) / X(MASS), 0, 0, 0};
    double x[3] = {X(DISPLACEMENT), X(VELOCITY), 1.0};
    linear_step(3, A, size, x);
    X(DISPLACEMENT) = x[0];
    X(VELOCITY) = x[1];
}

double model_next_event(const Values *v, double time) { return (void)v, (void)time, HUGE_VAL; }
