/* Initialises itself in fmi2SetupExperiment, as FMUs of some tools do: whatever was set before is forgotten. The output
 * is gain * start_level * sign; `limited` stays below 1. */
#include "plain.h"

const char MODEL_TOKEN[] = "early";
NO_STATES ALL_SCALARS NO_DISCRETE_INPUTS NO_INDICATORS NO_STEP_EVENTS NO_EVENTS STEP_TO_END

enum { GAIN = 1, START_LEVEL = 2, LIMITED = 3, OUTPUT = 4, STOP = 5, COUNT = 6, FLIPPED = 7, SINGLE = 8 };

void model_start(Values *v) {
    v->number[GAIN][0] = 1.0; v->number[START_LEVEL][0] = 1.0; v->number[LIMITED][0] = 0.5;
    v->whole[COUNT][0] = 1; v->whole[FLIPPED][0] = 0; v->number[SINGLE][0] = 0.25; v->number[STOP][0] = -2.0;
}

void model_setup(Values *v, double stop) { model_start(v); v->number[STOP][0] = stop; }

bool model_is_readable(unsigned r) { return r != COUNT; }

void model_outputs(Values *v) {
    if (v->number[LIMITED][0] > 1.0) v->number[LIMITED][0] = 1.0;
    v->number[SINGLE][0] = (float)v->number[SINGLE][0];
    v->number[OUTPUT][0] = v->number[GAIN][0] * v->number[START_LEVEL][0] * (double)v->whole[COUNT][0]
        * (v->whole[FLIPPED][0] ? -1.0 : 1.0);
}
