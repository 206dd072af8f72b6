/* solve/units, `units_of`, and the program in these units.

   Units are powers of two, of lengths that are sums; BLAS takes those in an order of its own. A
   unit is decided only if it is the same for all that the sums of any order may come to. */

#include "vectors.h"

#define LARGEST 0x1p400 /* squares, and products of two units, stay far inside of float64 */
#define UNMOVED 1e-6     /* that of tolerances.py */
#define OFF 0x1p-32     /* sums of n terms and n such sums, n <= 2^16, differ by less: 4 n 2^-53 = 2^-35;
                           the rest is for H^-1, which NumPy takes of all groups at once */

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

/* The exponent of the power of two that is nearest to a number, by their logarithms. */
static int exponent(double x)
{
    int above;
    return frexp(x, &above) < sqrt(0.5) ? above - 1 : above;
}

/* The power of two that is nearest to all numbers from low to high; 0 if there is none. */
static double power_of_two(double low, double high)
{
    low *= 1 - OFF;
    high *= 1 + OFF;
    if (!(low > 1 / LARGEST && high < LARGEST && exponent(low) == exponent(high)))
        return 0.0;
    return ldexp(1.0, exponent(low));
}

/* Of the median length of the rows of A S that are not zero; 0 where that is open. */
static double length_unit(const Natural *s)
{
    int64_t count = 0;
    const double *A = s->A;
    const int64_t *column = s->column;
    for (int64_t row = 0; row < s->m; row++, A += s->columns, column += s->columns) {
        double sum = 0.0;
        for (int64_t k = 0; k < s->columns; k++)
            sum += A[k] * A[k] * s->squared[column[k]];
        if (sum == 0.0)
            continue;
        if (!(sum > 1 / LARGEST && sum < LARGEST))
            return 0.0;
        s->squares[count++] = sum;
    }
    if (!count)
        return 1.0;
    double upper = ranked(s->squares, count, count / 2);
    double lower = count % 2 ? upper : ranked(s->squares, count, count / 2 - 1);
    double median = (sqrt(lower) + sqrt(upper)) / 2;
    return power_of_two(median, median);
}

/* Of the longer of the unconstrained step and the push out of penetration; 0 where that is open. */
static double size_unit(const Natural *s, double length)
{
    double energy = 0.0, off = 0.0, most = 0.0, load = 0.0;
    const double *inverse = s->inverse;
    const int64_t *coordinate = s->coordinate;
    for (int64_t group = 0; group < s->groups; coordinate += s->width[group++])
        for (int64_t i = 0; i < s->width[group]; i++) {
            double g = s->g[coordinate[i]], sum = 0.0, size = 0.0;
            for (int64_t j = 0; j < s->width[group]; j++) {
                double term = *inverse++ * s->g[coordinate[j]];
                sum += term;
                size += fabs(term);
            }
            energy += g * sum;
            off += fabs(g) * size;
            load += fabs(g);
        }
    for (int64_t r = 0; r < s->m; r++) {
        if (!(fabs(s->b[r]) < LARGEST))
            return 0.0;
        most = s->b[r] > most ? s->b[r] : most;
    }
    off *= OFF;
    double push_out = most / length, low = energy > off ? sqrt(energy - off) : 0.0;
    double high = energy + off > 0.0 ? sqrt(energy + off) : 0.0;
    if (!(off < LARGEST) || (off == 0.0 && load > 0.0)) /* squares have left float64's range */
        return 0.0;
    low = push_out > low ? push_out : low;
    high = push_out > high ? push_out : high;
    double softest = 0.0;
    for (int64_t i = 0; i < s->n; i++)
        softest = larger(s->unit[i], softest);
    if (off == 0.0 && high == 0.0)
        low = high = UNMOVED / softest;
    if (!(low > 0x1p-960 * softest && low > 0x1p-960)) /* next to SMALLEST of units.py */
        return 0.0;
    return power_of_two(low, high);
}

/* solve/units, `units_of`; 0 where a unit is open, and Python has to say. */
int natural_units(Natural *s)
{
    s->units[0] = length_unit(s);
    s->units[1] = s->units[0] > 0.0 ? size_unit(s, s->units[0]) : 0.0;
    return s->units[1] > 0.0;
}

/* solve/units, `natural_form`, with f = -g, in the units that are there. */
void natural_program(Natural *s)
{
    double length = s->units[0], size = s->units[1], unit = 1 / (size * length);
    for (int64_t k = 0; k < s->n; k++)
        s->f[k] = s->g[s->coordinate[k]] * (s->unit[s->coordinate[k]] / -size);
    for (int64_t k = 0; k < s->m * s->columns; k++)
        s->natural_A[s->place[k]] = s->A[k] * (s->unit[s->column[k]] / length);
    for (int64_t i = 0; i < s->m; i++)
        s->natural_b[i] = s->b[s->row[i]] * unit;
}
