/* certify/residuals.optimality_residuals of a proof, and all else of a step that follows on another, but
   its answer or its proof, with test_onward.py. */

#define _POSIX_C_SOURCE 199309L /* clock_gettime */

#include <string.h>
#include <time.h>

#include "proof.h"
#include "scene.h"

/* What becomes of a step: Python has to take it, or to say sines, or which groups there are. */
enum { TO_PYTHON, DONE, REGROUPED, SINES };

enum { DISTANCES, ROWS, SOLVE, PROOF, INTEGRATE, LAPS };

struct Pairs;
struct Screws;

int turns(struct Screws *s);
void changes(struct Screws *s);
int half_turns(struct Screws *s);
void sums(struct Screws *s);
double step_data(Scene *s);
double squared_distances(const Scene *s);
int closest_points(struct Pairs *s);
int natural_program(struct Natural *s);

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    /* Coordinates, rows, groups. */
    int64_t n, m, groups;
    /* Entries of A that the proofs keep without its zeros, if they do; how many arrays a record holds. */
    int64_t entries, pieces;
    struct Screws *change, *sum;
    struct Pairs *pairs;
    Scene *scene;
    /* Of a step that a backend answers, otherwise zero: its program, of which it has the units. */
    struct Natural *program;
    const double *coordinate, *units;
    /* How far contacts may be in penetration [m]. */
    const double *penetration;
    /* Of a step that is to be proved, otherwise zeros: the proofs of its groups; whether each coordinate
       moves each contact, as these have it; where each entry of A is in the scene; n, d1, d2 and spin of
       each contact as four rows of four; the multipliers by which the next step begins. */
    Proof *const *group;
    const int64_t *moves, *entry;
    double *entries_of_A, *frame, *pressure;
    double *residuals;
    /* A backend's answer; the solution in SI units. */
    const double *x, *y;
    double *delta_q, *lam;
    /* The square of how far points may surely be [m^2]. */
    const double *reach;
    /* When the last lap ended; the laps of this step [s]. */
    double *clock, *seconds;
    /* The arrays of a record and how long they are, and where they are copied to. */
    const double *const *piece;
    const int64_t *size;
    double *record;
} Onward;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void lap(Onward *s, int part)
{
    double end = now();
    s->seconds[part] = end - *s->clock;
    *s->clock = end;
}

/* step/contacts.moving: whether the same coordinates move the same contacts as in the proofs' groups. */
static int moves_alike(const Onward *s)
{
    const Scene *of = s->scene;
    int64_t n = of->kept;
    for (int64_t c = 0; c < of->n_c; c++)
        for (int64_t v = 0; v < n; v++) {
            const double *J = of->J + 4 * n * c + v;
            int moves = J[0] != 0.0 || J[n] != 0.0 || J[2 * n] != 0.0 || J[3 * n] != 0.0;
            if (moves != s->moves[n * c + v])
                return 0;
        }
    return 1;
}

/* The step from the poses that are there: its data, and its program in natural units. */
int step_posed(Onward *s)
{
    const Scene *of = s->scene;
    *s->clock = now();
    if (!turns(s->change))
        return TO_PYTHON;
    changes(s->change);
    if (!closest_points(s->pairs))
        return TO_PYTHON;
    lap(s, DISTANCES);
    if (!(step_data(s->scene) >= -*s->penetration) || (s->program && !natural_program(s->program)))
        return TO_PYTHON;
    if (s->moves && !moves_alike(s))
        return REGROUPED;
    for (int64_t i = 0; i < s->entries; i++)
        s->entries_of_A[i] = of->A[s->entry[i]];
    for (int64_t c = 0; s->frame && c < of->n_c; c++) {
        memcpy(s->frame + 16 * c, of->n + 3 * c, 3 * sizeof(double));
        memcpy(s->frame + 16 * c + 4, of->d1 + 3 * c, 3 * sizeof(double));
        memcpy(s->frame + 16 * c + 8, of->d2 + 3 * c, 3 * sizeof(double));
    }
    lap(s, ROWS);
    return DONE;
}

/* q (+) delta_q, once the sines are known, and the record. */
int step_led(Onward *s)
{
    double *to = s->record;
    sums(s->sum);
    for (int64_t i = 0; i < s->pieces; to += s->size[i++])
        memcpy(to, s->piece[i], (size_t)s->size[i] * sizeof(double));
    s->record = to;
    if (s->pressure)
        memcpy(s->pressure, s->lam, (size_t)s->m * sizeof(double));
    return DONE;
}

/* Whether all points are within reach, once the poses at q (+) delta_q are there. */
int step_within(Onward *s)
{
    int within = squared_distances(s->scene) <= *s->reach;
    lap(s, INTEGRATE);
    s->record[-1] = s->seconds[INTEGRATE];
    return within;
}

static int led(Onward *s) { return half_turns(s->sum) ? step_led(s) : SINES; }

/* The same after a backend's answer, if its numbers are finite. */
int step_answered(Onward *s)
{
    int known = 1;
    double length = s->units[0], size = s->units[1];
    for (int64_t v = 0; v < s->n; v++) {
        s->delta_q[v] = s->x[v] * (size * s->coordinate[v]);
        known &= isfinite(s->delta_q[v]);
    }
    for (int64_t r = 0; r < s->m; r++) {
        s->lam[r] = s->y[r] * (size / length);
        known &= isfinite(s->lam[r]);
    }
    lap(s, SOLVE);
    return known ? led(s) : TO_PYTHON;
}

static double larger_of(double x, double y) { return x > y ? x : y; }

/* certify/residuals.optimality_residuals of a group in its natural units; 0 if one is not finite, or if,
   as far as float64 shows, its displacement may be absurdly long: more than `times` what its load would
   move it. */
static int judged(const Proof *p, double times, double *most)
{
    int64_t n = p->n_v, n_a = p->n_a, n_u = n - n_a;
    double length = p->units[0], size = p->units[1], known = 0.0, moved = 0.0, load = 0.0, off = 0.0;
    for (int64_t v = 0; v < n; v++) {
        double balance = -p->g[v], size_of_H = 0.0;
        for (int64_t j = v < n_a ? 0 : n_a; j < (v < n_a ? n_a : n); j++) {
            double H = v < n_a ? *p->h * p->K_q[n_a * v + j] : p->M_u[n_u * (v - n_a) + j - n_a] / *p->h;
            balance += H * p->delta_q[j];
            size_of_H += fabs(H * p->delta_q[j]);
        }
        for (int64_t r = 0; r < p->rows; r++)
            if (p->lam[r] != 0.0)
                balance -= p->A[n * r + v] * p->lam[r];
        balance *= p->coordinate[v] / size;
        most[0] = larger_of(most[0], fabs(balance));
        known += fabs(balance);
        /* Upper and lower bounds, but for their rounding; no square of a displacement vanishes. */
        moved += fabs(p->delta_q[v]) * size_of_H + (p->delta_q[v] != 0.0 ? 0x1p-900 : 0.0);
        for (int64_t j = 0; j < n; j++) {
            double term = p->g[v] * p->inverse[n * v + j] * p->g[j];
            load += term;
            off += fabs(term);
        }
    }
    for (int64_t r = 0; r < p->rows; r++) {
        double slack = -p->b[r], y = p->lam[r] * (length / size);
        for (int64_t v = 0; v < n; v++)
            slack += p->A[n * r + v] * p->delta_q[v];
        slack /= size * length;
        most[1] = larger_of(most[1], -slack);
        most[2] = larger_of(most[2], -y);
        most[3] = larger_of(most[3], fabs(slack * y));
        known += fabs(slack) + fabs(slack * y);
    }
    load -= 0x1p-40 * off;
    return isfinite(known) && (moved == 0.0 || (load > 0x1p-860 && moved <= times * times * load));
}

/* The same after a proof. */
int step_proved(Onward *s)
{
    double lengths = 0.0;
    lap(s, PROOF);
    for (int64_t r = 0; r < s->m; r++)
        lengths += s->lam[r] * s->lam[r];
    for (int i = 0; i < 4; i++)
        s->residuals[i] = 0.0;
    for (int64_t i = 0; i < s->groups; i++)
        if (!judged(s->group[i], ILL_POSED / 8, s->residuals))
            return TO_PYTHON;
    if (!(lengths < 0x1p199))
        return TO_PYTHON;
    return led(s);
}
