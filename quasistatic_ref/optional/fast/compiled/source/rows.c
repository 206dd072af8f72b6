/* contact/jacobian.ContactGeometry.contacts, step/standard_form, Eqs. (2)-(8), with test_fast.py. */

#include "scene.h"
#include "solid.h"

/* contact/jacobian: tangents. */
static void tangents(const double *n, double *d1, double *d2)
{
    int axis = fabs(n[1]) < fabs(n[0]) ? 1 : 0;
    if (fabs(n[2]) < fabs(n[axis]))
        axis = 2;
    double a[3] = {axis == 0, axis == 1, axis == 2};
    double along = dot(n, a), length = sqrt(1 - along * along), across[3];
    cross(n, a, across);
    for (int i = 0; i < 3; i++) {
        d1[i] = (a[i] - along * n[i]) / length;
        d2[i] = across[i] / length + 0.0;
    }
}

/* contact/jacobian: [nu; n'omega] of a body that all columns move, at the point r. */
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

/* contact/jacobian: J of one contact. Columns that mimic others are added to theirs. */
static void jacobian(const Scene *s, const double *col, int64_t c, double *own, double *J)
{
    int64_t n_x = s->moving, n_v = s->kept;
    const int64_t *place = s->place + (s->same ? 0 : c * n_x);
    double *of_alpha = own, *of_beta = own + 4 * n_x;
    columns_at(col, n_x, s->alpha + 3 * c, s->n + 3 * c, of_alpha);
    columns_at(col, n_x, s->beta + 3 * c, s->n + 3 * c, of_beta);
    for (int64_t i = 0; i < 4 * n_v; i++)
        J[i] = 0.0;
    for (int i = 0; i < 4; i++) /* Eqs. (2)-(3) */
        for (int64_t x = 0; x < n_x; x++) {
            double f = s->moves_beta[c * n_x + x] * of_beta[i * n_x + x]
                     - s->moves_alpha[c * n_x + x] * of_alpha[i * n_x + x];
            J[i * n_v + place[x]] += f; /* to 0.0, so that zero is never -0.0 */
        }
}

/* The columns of the joints that move a contact, by rows. */
static void gathered(const Scene *s, int64_t c, double *col)
{
    for (int64_t x = 0; x < s->moving; x++)
        for (int i = 0; i < 6; i++)
            col[i * s->moving + x] = s->column[s->joint_column[c * s->moving + x]][i];
}

/* step/friction: frame_jacobian of one axis, times a coefficient of friction. */
static void motion_along(const double *axis, const double *J, int64_t n_v, double mu,
                         double *restrict out)
{
    double x = axis[0], y = axis[1], z = axis[2];
    for (int64_t v = 0; v < n_v; v++)
        out[v] = mu * ((x * J[v] + y * J[n_v + v]) + z * J[2 * n_v + v]);
}

/* simulate/simulator: posed; step/standard_form: load. */
static void load(Scene *s)
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

/* The tangents, J, A and b of all contacts from their closest points, and the load. The least gap. */
double step_data(Scene *s)
{
    int64_t n_v = s->kept, n_x = s->moving, row = 0;
    double least = INFINITY;
    double *col = s->work, *own = col + 6 * n_x, *motion = own + 8 * n_x;
    for (int64_t c = 0; c < s->n_c; c++) {
        if (c == 0 || !s->same)
            gathered(s, c, col);
        double *d1 = s->d1 + 3 * c, *d2 = s->d2 + 3 * c, *J = s->J + 4 * n_v * c;
        least = s->phi[c] < least ? s->phi[c] : least;
        tangents(s->n + 3 * c, d1, d2);
        jacobian(s, col, c, own, J);
        motion_along(s->n + 3 * c, J, n_v, 1.0, motion);
        motion_along(d1, J, n_v, s->mu_v[c], motion + n_v);
        motion_along(d2, J, n_v, s->mu_v[c], motion + 2 * n_v);
        for (int64_t v = 0; v < n_v; v++)
            motion[3 * n_v + v] = s->mu_omega[c] * J[3 * n_v + v];
        for (int64_t i = 0; i < s->rows[c]; i++, row++) { /* Eqs. (4)-(8) */
            double *restrict A = s->A + n_v * row; /* which is nowhere in the work */
            for (int64_t v = 0; v < n_v; v++)
                A[v] = motion[v];
            for (int k = 0; k < 3; k++) {
                const double *along = motion + (k + 1) * n_v;
                double coefficient = s->coefficient[3 * i + k];
                for (int64_t v = 0, last = s->has[3 * i + k] ? n_v : 0; v < last; v++)
                    A[v] = A[v] + coefficient * along[v];
            }
            s->b[row] = -s->phi[c];
        }
    }
    load(s);
    return least;
}

/* The squared distances of all links' origins from that of the world, added up. */
double squared_distances(const Scene *s)
{
    double sum = 0.0;
    for (int64_t i = 0; i < s->links; i++)
        for (int k = 0; k < 3; k++)
            sum += s->t[i][k] * s->t[i][k];
    return sum;
}
