/* certify/active_set.dual_active_set in float64, with test_walk.py: other guesses, independent rows of one
   that has too many, where walks lead from a wrong one; which rows without slack some motion opens.

   A backend does not see rows that are violated by less than its tolerance, nor multipliers of the
   size of rounding, of which bodies at rest on each other have many. The proof of a guess does: it
   gives its multipliers and slacks, the smallest of them too. From there the method of
   certify/active_set goes on. It only adds to these numbers, and what it adds is about as small as
   what was violated: they stay right relative to their own size. A sign may be wrong all the same.
   Where the walks end is a guess again, to be proved like any other.

   All numbers are in SI units. The matrix A_W H^-1 A_W' of the working set is L L'. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "proof.h"

enum { WALKS = 1000 }; /* rows that are added from one proof to the next, at most */

#define DEPENDENT 1e-9   /* share of a row's squared length, in H^-1, that others do not span */
#define NO_FALL 1e-11    /* share of the fastest change of a multiplier, up to which one is none */
#define ROUNDING 0x1p-46 /* of a slack that changes, relative to the sizes of what it is the sum of */

typedef struct {
    const Proof *s;
    int64_t n, k, fixed;       /* coordinates; rows of the working set, and those that stay in it */
    int64_t *working;
    double *lam;
    double *slack, *noise;     /* of all rows; a slack may be wrong by about the noise */
    double *L;                 /* n by n */
    double *towards, *falls;   /* how a row reaches those of W; what these take over of it */
    double *push, *size, *along;
} Walk;

static double dot(const double *x, const double *y, int64_t n)
{
    double sum = 0.0;
    for (int64_t i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

static const double *row(const Walk *w, int64_t r) { return w->s->A + r * w->n; }

/* H^-1 times a vector. */
static void moved(const Walk *w, const double *push, double *out)
{
    for (int64_t v = 0; v < w->n; v++)
        out[v] = dot(w->s->inverse + v * w->n, push, w->n);
}

/* How row p reaches those of W, and its own square. */
static double reached(Walk *w, int64_t p)
{
    moved(w, row(w, p), w->along);
    for (int64_t i = 0; i < w->k; i++)
        w->towards[i] = dot(row(w, w->working[i]), w->along, w->n);
    return dot(row(w, p), w->along, w->n);
}

/* What the rows of W take over of another; the square of its part that they do not span. L^-1 towards
   is left behind L. */
static double taken_over(Walk *w, double square)
{
    int64_t n = w->n, k = w->k;
    double *next = w->L + k * n;
    for (int64_t i = 0; i < k; i++)
        next[i] = (w->towards[i] - dot(w->L + i * n, next, i)) / w->L[i * n + i];
    square -= dot(next, next, k);
    memcpy(w->falls, next, (size_t)k * sizeof(double));
    for (int64_t i = k - 1; i >= 0; i--) {
        w->falls[i] /= w->L[i * n + i];
        for (int64_t j = 0; j < i; j++)
            w->falls[j] -= w->L[i * n + j] * w->falls[i];
    }
    return square;
}

/* Row p joins W; its L^-1 towards stands behind L. 0 where it depends on W in float64. */
static int joined(Walk *w, int64_t p, double lam, double square)
{
    if (w->k == w->n || !(square > 0.0))
        return 0;
    w->L[w->k * w->n + w->k] = sqrt(square);
    w->working[w->k] = p;
    w->lam[w->k++] = lam;
    return 1;
}

/* The j-th row leaves W. L without its row is made triangular again by rotations of columns. */
static void dropped(Walk *w, int64_t j)
{
    int64_t n = w->n, k = --w->k;
    for (int64_t i = j; i < k; i++) {
        w->working[i] = w->working[i + 1];
        w->lam[i] = w->lam[i + 1];
        w->towards[i] = w->towards[i + 1];
        memmove(w->L + i * n, w->L + (i + 1) * n, (size_t)(i + 2) * sizeof(double));
    }
    for (int64_t c = j; c < k; c++) {
        double a = w->L[c * n + c], b = w->L[c * n + c + 1], length = hypot(a, b);
        for (int64_t i = c; i < k; i++) {
            double *x = w->L + i * n + c, left = x[0], right = x[1];
            x[0] = (left * a + right * b) / length;
            x[1] = (right * a - left * b) / length;
        }
    }
}

/* The slacks once row p is pressed, and those of W less by `falls` times that. */
static void pressed_by(Walk *w, int64_t p, double lam)
{
    int64_t n = w->n;
    for (int64_t v = 0; v < n; v++) {
        w->push[v] = row(w, p)[v];
        w->size[v] = fabs(w->push[v]);
    }
    for (int64_t i = 0; i < w->k; i++)
        for (int64_t v = 0; v < n; v++) {
            double share = w->falls[i] * row(w, w->working[i])[v];
            w->push[v] -= share;
            w->size[v] += fabs(share);
        }
    moved(w, w->push, w->along);
    for (int64_t v = 0; v < n; v++) {
        w->push[v] = 0.0;
        for (int64_t j = 0; j < n; j++)
            w->push[v] += fabs(w->s->inverse[v * n + j]) * w->size[j];
    }
    for (int64_t r = 0; r < w->s->rows; r++) {
        w->slack[r] += lam * dot(row(w, r), w->along, n);
        for (int64_t v = 0; v < n; v++)
            w->noise[r] += ROUNDING * fabs(lam * row(w, r)[v]) * w->push[v];
    }
    for (int64_t i = 0; i < w->k; i++)
        w->slack[w->working[i]] = 0.0;
}

/* Leave out the row of the most negative multiplier until all are positive. */
static void without_what_pulls(Walk *w)
{
    while (w->k) {
        int64_t least = 0;
        for (int64_t i = 1; i < w->k; i++)
            least = w->lam[i] < w->lam[least] ? i : least;
        double pull = w->lam[least];
        int64_t p = w->working[least];
        if (pull > 0.0)
            return;
        double square = reached(w, p);
        dropped(w, least);
        taken_over(w, square);
        for (int64_t i = 0; i < w->k; i++)
            w->lam[i] += pull * w->falls[i];
        pressed_by(w, p, -pull);
    }
}

/* The row that is violated most; -1 if none is. */
static int64_t violated(const Walk *w)
{
    int64_t most = -1;
    for (int64_t r = 0; r < w->s->rows; r++)
        if (w->slack[r] < -w->noise[r] && (most < 0 || w->slack[r] < w->slack[most]))
            most = r;
    return most;
}

/* The change of a multiplier up to which it is none. */
static double rounded_off(const Walk *w)
{
    double fastest = 0.0;
    for (int64_t i = 0; i < w->k; i++)
        fastest = fmax(fastest, fabs(w->falls[i]));
    return NO_FALL * fastest;
}

/* Which multiplier is the first to vanish as some row presses, and when; -1 if none falls. */
static int64_t first_to_vanish(const Walk *w, double *when)
{
    int64_t first = -1;
    double least = rounded_off(w);
    for (int64_t i = w->fixed; i < w->k; i++)
        if (w->falls[i] > least && w->lam[i] / w->falls[i] < *when) {
            *when = w->lam[i] / w->falls[i];
            first = i;
        }
    return first;
}

/* Walk until row p is satisfied; whether that is possible. */
static int added(Walk *w, int64_t p)
{
    double lam = 0.0, square = reached(w, p);
    for (;;) {
        double rate = taken_over(w, square), taken = INFINITY;
        int moves = rate > DEPENDENT * square;
        if (moves)
            taken = fmax(-w->slack[p], 0.0) / rate;
        int64_t first = first_to_vanish(w, &taken);
        if (!(taken < INFINITY)) /* NaN too */
            return 0;
        for (int64_t i = 0; i < w->k; i++)
            w->lam[i] = fmax(w->lam[i] - taken * w->falls[i], 0.0);
        lam += taken;
        if (moves)
            pressed_by(w, p, taken);
        if (first < 0) {
            w->slack[p] = 0.0;
            return joined(w, p, lam, rate);
        }
        dropped(w, first);
    }
}

/* The square of the part of row p that W does not span, from that part itself: where rows of W nearly
   depend on each other, the difference of squares has lost more digits than DEPENDENT allows. */
static double left_over(Walk *w, int64_t p, double square)
{
    taken_over(w, square);
    memcpy(w->push, row(w, p), (size_t)w->n * sizeof(double));
    for (int64_t i = 0; i < w->k; i++)
        for (int64_t v = 0; v < w->n; v++)
            w->push[v] -= w->falls[i] * row(w, w->working[i])[v];
    moved(w, w->push, w->along);
    return dot(w->push, w->along, w->n);
}

/* Row p with a multiplier; where it depends on W, as much of it as leaves no multiplier negative. */
static void borne(Walk *w, int64_t p, double lam)
{
    double square = reached(w, p), rate = left_over(w, p, square), taken = lam;
    if (rate <= DEPENDENT * square) {
        for (int64_t i = 0; i < w->k; i++)
            w->falls[i] = -w->falls[i]; /* as p presses less */
        int64_t first = first_to_vanish(w, &taken);
        for (int64_t i = 0; i < w->k; i++)
            w->lam[i] = fmax(w->lam[i] - taken * w->falls[i], 0.0);
        if (first < 0)
            return;
        dropped(w, first);
        lam -= taken;
        rate = left_over(w, p, square);
    }
    if (rate > DEPENDENT * square)
        joined(w, p, lam, rate);
}

static int ascending(const void *one, const void *other)
{
    int64_t a = *(const int64_t *)one, b = *(const int64_t *)other;
    return (a > b) - (a < b);
}

/* The guess of independent rows that bear what all of its rows do (Caratheodory). */
static int chosen(Walk *w)
{
    for (int64_t i = 0; i < w->s->working; i++)
        borne(w, w->s->guess[i], w->s->pressure[w->s->guess[i]]);
    return 1;
}

/* The guess with its multipliers; 0 if its rows depend on each other in float64. */
static int begun(Walk *w)
{
    const Proof *s = w->s;
    for (int64_t i = 0; i < s->working; i++) {
        double square = reached(w, s->guess[i]);
        if (!joined(w, s->guess[i], s->lam[s->guess[i]], taken_over(w, square)))
            return 0;
    }
    return 1;
}

/* Walks until no row is violated: -1; or a row that stays so; w->k of more walks than WALKS. */
static int64_t ended(Walk *w)
{
    for (int64_t p, count = 0; (p = violated(w)) >= 0; count++)
        if (count == WALKS || !added(w, p))
            return p;
    return -1;
}

/* The guess at which walks from a refuted one end; 0 if they do not. */
static int walked(Walk *w)
{
    memcpy(w->slack, w->s->slack, (size_t)w->s->rows * sizeof(double));
    if (!begun(w))
        return 0;
    without_what_pulls(w);
    return ended(w) < 0;
}

/* The workspace of walks, to be freed; NULL if there is no memory. */
static void *workspace_of_walks(Walk *w)
{
    size_t n = (size_t)w->n, rows = (size_t)w->s->rows;
    double *at = calloc((n + 1) * n + 7 * n + 2 * rows, sizeof(double));
    w->L = at;
    w->lam = w->L + (n + 1) * n;
    w->towards = w->lam + n;
    w->falls = w->towards + n;
    w->push = w->falls + n;
    w->size = w->push + n;
    w->along = w->size + n;
    w->slack = w->along + n;
    w->noise = w->slack + rows;
    w->working = (int64_t *)(w->noise + rows);
    return at;
}

/* Another guess, which such a function makes; 0 if it makes none. */
static int replaced(Proof *s, int (*made)(Walk *))
{
    Walk w = {.s = s, .n = s->n_v};
    void *workspace = workspace_of_walks(&w);
    int done = workspace && made(&w);
    if (done) {
        memcpy(s->guess, w.working, (size_t)w.k * sizeof(int64_t));
        qsort(s->guess, (size_t)w.k, sizeof(int64_t), ascending);
        s->working = w.k;
    }
    free(workspace);
    return done;
}

int independent(Proof *s) { return replaced(s, chosen); }

int mended(Proof *s) { return replaced(s, walked); }

/* Whether some v with A_W v = 0 opens all of some rows: -1, v being the least such motion, and the
   weights those of the rows in H v. Or one of the rows: with those that have a weight, its own being
   1, it comes to a combination of W's rows. All by walks in float64. */
int64_t closed(const Proof *s, const int64_t *rows, int64_t count, double *weight)
{
    Walk w = {.s = s, .n = s->n_v};
    void *workspace = workspace_of_walks(&w);
    int64_t last = -1;
    int regular = workspace && begun(&w);
    w.fixed = w.k;
    for (int64_t r = 0; regular && r < s->rows; r++)
        w.slack[r] = INFINITY;
    for (int64_t i = 0; regular && i < count; i++)
        w.slack[rows[i]] = -sqrt(reached(&w, rows[i]));
    if (regular)
        last = ended(&w);
    for (int64_t i = 0; i < count; i++) {
        weight[i] = rows[i] == last;
        for (int64_t j = w.fixed; regular && j < w.k; j++)
            if (w.working[j] == rows[i] && (last < 0 || -w.falls[j] > rounded_off(&w)))
                weight[i] = last < 0 ? w.lam[j] : -w.falls[j];
    }
    free(workspace);
    return last;
}
