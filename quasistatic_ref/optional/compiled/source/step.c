/* simulate/form_step, `StepPlan.formed`: what a step forms of its poses, in one block; and what a backend reads and
   says of it, in natural units. */

#include <stdlib.h>
#include <string.h>

#include "vectors.h"

int64_t frames(const int64_t *, const int64_t *, const double *, const double *, const double *, const double *,
               const double *, const double *, double *, double *, double *);
int64_t pyramid_rows(const int64_t *, const double *, const double *, const double *, const double *, const double *,
                     const double *, const unsigned char *, double *, double *);
int64_t step_sizes(const int64_t *, const double *, const double *, const double *, const double *, const double *,
                   const int64_t *, double *, double *);

/* solve/units, `_power_of_two`, of a positive number. */
static double power_of_two(double x) { return exp2(rint(log2(x))); }

/* `sizes`: contacts, own columns of one, all columns of joints, whether they move beta's body and alpha's, rows,
   coordinates, columns of L^-1, actuated coordinates. `has` says which of the six rows a contact has; `loads` are
   tau and the wanted change. Without `own_unit` there are no units. 0 where NumPy has to say. */
int64_t form_step(const int64_t *sizes, const int64_t *joint, const double *moves_beta, const double *moves_alpha,
                  const double *mu, const unsigned char *has, const double *K_q, double h, const double *columns,
                  const double *loads, const double *phi_, const double *alpha, const double *beta, const double *n_,
                  const double *own_unit, const double *inverse, const int64_t *coordinate, const double *unit,
                  double *block)
{
    int64_t n_c = sizes[0], w = sizes[1], m = sizes[5], n_v = sizes[6], n_a = sizes[8];
    const double *wanted = loads + n_v;
    double *phi = block, *n = phi + n_c, *d1 = n + 3 * n_c, *d2 = d1 + 3 * n_c, *J = d2 + 3 * n_c;
    double *A = J + 4 * n_c * w, *b = A + m * w, *g = b + m, *units = g + n_v;
    int64_t of_sizes[] = {m, w, n_v, sizes[7]};
    double found[4], deepest = -INFINITY, softest = 1.0, finite = 0.0;
    for (int64_t c = 0; c < n_c; c++) {
        phi[c] = phi_[c] + 0.0;
        deepest = larger(deepest, -phi[c]);
        finite += fabs(phi[c]);
    }
    for (int64_t i = 0; i < 3 * n_c; i++)
        finite += fabs(n[i] = n_[i] + 0.0);
    frames(sizes, joint, moves_beta, moves_alpha, columns, alpha, beta, n, d1, d2, J);
    for (int64_t i = 0; i < 4 * n_c * w; i++)
        finite += fabs(J[i]);
    pyramid_rows(sizes, n, d1, d2, J, mu, phi, has, A, b);
    for (int64_t i = 0; i < n_v; i++) { /* g of Eq. (13) */
        double sum = i < n_a ? K_q[i * n_a] * wanted[0] : 0.0; /* Eq. (1) */
        for (int64_t k = 1; i < n_a && k < n_a; k++)
            sum += K_q[i * n_a + k] * wanted[k];
        g[i] = h * (i < n_a ? sum + loads[i] : loads[i]);
        softest = own_unit ? larger(softest, unit[i]) : softest;
        finite += fabs(g[i]);
    }
    units[2] = deepest;
    if (!own_unit)
        return finite < INFINITY;
    double *squares = malloc(8 * (size_t)m);
    int64_t answered = squares && step_sizes(of_sizes, A, own_unit, b, g, inverse, coordinate, squares, found);
    free(squares);
    if (!answered)
        return 0;
    double ell = power_of_two(found[0]), push_out = found[2] / ell, size = larger(found[3], push_out);
    double rho = power_of_two(size); /* solve/units, `natural_units` */
    units[0] = ell;
    units[1] = rho;
    return finite + found[1] + found[3] + push_out < INFINITY && size > 0x1p-960 * softest && ell > 0 &&
           ell < INFINITY && rho < INFINITY;
}

/* solve/by_group, `GroupIndex.write`. `sizes`: rows of contacts, own columns, coordinates, numbers of all A. 0 where one
   is not finite. */
int64_t natural_programs(const int64_t *sizes, const int64_t *place, const int64_t *coordinates, const int64_t *rows,
                         const double *A, const double *b, const double *g, const double *own_unit,
                         const double *unit, double ell, double rho, double *g_out, double *A_out, double *b_out)
{
    int64_t m = sizes[0], w = sizes[1], n_v = sizes[2];
    double all = 0.0;
    for (int64_t i = 0; i < m * w; i++)
        if (place[i] < sizes[3])
            all += fabs(A_out[place[i]] = A[i] * (own_unit[i] / ell));
    for (int64_t i = 0; i < m; i++)
        all += fabs(b_out[i] = b[rows[i]] / (rho * ell));
    for (int64_t i = 0; i < n_v; i++)
        all += fabs(g_out[i] = g[coordinates[i]] * unit[coordinates[i]] / rho);
    return all < INFINITY;
}
