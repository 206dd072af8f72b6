/* An inverse in float64, and what it proves: that a matrix is regular, and how far z is from z*.

   With e = z* - z, r = f - K z and G = I - R K: e = R r + G e. If w >= |R| |r|, w > 0 and
   |G| w <= w / 2, let t be the largest |e_i| / w_i. Then |e| <= w + t w / 2, so that t <= 2; and I - G
   = R K is regular, hence K. */

#include <math.h>

#include "proof.h"

/* The inverse of a matrix in float64, by Gauss and Jordan; 0 if a pivot is zero. */
int inverse(double *a, double *R, int64_t n)
{
    for (int64_t i = 0; i < n * n; i++)
        R[i] = i % (n + 1) ? 0.0 : 1.0;
    for (int64_t c = 0; c < n; c++) {
        int64_t p = c;
        for (int64_t i = c + 1; i < n; i++)
            if (fabs(a[i * n + c]) > fabs(a[p * n + c]))
                p = i;
        double pivot = a[p * n + c];
        if (!(fabs(pivot) > 0.0))
            return 0;
        for (int64_t j = 0; j < n; j++) {
            double x = a[p * n + j], y = R[p * n + j];
            a[p * n + j] = a[c * n + j];
            R[p * n + j] = R[c * n + j];
            a[c * n + j] = x / pivot;
            R[c * n + j] = y / pivot;
        }
        for (int64_t i = 0; i < n; i++) {
            double f = a[i * n + c];
            if (i == c || f == 0.0)
                continue;
            for (int64_t j = c; j < n; j++) /* before c the pivot's row is zero */
                a[i * n + j] -= f * a[c * n + j];
            for (int64_t j = 0; j < n; j++)
                R[i * n + j] -= f * R[c * n + j];
        }
    }
    return 1;
}

/* Upper bounds of |I - R K|, K being known to a relative 2^-48 of each entry; sizes has room for n. */
void defect(const double *R, const double *K, int64_t n, double *G, double *sizes)
{
    for (int64_t i = 0; i < n; i++) {
        double *sums = G + i * n;
        for (int64_t j = 0; j < n; j++)
            sums[j] = sizes[j] = 0.0;
        for (int64_t l = 0; l < n; l++)
            for (int64_t j = 0; j < n; j++) {
                double term = R[i * n + l] * K[l * n + j];
                sums[j] += term;
                sizes[j] += fabs(term);
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
            if (!(moved * UP <= e[i] / 2)) {
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
