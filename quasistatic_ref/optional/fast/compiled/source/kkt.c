/* The system of a working set, without rounding, and one correction of its solution.

       ( h H  -A_W' ) (x)   (h g)
       ( A_W     0  ) (y) = (b_W),   y = h lam,   all in natural units. */

#include "proof.h"

/* h H of the natural units, to be kept; 0 if it does not fit. */
int hessian(Proof *s)
{
    int64_t n = s->n_v, n_a = s->n_a, n_u = n - n_a;
    Number *H = s->hessian;
    lost = 0;
    Float h = exact(*s->h);
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++) {
            double S = s->coordinate[i] * s->coordinate[j], entry = 0.0;
            if (i < n_a && j < n_a)
                entry = s->K_q[i * n_a + j];
            else if (i >= n_a && j >= n_a)
                entry = s->M_u[(i - n_a) * n_u + j - n_a];
            Number *x = H + i * n + j;
            *x = number(scaled(entry, S));
            if (i < n_a) {
                product(x, h, x);
                product(x, h, x);
            }
            s->hessian_values[i * n + j] = value(x);
        }
    return !lost;
}

/* h g of the natural units. */
void load(const Proof *s, Number *g)
{
    int64_t n_a = s->n_a;
    double rho = s->units[1];
    Float h = exact(*s->h);
    Sum sum = EMPTY;
    for (int64_t i = 0; i < s->n_v; i++) {
        Number tau = number(scaled(s->tau[i], s->coordinate[i] / rho));
        add(&sum, &tau);
        for (int64_t j = 0; i < n_a && j < n_a; j++) {
            double K = s->K_q[i * n_a + j], to = s->delta_q_bar_a[j];
            if (K == 0.0 || to == 0.0)
                continue;
            Number stiffness = number(scaled(K, s->coordinate[i] * s->coordinate[j]));
            add_product(&sum, &stiffness, scaled(to, 1 / (rho * s->coordinate[j])), 1);
        }
        carried(&sum, g + i);
        product(g + i, h, g + i);
        product(g + i, h, g + i);
    }
}

/* The direction (n~ + d~; spin) of a row, Eqs. (5)-(7): four Numbers. */
static void direction(const Proof *s, int64_t c, int64_t row, Number *out)
{
    Number share[4];
    for (int a = 0; a < 4; a++) {
        Number coefficient = number(exact(s->cone[4 * row + a]));
        product(&coefficient, exact(s->mu[4 * c + a]), share + a);
    }
    Sum sum = EMPTY;
    for (int i = 0; i < 4; i++) {
        for (int a = 0; a < 4; a++)
            add_product(&sum, share + a, exact(s->frame[16 * c + 4 * a + i]), 1);
        carried(&sum, out + i);
    }
}

/* K of the system in float64, and b_W; A_W exactly. */
void system_of(const Proof *s, Room *m)
{
    int64_t n = s->n_v, k = s->working, N = n + k;
    double ell = s->units[0], rho = s->units[1];
    Sum sum = EMPTY;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++)
            m->K[i * N + j] = s->hessian_values[i * n + j];
    for (int64_t w = 0; w < k; w++) {
        int64_t c = s->contact[s->guess[w]], row = s->row[s->guess[w]];
        Number along[4];
        direction(s, c, row, along);
        for (int64_t v = 0; v < n; v++) {
            for (int i = 0; i < 4; i++) {
                double J = s->J[n * (4 * c + i) + v];
                add_product(&sum, along + i, scaled(J, s->coordinate[v] / ell), 1);
            }
            Number *x = m->A + w * n + v;
            carried(&sum, x);
            m->K[(n + w) * N + v] = value(x);
            m->K[v * N + n + w] = -value(x);
        }
        m->r[n + w] = number(scaled(-s->phi[c] * s->cone[4 * row], 1 / (rho * ell)));
    }
}

/* One correction: z += R r, and what is left of the residuals r, exactly. */
void corrected(const Proof *s, Room *m)
{
    int64_t n = s->n_v, k = s->working, N = n + k;
    const Number *H = s->hessian;
    Sum pressed = EMPTY, sum = EMPTY;
    for (int64_t i = 0; i < N; i++) {
        double change = 0.0;
        for (int64_t j = 0; j < N; j++)
            change += m->R[i * N + j] * m->rest[j];
        m->change[i] = digits_of(change, GRID, 1);
        Number moved = number(m->change[i]);
        total(m->z + i, &moved, m->z + i);
    }
    for (int64_t i = 0; i < n; i++) {
        for (int64_t w = 0; w < k; w++)
            add_product(&pressed, m->A + w * n + i, m->change[n + w], 1);
        Number moved;
        carried(&pressed, &moved);
        add(&sum, m->r + i);
        add(&sum, &moved);
        for (int64_t j = 0; j < n; j++)
            add_product(&sum, H + i * n + j, m->change[j], -1);
        carried(&sum, m->r + i);
        total(m->net + i, &moved, m->net + i);
    }
    for (int64_t w = 0; w < k; w++) {
        add(&sum, m->r + n + w);
        for (int64_t v = 0; v < n; v++)
            add_product(&sum, m->A + w * n + v, m->change[v], -1);
        carried(&sum, m->r + n + w);
    }
}
