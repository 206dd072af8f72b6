/* certify/rounding.nearest_numbers of fixed point within a bound, with test_fast_rounding.py. */

#include <math.h>

#include "proof.h"

/* Whether c is the float64 nearest to c + rest / h, the rest being known to within e. */
static int is_nearest(double c, double rest, double e, double h)
{
    double above = nextafter(c, INFINITY) - c, below = c - nextafter(c, -INFINITY);
    double beyond = rest > 0.0 ? rest * UP : 0.0, short_of = rest < 0.0 ? -rest * UP : 0.0;
    return beyond + e < h * above / 2 * DOWN && short_of + e < h * below / 2 * DOWN;
}

/* The float64 nearest to x, which is known to within e, from its first two digits; 0 where they do
   not show it. */
static int nearest_of_two(const Number *x, double e, double *c)
{
    int last = x->high - 2;
    if (last < 0)
        return 0;
    __int128 first = (__int128)x->d[last + 1] * ((__int128)1 << BITS);
    first += last < x->low ? 0 : x->d[last]; /* which is not set below the lowest */
    double near = (double)first, unit = ldexp(1.0, BITS * (last - FRACTION));
    double rest = (double)(first - (__int128)near);
    *c = near * unit;
    return is_nearest(*c, rest * unit, e + unit, 1.0); /* what follows is less than one unit */
}

/* The float64 nearest to x / h, x being known to within e; 0 if that is not shown. */
static int nearest_quotient(const Number *x, double e, double h, double *out)
{
    double c = value(x) / h;
    Number divisor = number(exact(h));
    for (int round = 0; round < 3; round++) {
        Sum sum = EMPTY;
        add(&sum, x);
        add_product(&sum, &divisor, exact(c), -1);
        Number left;
        carried(&sum, &left);
        double rest = value(&left), better = c + rest / h;
        *out = c;
        if (better == c)
            return is_nearest(c, rest, e, h);
        c = better; /* to which the rest does not belong */
    }
    return 0;
}

/* The same, times a unit; zero is shown if it is known exactly. */
int nearest(const Number *x, double e, double h, double unit, double *out)
{
    *out = 0.0;
    if (x->low == x->high)
        return e == 0.0;
    int shown = h == 1.0 && nearest_of_two(x, e, out);
    shown = shown || nearest_quotient(x, e, h, out);
    *out *= unit;
    return shown && fabs(*out) > NORMAL && fabs(*out) < 1 / NORMAL;
}

/* Whether x / h, x being known to within e, may be half-way between two float64 numbers: the even one
   of these times a unit, and h times the middle. */
int half_way(const Number *x, double e, double h, double unit, double *out, Number *middle)
{
    Number divisor = number(exact(h)), left;
    double lower = value(x) / h;
    for (int i = 0; i < 2; i++)
        lower = nextafter(lower, -INFINITY);
    for (int i = 0; i < 4; i++) { /* the quotient may be off by a last bit */
        double upper = nextafter(lower, INFINITY);
        int64_t bits;
        Sum sum = EMPTY;
        add_product(&sum, &divisor, exact(lower), 1);
        add_product(&sum, &divisor, exact((upper - lower) / 2), 1);
        carried(&sum, middle);
        add(&sum, x);
        add_product(&sum, middle, exact(1.0), -1);
        carried(&sum, &left);
        memcpy(&bits, &lower, sizeof bits);
        *out = (bits & 1 ? upper : lower) * unit;
        if (fabs(value(&left)) * DOWN <= e)
            return fabs(*out) > NORMAL && fabs(*out) < 1 / NORMAL;
        lower = upper;
    }
    return 0;
}
