/* The system of a working set, without rounding, and one correction of its solution.

       ( h H  -A_W' ) (x)   (h g)
       ( A_W     0  ) (y) = (b_W),   y = h lam,   all in natural units. */

#include "proof.h"

/* h H of the natural units, to be kept; 0 if it does not fit. */
int hessian(Proof *s)
{
    int lost = 0;
    int64_t n = s->n_v, n_a = s->n_a, n_u = n - n_a;
    Number *H = s->hessian;
    Float h = exact(*s->h, &lost);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double S = s->coordinate[i] * s->coordinate[j];
            Float entry = {0, {0, 0}};
            if (i < n_a && j < n_a)
                entry = scaled(s->K_q[i * n_a + j], S, &lost);
            else if (i >= n_a && j >= n_a)
                entry = scaled(s->M_u[(i - n_a) * n_u + j - n_a], S, &lost);
            Number x = number_of(&entry);
            if (i < n_a) {
                x = product(&x, &h, &lost);
                x = product(&x, &h, &lost);
            }
            H[i * n + j] = x;
            s->hessian_values[i * n + j] = value(&x);
        }
    return !lost;
}

/* h g of the natural units. */
void load(const Proof *s, Number *g, int *lost)
{
    int64_t n_a = s->n_a;
    double rho = s->units[1];
    Float h = exact(*s->h, lost);
    for (int64_t i = 0; i < s->n_v; i++) {
        Sum sum;
        clear(&sum);
        Float tau = scaled(s->tau[i], s->coordinate[i] / rho, lost);
        add_float(&sum, &tau, 1);
        for (int64_t j = 0; i < n_a && j < n_a; j++) {
            double K = s->K_q[i * n_a + j], to = s->delta_q_bar_a[j];
            if (K == 0.0 || to == 0.0)
                continue;
            Float stiffness = scaled(K, s->coordinate[i] * s->coordinate[j], lost);
            Float change = scaled(to, 1 / (rho * s->coordinate[j]), lost);
            Number x = number_of(&stiffness);
            add_product(&sum, &x, &change, 1, lost);
        }
        Number x = carried(&sum, lost);
        x = product(&x, &h, lost);
        g[i] = product(&x, &h, lost);
    }
}

/* The direction (n~ + d~; spin) of a row, Eqs. (5)-(7): four Numbers. */
static void direction(const Proof *s, int64_t c, int64_t row, Number *out, int *lost)
{
    const double *cone = s->cone + 4 * row;
    Float gap = exact(cone[0], lost), mu_v = exact(s->mu[3 * c], lost);
    Float slip_1 = exact(cone[1], lost), slip_2 = exact(cone[2], lost);
    Float spin = exact(cone[3], lost), mu_omega = exact(s->mu[3 * c + 2], lost);
    Number along_1 = number_of(&slip_1), along_2 = number_of(&slip_2), turn = number_of(&spin);
    along_1 = product(&along_1, &mu_v, lost);
    along_2 = product(&along_2, &mu_v, lost);
    out[3] = product(&turn, &mu_omega, lost);
    for (int i = 0; i < 3; i++) {
        Sum sum;
        clear(&sum);
        Float n = exact(s->n[3 * c + i], lost);
        Float d1 = exact(s->d1[3 * c + i], lost), d2 = exact(s->d2[3 * c + i], lost);
        Number x = number_of(&gap);
        add_product(&sum, &x, &n, 1, lost);
        add_product(&sum, &along_1, &d1, 1, lost);
        add_product(&sum, &along_2, &d2, 1, lost);
        out[i] = carried(&sum, lost);
    }
}

/* K of the system in float64, and b_W; A_W exactly. */
void system_of(const Proof *s, Room *m, int *lost)
{
    int64_t n = s->n_v, k = s->working, N = n + k;
    double ell = s->units[0], rho = s->units[1];
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++)
            m->K[i * N + j] = s->hessian_values[i * n + j];
    for (int64_t w = 0; w < k; w++) {
        int64_t c = s->contact[s->guess[w]], row = s->row[s->guess[w]];
        Number along[4];
        direction(s, c, row, along, lost);
        for (int64_t v = 0; v < n; v++) {
            Sum sum;
            clear(&sum);
            for (int i = 0; i < 4; i++) {
                Float J = scaled(s->J[n * (4 * c + i) + v], s->coordinate[v] / ell, lost);
                add_product(&sum, along + i, &J, 1, lost);
            }
            Number x = carried(&sum, lost);
            m->A[w * n + v] = x;
            m->K[(n + w) * N + v] = value(&x);
            m->K[v * N + n + w] = -value(&x);
        }
        Float b = scaled(-s->phi[c] * s->cone[4 * row], 1 / (rho * ell), lost);
        m->r[n + w] = number_of(&b);
    }
}

/* One correction: z += R r, and what is left of the residuals r, exactly. */
void corrected(const Proof *s, Room *m, int *lost)
{
    int64_t n = s->n_v, k = s->working, N = n + k;
    const Number *H = s->hessian;
    for (int64_t i = 0; i < N; i++) {
        double change = 0.0;
        for (int64_t j = 0; j < N; j++)
            change += m->R[i * N + j] * m->rest[j];
        m->change[i] = digits_of(change, GRID, 1, lost);
        Sum sum;
        clear(&sum);
        add_number(&sum, m->z + i, 1);
        add_float(&sum, m->change + i, 1);
        m->z[i] = carried(&sum, lost);
    }
    for (int64_t i = 0; i < n; i++) {
        Sum pressed, sum;
        clear(&pressed);
        clear(&sum);
        for (int64_t w = 0; w < k; w++)
            add_product(&pressed, m->A + w * n + i, m->change + n + w, 1, lost);
        Number moved = carried(&pressed, lost);
        add_number(&sum, m->r + i, 1);
        add_number(&sum, &moved, 1);
        for (int64_t j = 0; j < n; j++)
            add_product(&sum, H + i * n + j, m->change + j, -1, lost);
        m->r[i] = carried(&sum, lost);
        clear(&pressed);
        add_number(&pressed, m->net + i, 1);
        add_number(&pressed, &moved, 1);
        m->net[i] = carried(&pressed, lost);
    }
    for (int64_t w = 0; w < k; w++) {
        Sum sum;
        clear(&sum);
        add_number(&sum, m->r + n + w, 1);
        for (int64_t v = 0; v < n; v++)
            add_product(&sum, m->A + w * n + v, m->change + v, -1, lost);
        m->r[n + w] = carried(&sum, lost);
    }
}
