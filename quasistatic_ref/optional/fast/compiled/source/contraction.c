/* certify/minimiser.inverse, in float64 with a bound, with test_fast_certificate.py: how far z is from z*.

   With e = z* - z, r = f - K z and G = I - R K: e = R r + G e. If w >= |R| |r|, w > 0 and
   |G| w <= w / 2, let t be the largest |e_i| / w_i. Then |e| <= w + t w / 2, so that t <= 2; and I - G
   = R K is regular, hence K. */

#include <math.h>

#include "proof.h"

static void exchange(double *a, double *b)
{
    double x = *a;
    *a = *b;
    *b = x;
}

/* The inverse of a matrix in float64, in its place, by Gauss and Jordan; 0 if a pivot is zero. */
int inverse(double *R, int64_t n, int64_t *pivot)
{
    for (int64_t c = 0; c < n; c++) {
        int64_t p = c;
        for (int64_t i = c + 1; i < n; i++)
            if (fabs(R[i * n + c]) > fabs(R[p * n + c]))
                p = i;
        pivot[c] = p;
        for (int64_t j = 0; j < n && p != c; j++)
            exchange(R + c * n + j, R + p * n + j);
        double divisor = R[c * n + c];
        if (!(fabs(divisor) > 0.0))
            return 0;
        R[c * n + c] = 1.0;
        for (int64_t j = 0; j < n; j++)
            R[c * n + j] /= divisor;
        for (int64_t i = 0; i < n; i++) {
            double f = R[i * n + c];
            if (i == c || f == 0.0)
                continue;
            R[i * n + c] = 0.0;
            for (int64_t j = 0; j < n; j++)
                R[i * n + j] -= f * R[c * n + j];
        }
    }
    for (int64_t c = n - 1; c >= 0; c--) /* rows that were exchanged are columns of the inverse */
        for (int64_t i = 0; i < n && pivot[c] != c; i++)
            exchange(R + i * n + c, R + i * n + pivot[c]);
    return 1;
}

/* Upper bounds of |I - R K|, K being known to 2^-48 of the size of each entry; sizes has n entries. */
void defect(const double *R, const double *K, const double *size, int64_t n, double *G, double *sizes)
{
    for (int64_t i = 0; i < n; i++) {
        double *sums = G + i * n;
        for (int64_t j = 0; j < n; j++)
            sums[j] = sizes[j] = 0.0;
        for (int64_t l = 0; l < n; l++)
            for (int64_t j = 0; j < n; j++) {
                sums[j] += R[i * n + l] * K[l * n + j];
                sizes[j] += fabs(R[i * n + l] * size[l * n + j]);
            }
        for (int64_t j = 0; j < n; j++) {
            double one = i == j;
            double rounding = ((double)n * 0x1p-52 + 0x1p-47) * (sizes[j] + one);
            sums[j] = (fabs(one - sums[j]) + rounding + NORMAL) * UP;
        }
    }
}

/* e with |z* - z| <= e, given residuals |r|; 0 where the contraction is not shown. */
int error_bounds(const double *R, const double *G, const double *r, int64_t n, double *e)
{
    for (int64_t i = 0; i < n; i++) {
        double w = 0.0;
        for (int64_t j = 0; j < n; j++)
            w += fabs(R[i * n + j]) * (fabs(r[j]) + FLOOR);
        e[i] = w * UP;
    }
    for (int round = 0; round < 8; round++) {
        int shown = 1;
        for (int64_t i = 0; i < n; i++) {
            double moved = 0.0;
            for (int64_t j = 0; j < n; j++)
                moved += G[i * n + j] * e[j];
            if (!(moved * UP <= e[i] / 2 && e[i] < INFINITY)) {
                e[i] = 4 * moved;
                shown = 0;
            }
        }
        if (shown) {
            for (int64_t i = 0; i < n; i++)
                e[i] = 2 * e[i];
            return 1;
        }
    }
    return 0;
}
