/* exp(x) that the compiler turns into vector code: relative error below 1e-15 (test: test_exponential).
 *
 * x = n ln 2 + r with |r| <= ln 2 / 2; exp(r) by its Taylor polynomial, whose first term left out is below 2e-16;
 * 2^n is added to the exponent's bits. Outside +-700 the argument is clamped: the result stays finite and normal.
 * Method: J.-M. Muller, Elementary Functions, 3rd ed., Birkhaeuser 2016, chapter 11 (additive range reduction).
 */
#ifndef EXPONENTIAL_H
#define EXPONENTIAL_H

#include <stdint.h>

static inline double network_exp(double x)
{
    const double magic = 0x1.8p52; /* adding it rounds to a whole number, which then stands in the lowest bits */
    x = x > 700.0 ? 700.0 : x;
    x = x < -700.0 ? -700.0 : x;
    const double rounded = x * 1.4426950408889634074 + magic;
    const double n = rounded - magic;
    const double r = (x - n * 0x1.62e42fee00000p-1) - n * 0x1.a39ef35793c76p-33;
    double y = 1.0 / 479001600.0;
    y = y * r + 1.0 / 39916800.0;
    y = y * r + 1.0 / 3628800.0;
    y = y * r + 1.0 / 362880.0;
    y = y * r + 1.0 / 40320.0;
    y = y * r + 1.0 / 5040.0;
    y = y * r + 1.0 / 720.0;
    y = y * r + 1.0 / 120.0;
    y = y * r + 1.0 / 24.0;
    y = y * r + 1.0 / 6.0;
    y = y * r + 0.5;
    y = y * r + 1.0;
    y = y * r + 1.0;
    int64_t power, bits;
    __builtin_memcpy(&power, &rounded, 8);
    __builtin_memcpy(&bits, &y, 8);
    bits += (int64_t)((uint64_t)power << 52);
    __builtin_memcpy(&y, &bits, 8);
    return y;
}

/* (1 - exp(-x)) / x for x >= 0, 1 at 0: mean of exp(-s x) over s from 0 to 1. The series' error is below 1e-16. */
static inline double network_relaxation(double x)
{
    const double series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0))));
    const double closed = (1.0 - network_exp(-x)) / (x < 1e-3 ? 1.0 : x);
    return x < 1e-3 ? series : closed;
}

/* (1 - network_relaxation(x)) / x, 1/2 at 0: how far the mean of an exponential approach has come. */
static inline double network_approach(double x)
{
    const double series = 0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0)));
    const double closed = (1.0 - network_relaxation(x)) / (x < 1e-3 ? 1.0 : x);
    return x < 1e-3 ? series : closed;
}

#endif
