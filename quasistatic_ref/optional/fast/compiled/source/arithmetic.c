/* No function of the core: test_selftest.py. The operations that all other files are made of, on numbers
   that show what a compiler has made of them: selftest.py knows the bits and digits of the results. */

#include "proof.h"

/* Of n triples x, y, z eight results each; then two sums over the first `count` of them. */
void arithmetic(const double *triples, int64_t n, int64_t count, double *out)
{
    double by = triples[1], total = 0.0, products = 0.0;
    for (int64_t i = 0; i < n; i++) {
        double x = triples[3 * i], y = triples[3 * i + 1], z = triples[3 * i + 2];
        *out++ = x * y + z;
        *out++ = x + y - x;
        *out++ = x / by;
        *out++ = x / 3.0;
        *out++ = x * 0.1;
        *out++ = 0.0 - x;
        *out++ = sqrt(y);
        *out++ = x == x;
    }
    for (int64_t i = 0; i < count; i++)
        total += triples[3 * i];
    for (int64_t i = 0; i < count; i++)
        products += triples[3 * i] * triples[3 * i + 1];
    *out++ = total;
    *out = products;
}

/* Of each sum of `terms` products of three factors, alternately added and subtracted, its digits; of
   each of as many numbers its digits, cut at 2^-GRID. In `found` whether something was lost of the
   sum, its value, and twice whether the nearest float64 is shown and which that is: of the sum, and of
   its quotient by h; whether something of the number is lost that is not to be cut; whether a third
   number does not fit, and its value; and of the sum and the quotient, whether they lie in the middle
   of two float64, and which of these is even, times 2^-930. The last middle has digits, too. */
void fixed_point(const double *factors, const double *cut, const double *edge, int64_t sums,
                 int64_t terms, double h, int64_t *digits, double *found)
{
    for (int64_t s = 0; s < sums; s++, factors += 3 * terms, digits += 3 * DIGITS, found += 13) {
        struct { Sum sum; __int128 behind; } workspace = {EMPTY, 0}; /* a digit beyond the last shows */
        Sum *sum = &workspace.sum;
        Number of[3];
        memset(of, 0x55, sizeof of); /* nothing may depend on digits that are not set */
        lost = 0;
        for (int64_t i = 0; i < terms; i++) {
            Number x = number(exact(factors[3 * i]));
            product(&x, exact(factors[3 * i + 1]), &x);
            add_product(sum, &x, exact(factors[3 * i + 2]), i % 2 ? -1 : 1);
        }
        carried(sum, of);
        of[1] = number(digits_of(cut[s], GRID, 1));
        found[0] = lost;
        found[1] = value(of);
        found[2] = nearest(of, 0.0, 1.0, 1.0, found + 3);
        found[4] = nearest(of, 0.0, h, 1.0, found + 5);
        found[9] = half_way(of, 0.0, 1.0, 0x1p-930, found + 10, of + 2);
        found[11] = half_way(of, 0.0, h, 0x1p-930, found + 12, of + 2);
        for (int k = 0; k < 3; k++)
            for (int j = 0; j < DIGITS; j++)
                digits[k * DIGITS + j] = j >= of[k].low && j < of[k].high ? of[k].d[j] : 0;
        lost = 0;
        digits_of(cut[s], GRID, 0);
        found[6] = lost;
        lost = 0;
        Number x = number(exact(edge[s]));
        found[7] = lost;
        found[8] = lost ? 0.0 : value(&x);
    }
}
