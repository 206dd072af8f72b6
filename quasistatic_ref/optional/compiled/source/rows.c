/* The contacts of a step, its rows and its load: Eqs. (1)-(8). */

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
        d1[i] = (a[i] - along * n[i]) / length;
        d2[i] = across[i] / length + 0.0;
    }
}

/* contact/jacobian, `columns_at`: [nu; n'omega] of a body that all columns move, at the point r. */
static void columns_at(const double *col, int64_t n_x, const double *r, const double *n,
                       double *restrict out)
{
    const double *w = col + 3 * n_x;
    double r0 = r[0], r1 = r[1], r2 = r[2], n0 = n[0], n1 = n[1], n2 = n[2];
    for (int64_t x = 0; x < n_x; x++) {
        double w0 = w[x], w1 = w[n_x + x], w2 = w[2 * n_x + x];
        out[x] = col[x] + (w1 * r2 - w2 * r1);
        out[n_x + x] = col[n_x + x] + (w2 * r0 - w0 * r2);
        out[2 * n_x + x] = col[2 * n_x + x] + (w0 * r1 - w1 * r0);
        out[3 * n_x + x] = (n0 * w0 + n1 * w1) + n2 * w2;
    }
}

/* contact/jacobian, `jacobian`: J of one contact, and of each of its joints the column of its coordinate.
   Columns of joints that mimic others are added to theirs. */
static void jacobian(const Rows *s, int64_t c, double *restrict col, double *sides, double *J)
{
    int64_t n_x = s->joints[c], first = c * s->most_joints;
    const int64_t *coordinate = s->coordinate + first;
    double *of_alpha = sides, *of_beta = sides + 4 * n_x;
    for (int64_t x = 0; x < n_x; x++)
        for (int i = 0; i < 6; i++)
            col[i * n_x + x] = s->column[s->joint[first + x]][i];
    columns_at(col, n_x, s->alpha + 3 * c, s->n + 3 * c, of_alpha);
    columns_at(col, n_x, s->beta + 3 * c, s->n + 3 * c, of_beta);
    for (int i = 0; i < 4; i++) { /* Eqs. (2)-(3) */
        double *row = s->J + (4 * c + i) * s->most_joints;
        for (int64_t x = 0; x < n_x; x++)
            row[coordinate[x]] = 0.0;
        for (int64_t x = 0; x < n_x; x++) /* added to 0.0, so that zero is never -0.0 */
            row[coordinate[x]] += s->moves_beta[first + x] * of_beta[i * n_x + x]
                                - s->moves_alpha[first + x] * of_alpha[i * n_x + x];
        for (int64_t x = 0; x < n_x; x++)
            J[i * n_x + x] = row[coordinate[x]];
    }
}

/* step/friction, `frame_jacobian`, of one axis, times a coefficient of friction. */
static void motion_along(const double *axis, const double *J, int64_t n, double mu, double *restrict out)
{
    double x = axis[0], y = axis[1], z = axis[2];
    for (int64_t v = 0; v < n; v++)
        out[v] = mu * ((x * J[v] + y * J[n + v]) + z * J[2 * n + v]);
}

/* contact/jacobian, `contacts`, and step/standard_form, `inequalities`: d1, d2, J, A and b. */
void contact_rows(const Rows *s)
{
    int64_t row = 0;
    double *col = s->work, *sides = col + 6 * s->most_joints, *J = sides + 8 * s->most_joints;
    double *motion = J + 4 * s->most_joints, *restrict a = motion + 4 * s->most_joints;
    for (int64_t c = 0; c < s->n_c; c++) {
        int64_t n = s->joints[c];
        const int64_t *coordinate = s->coordinate + c * s->most_joints;
        double *d1 = s->d1 + 3 * c, *d2 = s->d2 + 3 * c;
        tangents(s->n + 3 * c, d1, d2);
        jacobian(s, c, col, sides, J);
        motion_along(s->n + 3 * c, J, n, 1.0, motion);
        motion_along(d1, J, n, s->mu_v[c], motion + n);
        motion_along(d2, J, n, s->mu_v[c], motion + 2 * n);
        for (int64_t v = 0; v < n; v++)
            motion[3 * n + v] = s->mu_omega[c] * J[3 * n + v];
        for (int64_t i = 0; i < s->rows[c]; i++, row++) { /* Eqs. (4)-(8) */
            for (int64_t v = 0; v < n; v++)
                a[v] = motion[v];
            for (int k = 0; k < 3; k++) {
                const double *along = motion + (k + 1) * n;
                double coefficient = s->coefficient[3 * i + k];
                for (int64_t v = 0, last = s->has[3 * i + k] ? n : 0; v < last; v++)
                    a[v] = a[v] + coefficient * along[v];
            }
            for (int64_t v = 0; v < n; v++)
                s->A[row * s->most_joints + coordinate[v]] = a[v];
            s->b[row] = -s->phi[c];
        }
    }
}

/* simulate/simulator, `generalised_force`, and step/standard_form, `linear_term`: tau and g. */
void load(const Rows *s)
{
    for (int64_t v = 0; v < s->n_v; v++) {
        s->tau[v] = s->weighs[v] * (0.0 - *s->gravity[v]) + s->force[v];
        double pull = s->tau[v];
        if (v < s->n_a) { /* Eq. (1) */
            const double *K = s->K_q + v * s->n_a, *to = s->delta_q_bar_a;
            double tau_k = K[0] * to[0];
            for (int64_t j = 1; j < s->n_a; j++)
                tau_k = tau_k + K[j] * to[j];
            pull = tau_k + pull;
        }
        s->g[v] = *s->h * pull;
    }
}
