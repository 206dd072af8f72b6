/* certify/exact.group_optimum on a guess, with test_fast_certificate.py: docs/exactness.md.

   All numbers are in natural units, y = h lam: h H x - A_W'y = h g and A_W x = b_W. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "proof.h"

_Thread_local int lost;

int64_t number_size(void) { return sizeof(Number); }

/* gap, slip_1, slip_2 and spin of a contact at x, which is known within some bounds, the last three times
   their coefficients of friction, and bounds of their errors; the gap with phi or without. */
void motion(const Proof *s, const Number *x, const double *off, int64_t c, int with_gap, Number *out,
            double *e)
{
    int64_t n = s->n_v;
    double ell = s->units[0], rho = s->units[1], of_nu[4];
    const double *mu = s->mu + 4 * c;
    Number nu[4];
    Sum sum = EMPTY;
    for (int i = 0; i < 4; i++) {
        of_nu[i] = 0.0;
        for (int64_t v = 0; v < n; v++) {
            double unit = s->coordinate[v] / ell, entry = s->J[n * (4 * c + i) + v];
            if (entry == 0.0)
                continue;
            add_product(&sum, x + v, scaled(entry, unit), 1);
            of_nu[i] += fabs(entry * unit) * off[v];
        }
        carried(&sum, nu + i);
    }
    for (int a = 0; a < 4; a++) {
        const double *axis = s->frame + 16 * c + 4 * a;
        e[a] = 0.0;
        for (int i = 0; i < 4; i++) {
            add_product(&sum, nu + i, exact(axis[i]), 1);
            e[a] += fabs(axis[i]) * of_nu[i];
        }
        if (a == 0 && with_gap) {
            Number phi = number(scaled(s->phi[c], 1 / (rho * ell)));
            add(&sum, &phi);
        }
        carried(&sum, out + a);
        product(out + a, exact(mu[a]), out + a);
        e[a] *= mu[a];
    }
}

/* Whether a number that cannot be rounded may be half-way between two others, which `zeros` decides:
   the even one of these, times a unit. */
static int tied(Workspace *m, int of, int64_t at, const Number *x, double e, double h, double unit, double *out)
{
    Tie *tie = m->tie + m->ties;
    if (!m->finest || m->ties == TIES || !half_way(x, e, h, unit, out, &tie->middle))
        return 0;
    tie->of = of;
    tie->at = at;
    m->ties++;
    return 1;
}

/* Slacks of all rows; those that may be zero are collected. */
static void slacks(Proof *s, Workspace *m)
{
    double unit = s->units[0] * s->units[1];
    int64_t last = -1, next = 0;
    Number of[4];
    Sum sum = EMPTY;
    double e[4];
    for (int64_t r = 0; r < s->rows; r++) {
        int64_t c = s->contact[r];
        s->slack[r] = 0.0;
        if (next < s->working && s->guess[next] == r) {
            next++;
            continue;
        }
        if (c != last)
            motion(s, m->z, m->e, c, 1, of, e);
        last = c;
        double error = 0.0;
        for (int a = 0; a < 4; a++) {
            double coefficient = s->cone[4 * s->row[r] + a];
            add_product(&sum, of + a, exact(coefficient), 1);
            error += fabs(coefficient) * e[a];
        }
        Number x;
        carried(&sum, &x);
        error *= UP;
        if (fabs(value(&x)) * DOWN <= error) {
            s->idle[s->counts[0]++] = r;
            continue;
        }
        m->refuted |= value(&x) < 0.0;
        double *slack = s->slack + r;
        if (!nearest(&x, error, 1.0, unit, slack) && !tied(m, OF_SLACK, r, &x, error, 1.0, unit, slack)) {
            *slack = value(&x) * unit;
            m->open = 1;
        }
        if (*slack < s->least[0])
            s->least[0] = *slack;
    }
}

/* Whether all that H couples a coordinate to stays where it is. */
static int held(const Proof *s, const char *rest, int64_t v)
{
    for (int64_t j = 0; j < s->n_v; j++)
        if (!rest[j] && s->hessian_values[v * s->n_v + j] != 0.0)
            return 0;
    return 1;
}

/* Which coordinates stay where they are: no load, no row of the working set, and no entry of H
   that couples them to others. There H x = 0, and H is definite. */
static void at_rest(const Proof *s, const Workspace *m, char *rest)
{
    int64_t n = s->n_v, k = s->working;
    for (int64_t v = 0; v < n; v++) {
        rest[v] = m->g[v].low == m->g[v].high;
        for (int64_t w = 0; w < k; w++)
            rest[v] = rest[v] && m->A[w * n + v].low == m->A[w * n + v].high;
    }
    for (int found = 1; found;) {
        found = 0;
        for (int64_t v = 0; v < n; v++)
            if (rest[v] && !held(s, rest, v))
                rest[v] = 0, found = 1;
    }
}

/* The multipliers of the working set, rounded; zero where that is not surely wrong. */
static void pressed(Proof *s, Workspace *m)
{
    int64_t n = s->n_v;
    double unit = s->units[1] / s->units[0];
    for (int64_t r = 0; r < s->rows; r++)
        s->lam[r] = 0.0;
    for (int64_t w = 0; w < s->working; w++) {
        const Number *y = m->z + n + w;
        double *lam = s->lam + s->guess[w], error = m->e[n + w];
        m->refuted |= !(value(y) * DOWN > error);
        if (fabs(value(y)) * DOWN <= error)
            continue;
        if (!nearest(y, error, *s->h, unit, lam)) {
            *lam = value(y) / *s->h * unit;
            m->open = 1;
        }
        s->least[1] = *lam < s->least[1] ? *lam : s->least[1];
    }
}

/* What rounding took from x, known within e, as it was rounded to `out` times a unit; and its bound. */
static void left_by_rounding(const Number *x, double e, double unit, double out, double *rest, double *bound)
{
    Number kept = number(exact(out / unit)), left;
    Sum sum = EMPTY;
    add(&sum, x);
    add_product(&sum, &kept, exact(1.0), -1);
    carried(&sum, &left);
    *rest = value(&left) * unit;
    *bound = (e + fabs(value(&left)) * 0x1p-50) * unit * UP;
}

/* delta_q and A'lam, rounded. What is not surely other than zero is collected. */
static void rounded(Proof *s, Workspace *m)
{
    int64_t n = s->n_v, k = s->working;
    double rho = s->units[1], h = *s->h;
    m->balances = 0;
    at_rest(s, m, m->rests);
    for (int64_t v = 0; v < n; v++) {
        s->delta_q[v] = s->net[v] = s->rest[v] = s->bound[v] = 0.0;
        if (m->rests[v])
            continue;
        if (fabs(value(m->z + v)) * DOWN <= m->e[v]) {
            s->still[s->counts[1]++] = v;
            m->rests[v] = STILL;
            continue;
        }
        const Number *x = m->z + v;
        double e = m->e[v], unit = rho * s->coordinate[v], *out = s->delta_q + v;
        if (!nearest(x, e, 1.0, unit, out) && !tied(m, OF_MOTION, v, x, e, 1.0, unit, out))
            m->open = 1;
        left_by_rounding(x, e, unit, *out, s->rest + v, s->bound + v);
    }
    for (int64_t v = 0; v < n; v++) {
        Number net = m->net[v];
        double error = 0.0;
        if (m->rests[v] == AT_REST)
            continue;
        if (held(s, m->rests, v))
            product(m->g + v, exact(-1.0), &net); /* A'lam is -g there */
        else
            for (int64_t w = 0; w < k; w++)
                error += fabs(m->K[(n + w) * (n + k) + v]) * m->e[n + w];
        double e = error * UP, unit = rho / s->coordinate[v], *out = s->net + v;
        if (error > 0.0 && fabs(value(&net)) * DOWN <= e)
            m->balanced[m->balances++] = v;
        else if (!nearest(&net, e, h, unit, out) && !tied(m, OF_NET, v, &net, e, h, unit, out))
            m->open = 1;
    }
}

/* Correct z until no residual is above 2^-bits. */
void refined(const Proof *s, Workspace *m, int bits)
{
    int64_t N = s->n_v + s->working;
    for (int round = 0; round < ROUNDS; round++) {
        double most = 0.0;
        for (int64_t i = 0; i < N; i++) {
            m->rest[i] = value(m->r + i);
            most = fabs(m->rest[i]) > most ? fabs(m->rest[i]) : most;
        }
        if (most < ldexp(1.0, -bits))
            break;
        corrected(s, m);
    }
    for (int64_t i = 0; i < N; i++)
        m->rest[i] = value(m->r + i) * UP;
}

/* The system of the working set, and its inverse in float64: DECIDED if there is one. */
int regular(const Proof *s, Workspace *m)
{
    int64_t N = s->n_v + s->working;
    system_of(s, m);
    memcpy(m->R, m->K, (size_t)(N * N) * sizeof(double));
    if (lost)
        return LOST;
    if (!inverse(m->R, N, m->pivot))
        return SINGULAR;
    defect(m->R, m->K, m->K, N, m->G, m->e);
    return DECIDED;
}

static int proved(Proof *s, Workspace *m)
{
    int64_t n = s->n_v, N = n + s->working;
    lost = 0;
    s->counts[2] = 0;
    load(s, m->g);
    int code = regular(s, m);
    if (code != DECIDED)
        return code;
    for (int64_t i = 0; i < N; i++)
        m->r[i] = i < n ? m->g[i] : m->b[i - n];
    code = OPEN_NUMBER;
    for (int bits = REFINED; code == OPEN_NUMBER && bits <= FINEST; bits += FINEST - REFINED) {
        s->counts[0] = s->counts[1] = 0;
        s->least[0] = s->least[1] = INFINITY;
        refined(s, m, bits);
        if (lost)
            return LOST;
        if (!error_bounds(m->R, m->G, m->rest, N, m->e))
            return OPEN_BOUND;
        m->refuted = m->open = 0;
        m->finest = bits == FINEST;
        m->ties = 0;
        pressed(s, m);
        slacks(s, m);
        if (m->refuted)
            return lost ? LOST : REFUTED;
        rounded(s, m);
        code = m->open ? OPEN_NUMBER : zeros(s, m);
    }
    return lost ? LOST : code;
}

/* The workspace of one proof, to be freed; NULL if there is no memory. */
void *workspace_of(const Proof *s, Workspace *m)
{
    size_t n = (size_t)s->n_v, k = (size_t)s->working, N = n + k, width = 4 * (size_t)s->n_c;
    size_t rows = (size_t)s->rows, numbers = 2 * n + k * n + k + 2 * N, doubles = 3 * N * N + 2 * N;
    size_t integers = (k + 1) * width + N + rows + n;
    size_t bytes = numbers * sizeof(Number) + N * sizeof(Float) + doubles * sizeof(double)
                 + integers * sizeof(int64_t) + n;
    char *at = calloc(bytes, 1);
    if (!at)
        return NULL;
    m->g = (Number *)at;
    m->net = m->g + n;
    m->A = m->net + n;
    m->b = m->A + k * n;
    m->z = m->b + k;
    m->r = m->z + N;
    m->change = (Float *)(m->r + N);
    m->K = (double *)(m->change + N);
    m->R = m->K + N * N;
    m->G = m->R + N * N;
    m->rest = m->G + N * N;
    m->e = m->rest + N;
    m->table = (int64_t *)(m->e + N);
    m->pivot = m->table + (k + 1) * width;
    m->others = m->pivot + N;
    m->balanced = m->others + rows;
    m->rests = (char *)(m->balanced + n);
    return at;
}

/* Whether the guess is proved to be a working set of the optimum: DECIDED, or why it is not. */
int proof(Proof *s)
{
    Workspace m;
    void *workspace = workspace_of(s, &m);
    s->code = workspace ? proved(s, &m) : NO_MEMORY;
    free(workspace);
    return (int)s->code;
}
