/* The contacts of a step and its rows: Eqs. (1)-(8). */

#include "vectors.h"

const char *digest(void) { return DIGEST; }

/* contact/jacobian, `tangents`. */
static void tangents(const double *n, double *d1, double *d2)
{
    int axis = fabs(n[1]) < fabs(n[0]) ? 1 : 0;
    if (fabs(n[2]) < fabs(n[axis]))
        axis = 2;
    double a[3] = {axis == 0, axis == 1, axis == 2};
    double along = dot(n, a), length = sqrt(1 - along * along);
    double across[3] = {n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]};
    for (int i = 0; i < 3; i++) {
        d1[i] = (a[i] - along * n[i]) / length + 0.0;
        d2[i] = across[i] / length + 0.0;
    }
}

/* contact/jacobian, `columns_at`, of one column of a body that it moves so much: added to four numbers. */
static void add_column(const double *column, int64_t n_x, const double *r, const double *n, double sign,
                       double moves, double *out, int64_t stride)
{
    double w0 = column[3 * n_x], w1 = column[4 * n_x], w2 = column[5 * n_x];
    double turning[3] = {w1 * r[2] - w2 * r[1], w2 * r[0] - w0 * r[2], w0 * r[1] - w1 * r[0]};
    for (int i = 0; i < 3; i++) /* Eq. (2) */
        out[i * stride] += sign * (moves * (column[i * n_x] + turning[i]));
    out[3 * stride] += sign * (moves * ((n[0] * w0 + n[1] * w1) + n[2] * w2));
}

/* contact/jacobian, `frames`, where each column is of one coordinate. `sizes`: contacts, columns of one and of
   all, whether columns move beta's body and alpha's. `moves_beta` and `moves_alpha` are given if they do. */
int64_t frames(const int64_t *sizes, const int64_t *joint, const double *moves_beta, const double *moves_alpha,
               const double *columns, const double *alpha, const double *beta, const double *n, double *d1,
               double *d2, double *J)
{
    int64_t w = sizes[1], n_x = sizes[2];
    for (int64_t c = 0; c < sizes[0]; c++) {
        tangents(n + 3 * c, d1 + 3 * c, d2 + 3 * c);
        for (int64_t k = c * w; k < (c + 1) * w; k++) {
            double *out = J + 4 * c * w + (k - c * w);
            for (int i = 0; i < 4; i++)
                out[i * w] = 0.0;
            if (sizes[3])
                add_column(columns + joint[k], n_x, beta + 3 * c, n + 3 * c, 1.0, moves_beta[k], out, w);
            if (sizes[4])
                add_column(columns + joint[k], n_x, alpha + 3 * c, n + 3 * c, -1.0, moves_alpha[k], out, w);
            for (int i = 0; i < 4; i++)
                out[i * w] += 0.0; /* Eq. (3); zero is 0.0, never -0.0 */
        }
    }
    return 1;
}

/* step/standard_form, `contact_inequalities`, in the pyramid: Eqs. (4)-(8). `sizes`: contacts, own columns. `axes`
   are n, d1 and d2; `has` which of the six rows each contact has. */
int64_t pyramid_rows(const int64_t *sizes, const double *n, const double *d1, const double *d2, const double *J,
                     const double *mu, const double *phi, const unsigned char *has, double *A, double *b)
{
    int64_t w = sizes[1], row = 0;
    for (int64_t c = 0; c < sizes[0]; c++, J += 4 * w) {
        int64_t first = row;
        for (int i = 0; i < 6; i++)
            if (has[6 * c + i])
                b[row++] = -phi[c];
        for (int64_t k = 0; k < w; k++) {
            double nu[3] = {J[k], J[w + k], J[2 * w + k]};
            double slip_1 = mu[3 * c] * dot(d1 + 3 * c, nu), slip_2 = mu[3 * c] * dot(d2 + 3 * c, nu);
            double gap = dot(n + 3 * c, nu), spin = mu[3 * c + 2] * J[3 * w + k];
            double rows[6] = {gap + slip_1, gap + slip_2, gap - slip_1, gap - slip_2, gap + spin, gap - spin};
            for (int64_t i = 0, at = first; i < 6; i++)
                if (has[6 * c + i])
                    A[at++ * w + k] = rows[i];
        }
    }
    return 1;
}
