/* optional/forces/face_guess.guessed_faces, with test_compiled_forces.py: Newton's method in float64 for
   the faces on which forces lie. */

#include <math.h>
#include <string.h>

#include "forces.h"

enum { STEPS = 40, SEARCH = 30, SOFTEST = 30 };

#define NEARLY 0x1p-44   /* by which a condition of a face may be missed in float64, over the lengths z */
#define SHORTEST 0x1p-20 /* of a part of the way that may hold the minimum */
#define FLAT 1e-6        /* a slope that counts as none, over that where the way begins */

static double worst(const Forces *f, int64_t c, int64_t face, const double *z)
{
    const int64_t *row = numbers(f, c, face);
    double least = INFINITY;
    for (int64_t i = 0; i < f->count[c]; i++, row += 4) {
        double sum = 0.0;
        for (int a = 0; a < 4; a++)
            sum += (double)row[a] * z[a];
        least = fmin(least, sum);
    }
    return least / denominator(f, c, face);
}

/* The face at z: the one before where its conditions are missed by no more than a share of z, or that
   whose worst condition is best. */
void seek(const Forces *f, int64_t c, const double *z, double share)
{
    double most = 0.0, best = worst(f, c, f->face[c], z);
    for (int a = 0; a < 4; a++)
        most = fmax(most, fabs(z[a]));
    if (best >= -share * most)
        return;
    for (int64_t face = 0; face < (int64_t)1 << f->count[c]; face++)
        if (denominator(f, c, face) != 0.0 && worst(f, c, face, z) > best) {
            best = worst(f, c, face, z);
            f->face[c] = face;
        }
}

/* The way to where nothing is left to bear, by K = L D L'; 0 if a pivot is not positive. */
static int aimed(Force *g)
{
    int64_t n = g->s->n_v;
    double *U = g->m.R, *x = g->way;
    memcpy(U, g->m.K, (size_t)(n * n) * sizeof(double));
    memcpy(x, g->m.rest, (size_t)n * sizeof(double));
    for (int64_t c = 0; c < n; c++) {
        if (!(U[c * n + c] > 0.0))
            return 0;
        for (int64_t i = c + 1; i < n; i++) {
            double f = U[c * n + i] / U[c * n + c];
            for (int64_t j = i; j < n && f != 0.0; j++)
                U[i * n + j] -= f * U[c * n + j];
            x[i] -= f * x[c];
        }
    }
    for (int64_t i = n - 1; i >= 0; i--) {
        for (int64_t j = i + 1; j < n; j++)
            x[i] -= U[i * n + j] * x[j];
        x[i] /= U[i * n + i];
    }
    return 1;
}

/* z of all contacts at x, or without the gaps what x changes of it. */
static void lengths(const Force *g, const double *x, int with_gaps, double *z)
{
    int64_t n = g->s->n_v;
    for (int64_t i = 0; i < 4 * g->s->n_c; i++) {
        z[i] = with_gaps && i % 4 == 0 ? g->s->phi[i / 4] : 0.0;
        for (int64_t v = 0; v < n; v++)
            z[i] += g->B[i * n + v] * x[v];
    }
}

/* How steeply the energy falls a share of the way from x, with the faces there; how much less for each
   share more is added to `bend`. */
static double fall(const Force *g, double share, double *bend)
{
    const Forces *f = g->f;
    double sum = 0.0;
    for (int64_t c = 0; c < g->s->n_c; c++) {
        const double *along = g->along + 4 * c;
        double z[4];
        for (int a = 0; a < 4; a++)
            z[a] = g->z[4 * c + a] + share * along[a];
        seek(f, c, z, NEARLY);
        for (int i = 0; i < 16 && f->face[c]; i++) {
            double push = g->k * (double)of_s(f, c)[i] / denominator(f, c, f->face[c]) * along[i / 4];
            sum += push * z[i % 4];
            *bend -= push * along[i % 4];
        }
    }
    return sum;
}

/* Move x along the way, no farther than to the least energy: where the fall is zero, which Newton's
   method finds between bounds. At x the fall is `first`; it is infinite at the first step, which goes
   all the way, since x = 0 is not yet on the faces of the guess. */
static void moved(Force *g, double first)
{
    const Proof *s = g->s;
    int64_t n = s->n_v;
    double low = 0.0, high = 1.0, share = 1.0, slope = 0.0, straight = 0.0;
    lengths(g, g->x, 1, g->z);
    lengths(g, g->way, 0, g->along);
    for (int64_t i = 0; i < n * n; i++) {
        double push = g->way[i / n] * s->hessian_values[i];
        straight += push * g->way[i % n];
        slope -= push * g->x[i % n];
    }
    for (int64_t v = 0; v < n; v++)
        slope += g->way[v] * value(g->m.g + v);
    for (int i = 0; i < SEARCH; i++) {
        double bend = straight, falls = fall(g, share, &bend) + slope - share * straight;
        if (fabs(falls) <= FLAT * first || (falls > 0.0 && share == 1.0))
            break;
        *(falls < 0.0 ? &high : &low) = share;
        share += falls / bend;
        if (!(share > low && share < high))
            share = sqrt(fmax(low, SHORTEST * high) * high);
    }
    for (int64_t v = 0; v < n; v++)
        g->x[v] += share * g->way[v];
}

/* optional/forces/face_guess: whether Newton's method ends, with x and the faces there. */
static int settled(Force *g)
{
    size_t n = (size_t)g->s->n_v, n_c = (size_t)g->s->n_c;
    memset(g->x, 0, n * sizeof(double));
    for (int step = 0; step < STEPS; step++) {
        double first = 0.0;
        assembled(g);
        if (!aimed(g))
            return 0;
        memcpy(g->before, g->f->face, n_c * sizeof(int64_t));
        for (size_t v = 0; v < n; v++)
            first += g->way[v] * g->m.rest[v];
        moved(g, step ? first : INFINITY);
        if (!memcmp(g->before, g->f->face, n_c * sizeof(int64_t)))
            return 1;
    }
    return 0;
}

/* The same from the faces of the last step, of the forces without compliance, or of larger compliances. */
int guessed(Force *g, int start)
{
    double k = g->k;
    int found = 0;
    for (int64_t c = 0; start > 0 && c < g->s->n_c; c++) {
        double z[4];
        for (int a = 0; a < 4; a++) {
            double mu = g->s->mu[4 * c + a];
            z[a] = mu > 0.0 ? -g->f->near[4 * c + of_p[a]] / mu : 0.0;
        }
        g->f->face[c] = 0;
        seek(g->f, c, z, NEARLY);
    }
    for (int softer = start > 1 ? SOFTEST : 0; softer >= 0; softer -= 6) {
        g->k = ldexp(k, -softer);
        found = settled(g);
    }
    return found;
}
