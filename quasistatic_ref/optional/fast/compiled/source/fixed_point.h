/* Numbers of fixed point that are never rounded: whole multiples of 2^-896.

   A Number is the sum of d[j] 2^(56 (j - 16)) over its digits from `low` to below `high`; digits
   are from -2^55 to 2^55, those of a float64, of which there are two at most, inside of +-2^56.
   Products are collected in a Sum, whose digits have room for 2^14 of them. */

#ifndef FIXED_POINT_H
#define FIXED_POINT_H

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { BITS = 56, FRACTION = 16, DIGITS = 19 };

typedef struct { int low, high; int64_t d[DIGITS]; } Number;
typedef struct { int low, high; __int128 d[DIGITS]; } Sum;

/* Set by whatever would not fit, below the grid or beyond the last digit, and cleared by hand, as the
   flags of a processor are: what this thread has computed since is worth nothing. */
extern _Thread_local int lost;

/* A float64. What lies below 2^-grid is cut off where `cut` is set, else lost. */
static inline Number digits_of(double x, int grid, int cut)
{
    Number f;
    f.low = f.high = 0;
    if (x == 0.0)
        return f;
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int exponent = (int)(bits >> 52 & 2047); /* x = +- m 2^(exponent - 1075) */
    int64_t m = (int64_t)((bits & (((uint64_t)1 << 52) - 1)) | (uint64_t)1 << 52);
    int place = exponent - 1075 + BITS * FRACTION; /* of m's last bit, above the grid of all */
    int below = BITS * FRACTION - grid - place;
    if (exponent == 0 || place >= BITS * (DIGITS - 2)) { /* subnormal, or too large, or no number */
        lost = 1;
        return f;
    }
    if (below > 0) {
        int64_t kept = below > 53 ? 0 : (m >> below) << below;
        if (kept != m && !cut)
            lost = 1;
        m = kept;
        if (m == 0)
            return f;
        if (place < 0) { /* the last bits are zero now */
            m >>= -place;
            place = 0;
        }
    }
    int shift = place % BITS, j = place / BITS;
    int64_t low = (int64_t)(((uint64_t)m << shift) & (((uint64_t)1 << BITS) - 1));
    int64_t high = shift ? m >> (BITS - shift) : 0;
    f.low = low ? j : j + 1;
    f.high = high ? j + 2 : j + 1;
    f.d[j] = x < 0.0 ? -low : low;
    f.d[j + 1] = x < 0.0 ? -high : high;
    return f;
}

static inline Number exact(double x) { return digits_of(x, BITS * FRACTION, 0); }

static inline void clear(Sum *sum) { sum->low = sum->high = 0; }

/* Have the digits from `low` to below `high` set. */
static inline void reach(Sum *sum, int low, int high)
{
    if (sum->low == sum->high)
        sum->low = sum->high = low;
    while (sum->low > low)
        sum->d[--sum->low] = 0;
    while (sum->high < high)
        sum->d[sum->high++] = 0;
}

static inline void add(Sum *sum, const Number *x)
{
    if (x->low == x->high)
        return;
    reach(sum, x->low, x->high);
    for (int j = x->low; j < x->high; j++)
        sum->d[j] += x->d[j];
}

/* Add x y, or subtract it where the sign is -1. */
static inline void add_product(Sum *sum, const Number *x, const Number *y, int sign)
{
    int first = x->low + y->low - FRACTION, last = x->high + y->high - 1 - FRACTION;
    if (x->low == x->high || y->low == y->high)
        return;
    if (first < 0 || last > DIGITS) {
        lost = 1;
        return;
    }
    reach(sum, first, last);
    for (int k = y->low; k < y->high; k++) {
        int64_t digit = sign * y->d[k];
        for (int j = x->low; j < x->high; j++)
            sum->d[j + k - FRACTION] += (__int128)x->d[j] * digit;
    }
}

static inline Number carried(const Sum *sum)
{
    Number x;
    __int128 carry = 0;
    x.low = x.high = 0;
    for (int j = sum->low; j < DIGITS && (j < sum->high || carry); j++) {
        __int128 digit = (j < sum->high ? sum->d[j] : 0) + carry;
        carry = (digit + ((__int128)1 << (BITS - 1))) >> BITS;
        x.d[j] = (int64_t)(digit - carry * ((__int128)1 << BITS));
        if (x.d[j]) {
            x.low = x.high ? x.low : j;
            x.high = j + 1;
        }
    }
    if (carry)
        lost = 1;
    return x;
}

static inline Number total(const Number *x, const Number *y)
{
    Sum sum;
    clear(&sum);
    add(&sum, x);
    add(&sum, y);
    return carried(&sum);
}

static inline Number product(const Number *x, const Number *y)
{
    Sum sum;
    clear(&sum);
    add_product(&sum, x, y, 1);
    return carried(&sum);
}

/* The value, to a relative 2^-50: the first digit is at least twice what follows. */
static inline double value(const Number *x)
{
    static const double weight[DIGITS] = {
        0x1p-896, 0x1p-840, 0x1p-784, 0x1p-728, 0x1p-672, 0x1p-616, 0x1p-560,
        0x1p-504, 0x1p-448, 0x1p-392, 0x1p-336, 0x1p-280, 0x1p-224, 0x1p-168,
        0x1p-112, 0x1p-56, 1.0, 0x1p56, 0x1p112,
    };
    int last = x->high - 4 > x->low ? x->high - 4 : x->low;
    double sum = 0.0;
    for (int j = x->high - 1; j >= last; j--)
        sum = sum * 0x1p56 + (double)x->d[j];
    return x->high > x->low ? sum * weight[last] : 0.0;
}

#endif
