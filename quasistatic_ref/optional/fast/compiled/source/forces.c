/* optional/forces/forces.contact_forces, with test_compiled_forces.py: forces of contacts that give way.

   z = B x + (phi, 0, 0, 0) are four lengths of each contact. On the face on which its force lies,
   c p = s = -P z, and x solves

       h H x + k sum B'P z = h g,   k = h^2 / c.

   The faces are guessed (face_guess.c). In fixed point x is refined, and decides whether each face is
   right; `satisfied` decides what may be zero or half-way. Units are natural, of a length of 1. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "forces.h"

enum { GUESSES = 8, STARTS = 3, SWEEPS = 36 };
enum { FIRST = 80, LAST = 240, FINER = 60, PRODUCTS = 1 << 14 };

#define ROUNDED 0x1p-38 /* of a sum of fewer than PRODUCTS terms in float64: its error over their sizes */
#define OPEN 1e-5 /* of an exponent that is as near to one whole number as to the next */

/* optional/forces/of_group.counted. */
static double counted(double b, double largest)
{
    double small = HARDLY_MOVES * largest;
    return b >= small ? b : small * small / fmax(b, HARDLY_MOVES * small);
}

/* Turn two vectors of three numbers in their plane. */
static void turned(double *x, double *y, int stride, double cosine, double sine)
{
    for (int l = 0; l < 3; l++, x += stride, y += stride) {
        double turned = cosine * *x - sine * *y;
        *y = sine * *x + cosine * *y;
        *x = turned;
    }
}

/* Whether all eigenvalues of b surely count as they are, and so its diagonal: b less twice what counts as
   small is definite. */
static int counts_as_it_is(double b[3][3])
{
    double small = 2 * HARDLY_MOVES * (b[0][0] + b[1][1] + b[2][2]);
    double x = b[0][0] - small, y = b[1][1] - small, z = b[2][2] - small;
    double minor = x * y - b[0][1] * b[0][1], off = b[0][1] * b[1][2] - b[0][2] * y;
    double other = x * b[1][2] - b[0][1] * b[0][2];
    return x > 0.0 && minor > 0.0 && z * minor - b[1][2] * other + b[0][2] * off > 0.0;
}

/* What a side counts for along n, d1 and d2 of a contact, from b = J H^-1 J' there: its eigenvalues, by
   Jacobi's rotations. */
static void counted_along(double b[3][3], double *out)
{
    double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++)
        out[i] = b[i][i];
    if (counts_as_it_is(b))
        return;
    for (int k = 0; k < SWEEPS; k++) {
        int i = k % 3, j = (k + 1) % 3;
        if (fabs(b[i][j]) <= 0x1p-60 * (b[i][i] + b[j][j]))
            continue;
        double twice = (b[j][j] - b[i][i]) / (2 * b[i][j]); /* the cotangent of twice the angle */
        double tangent = copysign(1 / (fabs(twice) + sqrt(twice * twice + 1)), twice);
        double cosine = 1 / sqrt(tangent * tangent + 1), sine = tangent * cosine;
        turned(b[0] + i, b[0] + j, 3, cosine, sine);
        turned(b[i], b[j], 1, cosine, sine);
        turned(axes[0] + i, axes[0] + j, 3, cosine, sine);
    }
    double most = fmax(b[0][0], fmax(b[1][1], b[2][2]));
    for (int i = 0; i < 3; i++) {
        out[i] = 0.0;
        for (int j = 0; j < 3; j++)
            out[i] += axes[i][j] * axes[i][j] * counted(b[j][j], most);
    }
}

/* Three rows of J in SI units, along n, d1 and d2: zero along what the contact does not bear. */
static void borne(const Force *g, int64_t c, double *J)
{
    int64_t n = g->s->n_v;
    for (int i = 0; i < 3; i++) {
        double mu = g->s->mu[4 * c + i], by = g->f->bears[i] && mu > 0.0 ? 1 / mu : 0.0;
        for (int64_t v = 0; v < n; v++)
            J[i * n + v] = by * g->B[(4 * c + i) * n + v] * g->way[v];
    }
}

/* b = J H^-1 J' of the coordinates of a side; whether they move the contact. */
static int mobility(const Force *g, int64_t side, const double *J, double b[3][3])
{
    int64_t n = g->s->n_v;
    int moves = 0;
    for (int64_t x = g->f->start[side]; x < g->f->start[side + 1]; x++) {
        int64_t v = g->f->side[x];
        for (int i = 0; i < 3; i++) {
            double motion = 0.0;
            for (int64_t y = g->f->start[side]; y < g->f->start[side + 1]; y++)
                motion += g->s->inverse[v * n + g->f->side[y]] * J[i * n + g->f->side[y]];
            for (int j = 0; j < 3; j++)
                b[i][j] += J[j * n + v] * motion;
            moves |= J[i * n + v] != 0.0;
        }
    }
    return moves;
}

/* optional/forces/of_group: the compliance; 0 where its exponent is open. */
static double compliance(const Force *g)
{
    const Forces *f = g->f;
    const Proof *s = g->s;
    double least = INFINITY;
    for (int64_t c = 0; c < s->n_c; c++)
        borne(g, c, g->borne + 3 * c * s->n_v);
    for (int64_t side = 0; side < f->sides; side++) {
        int64_t count = 0;
        double largest = 0.0;
        for (int64_t c = 0; c < s->n_c; c++) {
            double b[3][3] = {{0.0}};
            if (!mobility(g, side, g->borne + 3 * c * s->n_v, b))
                continue;
            counted_along(b, g->along + count);
            for (int i = 0; i < 3; i++)
                largest = fmax(largest, g->along[count++]);
        }
        for (int64_t i = 0; i < count; i++)
            least = fmin(least, counted(g->along[i], largest));
    }
    double exponent = log2(COMPLIANCE * *s->h * least), whole = rint(exponent);
    return fabs(exponent - whole) < 0.5 - OPEN && fabs(whole) < 900 ? ldexp(1.0, (int)whole) : 0.0;
}

/* B of all contacts, in natural units of coordinates, and the sizes of what its entries are sums of; what
   SI units are of these, in `way`. */
static void in_floats(const Force *g)
{
    const Proof *s = g->s;
    int64_t n = s->n_v;
    for (int64_t v = 0; v < n; v++)
        g->way[v] = 1 / s->coordinate[v];
    for (int64_t i = 0; i < 4 * s->n_c; i++)
        for (int64_t v = 0; v < n; v++) {
            double sum = 0.0, size = 0.0;
            for (int a = 0; a < 4; a++) {
                double term = s->frame[4 * i + a] * s->J[(i / 4 * 4 + a) * n + v];
                sum += term;
                size += fabs(term);
            }
            g->B[i * n + v] = s->mu[i] * sum * s->coordinate[v];
            g->large[i * n + v] = s->mu[i] * size * s->coordinate[v];
        }
}

/* K and what it is the sum of, on the faces that are there; in `rest` what is left to bear at x. */
void assembled(Force *g)
{
    const Proof *s = g->s;
    Workspace *m = &g->m;
    int64_t n = s->n_v;
    for (int64_t v = 0; v < n; v++)
        m->rest[v] = value(m->g + v);
    for (int64_t i = 0; i < n * n; i++) {
        m->K[i] = s->hessian_values[i];
        g->size[i] = fabs(m->K[i]);
    }
    for (int64_t c = 0; c < s->n_c; c++) {
        const double *B = g->B + 4 * c * n;
        for (int i = 0; i < 16 && g->f->face[c]; i++) {
            double part = g->k * (double)of_s(g->f, c)[i] / denominator(g->f, c, g->f->face[c]);
            for (int64_t v = 0; v < n && part != 0.0; v++) {
                double push = part * B[i / 4 * n + v];
                if (i % 4 == 0)
                    m->rest[v] += push * s->phi[c];
                for (int64_t w = 0; w < n && push != 0.0; w++) {
                    double term = push * B[i % 4 * n + w];
                    m->K[v * n + w] -= term;
                    g->size[v * n + w] += fabs(term);
                }
            }
        }
    }
    for (int64_t i = 0; i < n * n; i++)
        m->rest[i / n] -= m->K[i] * g->x[i % n];
}

/* R times what is left to bear. */
static void solved(const Force *g, double *x)
{
    int64_t n = g->s->n_v;
    for (int64_t v = 0; v < n; v++) {
        x[v] = 0.0;
        for (int64_t w = 0; w < n; w++)
            x[v] += g->m.R[v * n + w] * g->m.rest[w];
    }
}

static void times(Sum *sum, Number *x, Float by)
{
    add_product(sum, x, by, 1);
    carried(sum, x);
}

/* r less D K x; with the constant terms that come from the gaps, or without. */
static void pressed(const Force *g, const Number *x, int with_gaps, Number *r)
{
    const Proof *s = g->s;
    int64_t n = s->n_v;
    double D = (double)g->f->multiple, stiffness = 1 / g->c;
    Float h = exact(*s->h);
    Sum one = EMPTY;
    for (int64_t c = 0; c < s->n_c; c++) {
        const double *J = s->J + 4 * n * c;
        double share = D / denominator(g->f, c, g->f->face[c]), e[4];
        Number z[4], push[4], w;
        if (!g->f->face[c])
            continue;
        motion(s, x, g->m.e, c, with_gaps, z, e);
        for (int a = 0; a < 4; a++) {
            for (int b = 0; b < 4; b++)
                if (of_s(g->f, c)[4 * a + b])
                    add_product(&one, z + b, exact((double)of_s(g->f, c)[4 * a + b] * share), 1);
            carried(&one, push + a);
            times(&one, push + a, exact(s->mu[4 * c + a]));
        }
        for (int i = 0; i < 4; i++) {
            for (int a = 0; a < 4; a++)
                if (s->frame[16 * c + 4 * a + i] != 0.0)
                    add_product(&one, push + a, exact(s->frame[16 * c + 4 * a + i]), 1);
            carried(&one, &w);
            for (int64_t v = 0; v < n; v++)
                if (J[i * n + v] != 0.0)
                    add_product(g->sum + v, &w, scaled(J[i * n + v], s->coordinate[v] * stiffness), 1);
        }
    }
    for (int64_t v = 0; v < n; v++) {
        const Number *H = (const Number *)s->hessian + v * n;
        Number inert, force;
        for (int64_t w = 0; w < n; w++)
            for (int j = x[w].low; j < x[w].high && s->hessian_values[v * n + w] != 0.0; j++)
                add_product(&one, H + w, (Float){j, x[w].d[j], 0}, -1);
        carried(&one, &inert);
        carried(g->sum + v, &force);
        times(&one, &force, h);
        add_product(&one, &force, h, 1);
        add_product(&one, &inert, exact(D), 1);
        add(&one, r + v);
        carried(&one, r + v);
    }
}

/* What acts at z less D K z. */
static void remaining(const Force *g, const Number *z, Number *r)
{
    load(g->s, r);
    for (int64_t v = 0; v < g->s->n_v; v++)
        times(g->sum, r + v, exact((double)g->f->multiple));
    pressed(g, z, 1, r);
}

/* Add x to z, without what is below 2^-bits by far. */
static void corrected_by(Force *g, int bits)
{
    Workspace *m = &g->m;
    for (int64_t v = 0; v < g->s->n_v; v++) {
        m->net[v] = number(digits_of(g->x[v], bits + FINER, 1));
        total(m->z + v, m->net + v, m->z + v);
    }
}

/* Refine z until no residual r is above 2^-bits; x is the next correction then. */
static void refine(Force *g, int bits)
{
    Workspace *m = &g->m;
    for (int round = 0; !lost; round++) {
        double most = 0.0;
        for (int64_t v = 0; v < g->s->n_v; v++) {
            m->rest[v] = value(m->r + v) / (double)g->f->multiple * UP;
            most = fmax(most, fabs(m->rest[v]));
        }
        solved(g, g->x);
        if (most < ldexp(1.0, -bits) || round == ROUNDS)
            break;
        corrected_by(g, bits);
        pressed(g, m->net, 0, m->r);
    }
}

/* The sum of lengths z, which are known within e; and a bound of its error. */
static double summed(const int64_t *row, double by, const Number *z, const double *e, Number *out)
{
    Sum sum = EMPTY;
    double error = 0.0;
    for (int a = 0; a < 4; a++) {
        add_product(&sum, z + a, exact((double)row[a]), 1);
        error += fabs((double)row[a]) * e[a];
    }
    carried(&sum, out);
    times(&sum, out, exact(by));
    return fabs(by) * error * UP;
}

static int may_be_zero(const Number *x, double error)
{
    return error > 0.0 && fabs(value(x)) * DOWN <= error;
}

/* Whether a contact that bears nothing surely is on the right face: float64 shows that all conditions of
   this face are positive. */
static int surely_free(const Force *g, int64_t c)
{
    const Proof *s = g->s;
    const int64_t *row = numbers(g->f, c, 0);
    int64_t n = s->n_v;
    double z[4], error[4];
    for (int a = 0; a < 4; a++) {
        z[a] = a == 0 ? s->phi[c] / g->units[1] : 0.0;
        error[a] = fabs(z[a]) * ROUNDED;
        for (int64_t v = 0; v < n; v++) {
            double x = value(g->m.z + v);
            z[a] += g->B[(4 * c + a) * n + v] * x;
            error[a] += g->large[(4 * c + a) * n + v] * (fabs(x) * ROUNDED + g->m.e[v]);
        }
    }
    for (int64_t i = 0; i < g->f->count[c]; i++, row += 4) {
        double sum = 0.0, most = 0.0;
        for (int a = 0; a < 4; a++) {
            sum += (double)row[a] * z[a];
            most += fabs((double)row[a]) * (error[a] + fabs(z[a]) * ROUNDED);
        }
        if (!(sum > 2 * most + FLOOR))
            return 0;
    }
    return 1;
}

/* The forces, if each face is right: DECIDED, REFUTED with other faces, or OPEN_NUMBER. What may be
   zero, and at the finest what may be half-way, is collected. */
static int judged(Force *g, int finest)
{
    const Proof *s = g->s;
    int refuted = 0, code = DECIDED;
    g->opened = 0;
    for (int64_t c = 0; c < s->n_c; c++) {
        const int64_t *row = numbers(g->f, c, g->f->face[c]);
        double h = denominator(g->f, c, g->f->face[c]), e[4], near[4];
        Number z[4], x;
        int wrong = 0;
        if (!g->f->face[c] && surely_free(g, c)) {
            for (int a = 0; a < 4; a++)
                g->f->wrench[4 * c + a] = 0.0;
            continue;
        }
        motion(s, g->m.z, g->m.e, c, 1, z, e);
        for (int64_t i = 0; i < g->f->count[c]; i++, row += 4) {
            double error = summed(row, 1.0, z, e, &x);
            if (may_be_zero(&x, error))
                g->open[g->opened++] = (Open){c, row, 1.0, ZERO};
            else
                wrong |= value(&x) < 0.0;
        }
        for (int a = 0; a < 4; a++, row += 4) {
            Open open = {c, row, s->mu[4 * c + a], ZERO};
            double error = summed(row, open.by, z, e, &x), unit = g->units[1] / g->c;
            double *out = g->f->wrench + 4 * c + of_p[a];
            near[a] = value(z + a);
            *out = 0.0;
            if (!may_be_zero(&x, error)) {
                if (nearest(&x, error, h, unit, out))
                    continue;
                if (!finest || !half_way(&x, error, h, unit, out, &open.middle))
                    code = OPEN_NUMBER;
            }
            g->open[g->opened++] = open;
        }
        if (wrong)
            seek(g->f, c, near, 0.0);
        refuted |= wrong;
    }
    return refuted ? REFUTED : code;
}

/* Let rest where x is zero: nothing acts on a coordinate, nor on any that K couples it to. `satisfied`
   solves for the others, and asks each row of K. */
static void rested(Workspace *m, const Number *K, const Number *f, int64_t n)
{
    int64_t count = 0, *moving = m->pivot;
    for (int64_t v = 0; v < n; v++) {
        m->rests[v] = (char)empty(f + v);
        if (!m->rests[v])
            moving[count++] = v;
    }
    while (count) {
        const Number *row = K + moving[--count] * n;
        for (int64_t v = 0; v < n; v++)
            if (m->rests[v] && !empty(row + v)) {
                m->rests[v] = 0;
                moving[count++] = v;
            }
    }
}

/* Whether what is open is what it may be, x being the solution without rounding. */
static int settled_exactly(Force *g)
{
    Workspace *m = &g->m;
    Proof s = *g->s;
    int64_t n = s.n_v, count = g->opened;
    Number *K = calloc((size_t)(n * n + n + count * (n + 1)), sizeof(Number)), one = number(exact(1.0));
    Number *f = K + n * n, *A = f + n, *b = A + count * n, *x = m->net, z[4];
    double e[4];
    if (!K)
        return NO_MEMORY;
    memset(x, 0, (size_t)n * sizeof(Number));
    memset(m->e, 0, (size_t)n * sizeof(double));
    remaining(g, x, f);
    for (int64_t i = 0; i < count; i++) {
        const Open *open = g->open + i;
        motion(&s, x, m->e, open->contact, 1, z, e);
        summed(open->row, -open->by, z, e, b + i);
        total(b + i, &open->middle, b + i);
    }
    for (int64_t v = 0; v < n; v++) {
        int64_t last = -1;
        x[v] = one;
        for (int64_t i = 0; i < count; i++) {
            const Open *open = g->open + i;
            if (open->contact != last)
                motion(&s, x, m->e, open->contact, 0, z, e);
            last = open->contact;
            summed(open->row, open->by, z, e, A + i * n + v);
        }
        product(&one, exact(-1.0), x + v);
        pressed(g, x, 0, K + v * n);
        x[v] = ZERO;
    }
    rested(m, K, f, n);
    s.hessian = K;
    int code = satisfied(&s, m, f, A, b, count);
    free(K);
    return code;
}

/* Whether the faces are right, with the forces. */
static int forced(Force *g)
{
    Workspace *m = &g->m;
    int64_t n = g->s->n_v;
    assembled(g);
    memcpy(m->R, m->K, (size_t)(n * n) * sizeof(double));
    if (!inverse(m->R, n, m->pivot))
        return SINGULAR;
    for (int64_t i = 0; i < n * n; i++)
        g->size[i] *= 1.0 + 0.25 * (double)g->s->n_c; /* K is a sum of so many */
    defect(m->R, m->K, g->size, n, m->G, m->e);
    lost = 0;
    memset(m->z, 0, (size_t)n * sizeof(Number));
    corrected_by(g, FIRST);
    remaining(g, m->z, m->r);
    int code = OPEN_NUMBER;
    for (int bits = FIRST; code == OPEN_NUMBER && bits <= LAST; bits += FIRST) {
        refine(g, bits);
        if (!lost && !error_bounds(m->R, m->G, m->rest, n, m->e))
            return OPEN_BOUND;
        code = judged(g, bits == LAST);
        if (code == DECIDED && g->opened && !lost)
            code = settled_exactly(g);
        if (lost)
            return LOST;
    }
    for (int64_t v = 0; v < n; v++)
        g->x[v] = value(m->z + v);
    return code;
}

/* The same from a guess, and from those that follow where it is wrong. */
static int from_guess(Force *g)
{
    int64_t n = g->s->n_v;
    double most = 0.0;
    int above = 0, code = REFUTED;
    for (int64_t v = 0; v < n; v++)
        most = fmax(most, fabs(g->x[v]));
    frexp(most, &above);
    g->units[1] = ldexp(1.0, above);
    for (int64_t v = 0; v < n; v++)
        g->x[v] /= g->units[1];
    for (int tries = 0; code == REFUTED && tries < GUESSES; tries++)
        code = forced(g);
    g->units[1] = 1.0;
    return code;
}

/* The forces of a group: DECIDED, or why they are not known. */
int forces(Forces *f)
{
    Proof s = *f->group;
    Force g = {.f = f, .s = &s, .units = {1.0, 1.0}};
    size_t n = (size_t)s.n_v, n_c = (size_t)s.n_c;
    s.working = 0;
    s.units = g.units;
    if (4 * n_c + n >= PRODUCTS)
        return LOST;
    void *workspace = workspace_of(&s, &g.m);
    g.sum = calloc(n, sizeof(Sum));
    g.open = calloc(n_c * (size_t)f->width + 1, sizeof(Open));
    g.before = calloc(11 * n_c * n + 9 * n_c + n * n + 2 * n, sizeof(double));
    int code = NO_MEMORY;
    if (workspace && g.sum && g.open && g.before) {
        g.B = (double *)(g.before + n_c);
        g.z = g.B + 4 * n_c * n;
        g.along = g.z + 4 * n_c;
        g.x = g.along + 4 * n_c;
        g.way = g.x + n;
        g.size = g.way + n;
        g.large = g.size + n * n;
        g.borne = g.large + 4 * n_c * n;
        for (size_t v = 0; v < n; v++)
            g.sum[v] = EMPTY;
        lost = 0;
        load(&s, g.m.g);
        in_floats(&g);
        *f->compliance = g.c = compliance(&g);
        g.k = *s.h * *s.h / g.c;
        code = OPEN_CLAIM;
        for (int start = 0; g.c > 0.0 && code != DECIDED && start < STARTS; start++)
            code = guessed(&g, start) ? from_guess(&g) : OPEN_CLAIM;
    }
    free(g.before);
    free(g.open);
    free(g.sum);
    free(workspace);
    return code;
}
