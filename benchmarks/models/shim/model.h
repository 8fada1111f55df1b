/* What a model gives to the shim. `variables.h` is generated from the model's model.toml: one index per variable. */
#ifndef MODEL_H
#define MODEL_H

#include <stddef.h>

#include "variables.h"

/* Values of every variable (value[INDEX][element]) and their numbers of elements. */
typedef struct {
    double *value[COUNT];
    size_t extent[COUNT];
} Values;

/* States at the start, from start values and parameters. */
void model_initialise(Values *v, double time);

/* Outputs from states and inputs at `time` [s]. */
void model_outputs(Values *v, double time);

/* States at `time + size` from those at `time` [s], inputs constant in between. */
void model_step(Values *v, double time, double size);

/* First event after `time` [s]; HUGE_VAL if there is none. */
double model_next_event(const Values *v, double time);

/* Exact step of x' = A x (A row by row, n <= 8): Taylor series of the matrix exponential, applied to x. */
void linear_step(int n, const double A[], double size, double x[]);

#endif
