/* The arithmetic is numpy's, so that both loops give the same bits: a Float32 is scaled in single precision, every other
 * number in double precision, multiplied and then added with a rounding after each (no fused multiply-add).
 */
#include "convert.h"

#include <stdbool.h>

#define EVERY(SOURCE, TARGET, VALUE)                                                                                   \
    do {                                                                                                               \
        const SOURCE *from = operation->source;                                                                        \
        TARGET *into = operation->target;                                                                              \
        for (size_t i = 0; i < operation->count; ++i) {                                                                \
            const SOURCE x = from[i * operation->source_step];                                                         \
            into[i] = (TARGET)(VALUE);                                                                                 \
        }                                                                                                              \
    } while (0)

#define SCALED(SOURCE, TARGET, WORK)                                                                                   \
    do {                                                                                                               \
        const WORK factor = (WORK)operation->factor, offset = (WORK)operation->offset;                                 \
        if (operation->factor == 1.0 && operation->offset == 0.0) {                                                    \
            EVERY(SOURCE, TARGET, x);                                                                                  \
        } else {                                                                                                       \
            EVERY(SOURCE, TARGET, factor * (WORK)x + offset);                                                          \
        }                                                                                                              \
    } while (0)

#define FROM(SOURCE, WORK)                                                                                             \
    switch (operation->target_type) {                                                                                  \
    case FLOAT64: SCALED(SOURCE, double, WORK); break;                                                                 \
    case FLOAT32: SCALED(SOURCE, float, WORK); break;                                                                  \
    case INT8: EVERY(SOURCE, int8_t, x); break;                                                                        \
    case UINT8: EVERY(SOURCE, uint8_t, x); break;                                                                      \
    case INT16: EVERY(SOURCE, int16_t, x); break;                                                                      \
    case UINT16: EVERY(SOURCE, uint16_t, x); break;                                                                    \
    case INT32: EVERY(SOURCE, int32_t, x); break;                                                                      \
    case UINT32: EVERY(SOURCE, uint32_t, x); break;                                                                    \
    case INT64: EVERY(SOURCE, int64_t, x); break;                                                                      \
    case UINT64: EVERY(SOURCE, uint64_t, x); break;                                                                    \
    default: EVERY(SOURCE, bool, x != 0); break;                                                                       \
    }                                                                                                                  \
    break

void convert(const Operation *operation)
{
    switch (operation->source_type) {
    case FLOAT64: FROM(double, double);
    case FLOAT32: FROM(float, float);
    case INT8: FROM(int8_t, double);
    case UINT8: FROM(uint8_t, double);
    case INT16: FROM(int16_t, double);
    case UINT16: FROM(uint16_t, double);
    case INT32: FROM(int32_t, double);
    case UINT32: FROM(uint32_t, double);
    case INT64: FROM(int64_t, double);
    case UINT64: FROM(uint64_t, double);
    default: FROM(bool, double);
    }
}
