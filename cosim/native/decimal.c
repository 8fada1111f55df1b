/* Shortest decimal text of a double.
 *
 * Source of the algorithm: R. Giulietti, "The Schubfach way to render doubles" (2021). A double c 2^q stands for all
 * reals nearer to it than to its neighbours. With 10^k the largest power of ten that is not wider than that interval,
 * at most two multiples of 10^(k+1) lie near it; if one lies in the interval it is the shortest, else the multiple of
 * 10^k nearest to c 2^q is. The comparisons need c 2^q / 10^k to 128 bits only.
 */
#include "decimal.h"

#include <stdbool.h>
#include <string.h>

enum { FRACTION_BITS = 52, EXPONENT_BIAS = 1075, EXPONENT_MASK = 0x7ff };

typedef struct {
    uint64_t digits;
    int32_t power; /* value = digits * 10^power */
} Decimal;

typedef struct {
    uint64_t high, low;
} Wide;

static inline Wide multiply(uint64_t a, uint64_t b)
{
#if defined(__SIZEOF_INT128__)
    __extension__ typedef unsigned __int128 Product;
    const Product product = (Product)a * b;
    return (Wide){(uint64_t)(product >> 64), (uint64_t)product};
#else
    const uint64_t al = (uint32_t)a, ah = a >> 32, bl = (uint32_t)b, bh = b >> 32;
    const uint64_t ll = al * bl, lh = al * bh, hl = ah * bl;
    const uint64_t middle = (ll >> 32) + (uint32_t)lh + (uint32_t)hl;
    return (Wide){ah * bh + (lh >> 32) + (hl >> 32) + (middle >> 32), (middle << 32) | (uint32_t)ll};
#endif
}

/* Top 64 bits of the 192-bit product of a power of ten and `factor`; the last bit is set if anything lies below. */
static inline uint64_t scaled(const uint64_t power[2], uint64_t factor)
{
    const Wide high = multiply(power[0], factor), low = multiply(power[1], factor);
    const uint64_t middle = high.low + low.high;
    return (high.high + (middle < high.low)) | (middle > 1);
}

/* floor(log10(2^e)), floor(log10(3/4 2^e)) and floor(log2(10^e)); exact for all exponents of doubles. */
static inline int32_t log10_of_power_of_2(int32_t e) { return (e * 1262611) >> 22; }
static inline int32_t log10_of_narrow_power_of_2(int32_t e) { return (e * 1262611 - 524031) >> 22; }
static inline int32_t log2_of_power_of_10(int32_t e) { return (e * 1741647) >> 19; }

static Decimal shortest(uint64_t fraction, int32_t biased, const uint64_t *powers)
{
    const bool is_normal = biased != 0;
    const uint64_t c = is_normal ? fraction | (UINT64_C(1) << FRACTION_BITS) : fraction;
    const int32_t q = (is_normal ? biased : 1) - EXPONENT_BIAS;
    /* The neighbour below a power of two is only half as far away. */
    const bool is_narrow = fraction == 0 && biased > 1;
    const int32_t k = is_narrow ? log10_of_narrow_power_of_2(q) : log10_of_power_of_2(q);
    const int32_t shift = q + log2_of_power_of_10(-k) + 1;
    const uint64_t *power = powers + 2 * (-k - SMALLEST_POWER);
    const uint64_t value = scaled(power, 4 * c << shift);
    /* The interval's ends round to an even c only. */
    const uint64_t odd = c & 1;
    const uint64_t lower = scaled(power, (4 * c - (is_narrow ? 1 : 2)) << shift) + odd;
    const uint64_t upper = scaled(power, (4 * c + 2) << shift) - odd;
    const uint64_t s = value / 4;
    if (s >= 10) {
        const uint64_t tens = s / 10;
        const bool below = lower <= 40 * tens, above = 40 * tens + 40 <= upper;
        if (below != above) {
            return (Decimal){tens + above, k + 1};
        }
    }
    const bool below = lower <= 4 * s, above = 4 * s + 4 <= upper;
    if (below != above) {
        return (Decimal){s + above, k};
    }
    const uint64_t middle = 4 * s + 2;
    return (Decimal){s + (value > middle || (value == middle && (s & 1))), k};
}

char *write_unsigned(char *text, uint64_t value)
{
    char digits[20];
    int begin = 20;
    do {
        digits[--begin] = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    memcpy(text, digits + begin, (size_t)(20 - begin));
    return text + (20 - begin);
}

char *write_signed(char *text, int64_t value)
{
    if (value < 0) {
        *text++ = '-';
        return write_unsigned(text, UINT64_C(0) - (uint64_t)value);
    }
    return write_unsigned(text, (uint64_t)value);
}

static char *write_exponent(char *text, int32_t exponent)
{
    *text++ = 'e';
    *text++ = exponent < 0 ? '-' : '+';
    const uint64_t size = (uint64_t)(exponent < 0 ? -exponent : exponent);
    if (size < 10) {
        *text++ = '0';
    }
    return write_unsigned(text, size);
}

static char *fill(char *text, char with, int32_t count)
{
    memset(text, with, (size_t)count);
    return text + count;
}

/* Python's choice of notation: an exponent below 1e-4 and from 1e16 on. */
static char *write_decimal(char *text, Decimal decimal)
{
    while (decimal.digits % 10 == 0) {
        decimal.digits /= 10;
        decimal.power += 1;
    }
    char digits[20];
    const int32_t count = (int32_t)(write_unsigned(digits, decimal.digits) - digits);
    const int32_t point = count + decimal.power; /* digits before the decimal point */
    if (point <= -4 || point > 16) {
        *text++ = digits[0];
        if (count > 1) {
            *text++ = '.';
            memcpy(text, digits + 1, (size_t)count - 1);
            text += count - 1;
        }
        return write_exponent(text, point - 1);
    }
    if (point <= 0) {
        memcpy(text, "0.", 2);
        text = fill(text + 2, '0', -point);
        memcpy(text, digits, (size_t)count);
        return text + count;
    }
    if (point >= count) {
        memcpy(text, digits, (size_t)count);
        text = fill(text + count, '0', point - count);
        memcpy(text, ".0", 2);
        return text + 2;
    }
    memcpy(text, digits, (size_t)point);
    text[point] = '.';
    memcpy(text + point + 1, digits + point, (size_t)(count - point));
    return text + count + 1;
}

static char *write_word(char *text, const char *word)
{
    memcpy(text, word, 3);
    return text + 3;
}

char *write_double(char *text, double value, const uint64_t *powers)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint64_t fraction = bits & ((UINT64_C(1) << FRACTION_BITS) - 1);
    const int32_t biased = (int32_t)(bits >> FRACTION_BITS) & EXPONENT_MASK;
    if (biased == EXPONENT_MASK && fraction) {
        return write_word(text, "nan");
    }
    if (bits >> 63) {
        *text++ = '-';
        value = -value;
    }
    if (biased == EXPONENT_MASK) {
        return write_word(text, "inf");
    }
    /* Integers are frequent (states, counts, zeros) and need no search. */
    if (value < 9007199254740992.0 && value == (double)(uint64_t)value) {
        text = write_unsigned(text, (uint64_t)value);
        memcpy(text, ".0", 2);
        return text + 2;
    }
    return write_decimal(text, shortest(fraction, biased, powers));
}
