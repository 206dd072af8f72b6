/* certify/minimiser.rational_solution, one correction of it, with test_fast_certificate.py.

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

/* A row a and its b: a delta_q >= b. */
void row_of(const Proof *s, int64_t r, Number *a, Number *b)
{
    int64_t n = s->n_v, c = s->contact[r], row = s->row[r];
    double ell = s->units[0], rho = s->units[1];
    Number along[4];
    Sum sum = EMPTY;
    direction(s, c, row, along);
    for (int64_t v = 0; v < n; v++) {
        for (int i = 0; i < 4; i++) {
            double J = s->J[n * (4 * c + i) + v];
            add_product(&sum, along + i, scaled(J, s->coordinate[v] / ell), 1);
        }
        carried(&sum, a + v);
    }
    *b = number(scaled(-s->phi[c] * s->cone[4 * row], 1 / (rho * ell)));
}

/* K of the system in float64; A_W and b_W exactly. */
void system_of(const Proof *s, Workspace *m)
{
    int64_t n = s->n_v, k = s->working, N = n + k;
    for (int64_t i = 0; i < n; i++)
        for (int64_t j = 0; j < n; j++)
            m->K[i * N + j] = s->hessian_values[i * n + j];
    for (int64_t w = 0; w < k; w++) {
        Number *a = m->A + w * n;
        row_of(s, s->guess[w], a, m->b + w);
        for (int64_t v = 0; v < n; v++) {
            m->K[(n + w) * N + v] = value(a + v);
            m->K[v * N + n + w] = -value(a + v);
        }
    }
}

/* A sum less one row of K times some factors, without the columns of y, or with these alone. */
static void less_x(const Proof *s, const Workspace *m, int64_t i, const Float *z, Sum *sum)
{
    int64_t n = s->n_v;
    const Number *H = s->hessian, *row = i < n ? H + i * n : m->A + (i - n) * n;
    const double *values = m->K + i * (n + s->working);
    for (int64_t v = 0; v < n; v++)
        if (values[v] != 0.0)
            add_product(sum, row + v, z[v], -1);
}

static void less_y(const Proof *s, const Workspace *m, int64_t i, const Float *z, Sum *sum)
{
    int64_t n = s->n_v, k = s->working;
    const double *values = m->K + i * (n + k) + n;
    for (int64_t w = 0; i < n && w < k; w++)
        if (values[w] != 0.0)
            add_product(sum, m->A + w * n + i, z[n + w], 1);
}

/* One correction: z += R r, and what is left of the residuals r, exactly. */
void corrected(const Proof *s, Workspace *m)
{
    int64_t n = s->n_v, N = n + s->working;
    Sum sum = EMPTY;
    for (int64_t i = 0; i < N; i++) {
        double change = 0.0;
        for (int64_t j = 0; j < N; j++)
            change += m->R[i * N + j] * m->rest[j];
        m->change[i] = digits_of(change, GRID, 1);
        Number moved = number(m->change[i]);
        total(m->z + i, &moved, m->z + i);
    }
    for (int64_t i = 0; i < N; i++) {
        Number pressed;
        less_y(s, m, i, m->change, &sum);
        carried(&sum, &pressed);
        if (i < n)
            total(m->net + i, &pressed, m->net + i);
        add(&sum, m->r + i);
        add(&sum, &pressed);
        less_x(s, m, i, m->change, &sum);
        carried(&sum, m->r + i);
    }
}
