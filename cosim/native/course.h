/* Values given over time (cosim/programme.py). */
#ifndef COSIM_NATIVE_COURSE_H
#define COSIM_NATIVE_COURSE_H

#include "plan.h"

/* Set the target to the values held at `time` [ns]. */
void course_held(const Operation *operation, int64_t time);

/* Set the target to the values interpolated at `time` [ns]. */
void course_linear(const Operation *operation, double time);

#endif
