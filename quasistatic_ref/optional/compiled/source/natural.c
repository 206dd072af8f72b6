/* How large a step is: solve/units, `step_sizes`. */

#include "vectors.h"

/* The k-th smallest of n numbers, which change places. */
static double ranked(double *x, int64_t n, int64_t k)
{
    int64_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = x[(low + high) / 2];
        int64_t i = low, j = high;
        while (i <= j) {
            while (x[i] < pivot)
                i++;
            while (pivot < x[j])
                j--;
            if (i <= j) {
                double swapped = x[i];
                x[i++] = x[j];
                x[j--] = swapped;
            }
        }
        if (k > j && k < i)
            break;
        if (k <= j)
            high = j;
        else
            low = i;
    }
    return x[k];
}

/* `sizes`: rows, own columns, coordinates, columns of L^-1; `coordinate` says which these are, or that one is none.
   Written: a workspace of as many numbers as rows; the median length, the largest square, the largest entry of b,
   the free length. 0 where a number is not finite. */
int64_t step_sizes(const int64_t *sizes, const double *A, const double *unit, const double *b, const double *g,
                   const double *inverse, const int64_t *coordinate, double *squares, double *written)
{
    int64_t m = sizes[0], w = sizes[1], n = sizes[2], wide = sizes[3], count = 0;
    double length = 0.0;
    double most = 0.0, push_out = 0.0;
    for (int64_t i = 0; i < m; i++) {
        double sum = 0.0;
        for (int64_t k = i * w; k < (i + 1) * w; k++) {
            double scaled = A[k] * unit[k];
            sum += scaled * scaled;
        }
        if (!(sum < INFINITY && fabs(b[i]) < INFINITY))
            return 0;
        most = larger(most, sum);
        push_out = larger(push_out, b[i]);
        if (sum != 0.0)
            squares[count++] = sum;
    }
    written[0] = 1.0;
    if (count) {
        double high = ranked(squares, count, count / 2);
        double low = count % 2 ? high : ranked(squares, count, count / 2 - 1);
        written[0] = (sqrt(low) + sqrt(high)) / 2;
    }
    written[1] = most;
    written[2] = push_out;
    for (int64_t i = 0; i < n; i++) { /* `free_lengths` */
        double sum = 0.0;
        for (int64_t k = i * wide; k < (i + 1) * wide; k++)
            sum += inverse[k] * (coordinate[k] < n ? g[coordinate[k]] : 0.0);
        length = hypot(length, sum);
    }
    written[3] = length;
    return length < INFINITY;
}
