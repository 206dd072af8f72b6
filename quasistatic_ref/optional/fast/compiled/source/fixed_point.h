/* certify/rational.Dyadic in whole multiples of 2^-896, never rounded, with test_fast_fixed_point.py.

   A Number is the sum of d[j] 2^(56 (j - 16)) over its digits from `low` to below `high`; digits
   are from -2^55 to 2^55, those of a float64, of which there are two at most, inside of +-2^56.
   A Float is a float64 that is a factor: (low + high 2^56) 2^(56 (place - 16)).
   Products are collected in a Sum. Its digits hold 2^14 of them, and are zero below `low` and
   from `high` on. */

#ifndef FIXED_POINT_H
#define FIXED_POINT_H

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { BITS = 56, FRACTION = 16, DIGITS = 20 };

typedef struct { int low, high; int64_t d[DIGITS]; } Number;
typedef struct { int place; int64_t low, high; } Float;
typedef struct { int low, high; __int128 d[DIGITS]; } Sum;

static const Sum EMPTY = {DIGITS, 0, {0}};
static const Number ZERO = {0, 0, {0}};

/* Set by whatever might not fit, below the grid or beyond the last digit, and cleared by hand, as the
   flags of a processor are: what this thread has computed since is worth nothing. */
extern _Thread_local int lost;

/* A float64. What lies below 2^-grid is cut off where `cut` is set, else lost. */
static inline Float digits_of(double x, int grid, int cut)
{
    Float f = {0, 0, 0};
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
    unsigned shift = (unsigned)place % BITS;
    int sign = 1 - 2 * (int)(bits >> 63);
    f.place = (int)((unsigned)place / BITS);
    f.low = sign * (int64_t)(((uint64_t)m << shift) & (((uint64_t)1 << BITS) - 1));
    f.high = sign * (m >> (BITS - shift));
    return f;
}

static inline Float exact(double x) { return digits_of(x, BITS * FRACTION, 0); }

static inline Number number(Float f)
{
    Number x;
    x.low = f.place;
    x.high = f.place + (f.high != 0 ? 2 : f.low != 0);
    x.d[f.place] = f.low;
    x.d[f.place + 1] = f.high;
    return x;
}

static inline int empty(const Number *x) { return x->low == x->high; }

/* Count the digits from `low` to below `high` as digits of a sum. */
static inline void reach(Sum *sum, int low, int high)
{
    sum->low = low < sum->low ? low : sum->low;
    sum->high = high > sum->high ? high : sum->high;
}

static inline void add(Sum *sum, const Number *x)
{
    if (empty(x))
        return;
    reach(sum, x->low, x->high);
    for (int j = x->low; j < x->high; j++)
        sum->d[j] += x->d[j];
}

/* Add x y, or subtract it where the sign is -1. */
static inline void add_product(Sum *sum, const Number *x, Float y, int sign)
{
    int count = x->high - x->low, first = x->low + y.place - FRACTION, last = first + count;
    if (count == 0 || !(y.low | y.high))
        return;
    if (first < 0 || last >= DIGITS) {
        lost = 1;
        return;
    }
    reach(sum, first, last + 1);
    const int64_t *digit = x->d + x->low;
    int64_t low = sign * y.low, high = sign * y.high;
    __int128 *to = sum->d + first, above = 0;
    for (int j = 0; j < count; j++) {
        to[j] += above + (__int128)digit[j] * low;
        above = (__int128)digit[j] * high;
    }
    to[count] += above;
}

/* The number that a sum has come to; the sum is empty then. */
static inline void carried(Sum *sum, Number *x)
{
    __int128 carry = 0;
    int low = sum->low, j = low;
    for (; j < sum->high || (carry && j < DIGITS); j++) {
        __int128 digit = sum->d[j] + carry;
        sum->d[j] = 0;
        carry = (digit + ((__int128)1 << (BITS - 1))) >> BITS;
        x->d[j] = (int64_t)((uint64_t)digit - ((uint64_t)carry << BITS));
    }
    if (carry)
        lost = 1;
    sum->low = DIGITS;
    sum->high = 0;
    while (j > low && x->d[j - 1] == 0)
        j--;
    while (low < j && x->d[low] == 0)
        low++;
    x->low = low;
    x->high = j;
}

static inline void total(const Number *x, const Number *y, Number *out)
{
    Sum sum = EMPTY;
    add(&sum, x);
    add(&sum, y);
    carried(&sum, out);
}

static inline void product(const Number *x, Float y, Number *out)
{
    Sum sum = EMPTY;
    add_product(&sum, x, y, 1);
    carried(&sum, out);
}

/* The value, to a relative 2^-50, from the first two digits: what follows is less than one unit of
   the second, and they are at least 2^55 of these units. */
static inline double value(const Number *x)
{
    static const double weight[DIGITS] = {
        0x1p-896, 0x1p-840, 0x1p-784, 0x1p-728, 0x1p-672, 0x1p-616, 0x1p-560,
        0x1p-504, 0x1p-448, 0x1p-392, 0x1p-336, 0x1p-280, 0x1p-224, 0x1p-168,
        0x1p-112, 0x1p-56, 1.0, 0x1p56, 0x1p112, 0x1p168,
    };
    int last = x->high - 2 > x->low ? x->high - 2 : x->low;
    double sum = 0.0;
    for (int j = x->high - 1; j >= last; j--)
        sum = sum * 0x1p56 + (double)x->d[j];
    return x->high > x->low ? sum * weight[last] : 0.0;
}

#endif
