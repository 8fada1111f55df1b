/* Doubles as text. */
#ifndef COSIM_NATIVE_DECIMAL_H
#define COSIM_NATIVE_DECIMAL_H

#include <stdint.h>

enum {
    SMALLEST_POWER = -292, /* range of the table of powers of ten, see cosim/native/powers.py */
    LARGEST_POWER = 324,
    LONGEST_NUMBER = 25 /* bytes of the longest text, -2.2250738585072014e-308 among them */
};

/* Write the shortest text that reads back as `value`, byte for byte what Python's repr gives; returns its end. */
char *write_double(char *text, double value, const uint64_t *powers);

/* Write an integer; returns its end. */
char *write_unsigned(char *text, uint64_t value);
char *write_signed(char *text, int64_t value);

#endif
