/* Questions about arrays of values that are asked in every macro-step. */
#ifndef COSIM_NATIVE_VALUES_H
#define COSIM_NATIVE_VALUES_H

#include <stdbool.h>
#include <string.h>

#include "plan.h"

static inline bool is_finite(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return (bits & UINT64_C(0x7ff0000000000000)) != UINT64_C(0x7ff0000000000000);
}

/* Index of the first element that is not finite, or -1; integers and Booleans are finite. */
static inline int64_t first_not_finite(const void *values, int32_t type, size_t count)
{
    if (type == FLOAT64) {
        const double *numbers = values;
        for (size_t i = 0; i < count; ++i) {
            if (!is_finite(numbers[i])) {
                return (int64_t)i;
            }
        }
    } else if (type == FLOAT32) {
        const float *numbers = values;
        for (size_t i = 0; i < count; ++i) {
            if (!is_finite((double)numbers[i])) {
                return (int64_t)i;
            }
        }
    }
    return -1;
}

/* Whether all elements compare equal, as numpy's == does: NaN to nothing, -0.0 to 0.0. */
static inline bool are_equal(const void *one, const void *other, int32_t type, size_t count, size_t bytes)
{
    if (type == FLOAT64) {
        const double *x = one, *y = other;
        for (size_t i = 0; i < count; ++i) {
            if (x[i] != y[i]) {
                return false;
            }
        }
        return true;
    }
    if (type == FLOAT32) {
        const float *x = one, *y = other;
        for (size_t i = 0; i < count; ++i) {
            if (x[i] != y[i]) {
                return false;
            }
        }
        return true;
    }
    return memcmp(one, other, bytes) == 0;
}

#endif
