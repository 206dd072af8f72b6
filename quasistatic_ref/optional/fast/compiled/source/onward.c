/* certify/residuals.optimality_residuals of a proof, and all else of a step that follows on another, but
   its answer or its proof, with test_onward.py. */

#define _POSIX_C_SOURCE 199309L /* clock_gettime */

#include <string.h>
#include <time.h>

#include "scene.h"
#include "solids.h"

/* What becomes of a step: Python has to take it, or to say sines, or which groups there are. */
enum { TO_PYTHON, DONE, REGROUPED, SINES };

enum { DISTANCES, ROWS, SOLVE, PROOF, INTEGRATE, LAPS };

struct Natural;
struct Screws;

int turns(struct Screws *s);
void changes(struct Screws *s);
int half_turns(struct Screws *s);
void sums(struct Screws *s);
double step_data(Scene *s);
double reach(const Scene *s);
int natural_program(struct Natural *s);

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    /* Coordinates, rows, groups; from row to row, and from column to column, of the program's A. */
    int64_t n, m, groups, row, column;
    /* How many arrays a record holds. */
    int64_t pieces;
    struct Screws *change, *sum;
    Pairs *pairs;
    Scene *scene;
    struct Natural *program;
    /* How far contacts may be in penetration [m]. */
    const double *penetration;
    /* Of a step that is to be proved, otherwise zeros: whether each coordinate moves each contact, and its
       group, both as the proofs have them; n, d1, d2 and spin of each contact as four rows of four; the
       multipliers by which the next step begins. */
    const int64_t *moves, *group;
    double *frame, *pressure;
    /* The program in natural units, and these units. */
    const double *coordinate, *units, *H, *f, *A, *b;
    /* certify/norm.EnergyNorm of H. */
    const double *unit, *L, *inverse, *g;
    double *squared; /* of the displacement and of the load of each group */
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
    int64_t n = s->n;
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
    if (!(step_data(s->scene) >= -*s->penetration) || !natural_program(s->program))
        return TO_PYTHON;
    if (s->moves && !moves_alike(s))
        return REGROUPED;
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
    int within = reach(s->scene) <= *s->reach;
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

/* certify/residuals.optimality_residuals in natural units, x being where Eq. (9) is judged and y its
   multipliers; 0 if one is not finite. */
static int judged(const Onward *s)
{
    int64_t n = s->n;
    double length = s->units[0], size = s->units[1], *most = s->residuals, known = 0.0;
    for (int i = 0; i < 4; i++)
        most[i] = 0.0;
    for (int64_t v = 0; v < n; v++) {
        double balance = s->f[v];
        for (int64_t j = 0; j < n; j++)
            balance += s->H[n * v + j] * (s->delta_q[j] / (size * s->coordinate[j]));
        for (int64_t r = 0; r < s->m; r++)
            if (s->lam[r] != 0.0)
                balance -= s->A[r * s->row + v * s->column] * (s->lam[r] / (size / length));
        most[0] = larger_of(most[0], fabs(balance));
        known += fabs(balance);
    }
    for (int64_t r = 0; r < s->m; r++) {
        double slack = -s->b[r], y = s->lam[r] / (size / length);
        for (int64_t v = 0; v < n; v++)
            slack += s->A[r * s->row + v * s->column] * (s->delta_q[v] / (size * s->coordinate[v]));
        most[1] = larger_of(most[1], -slack);
        most[2] = larger_of(most[2], -y);
        most[3] = larger_of(most[3], fabs(slack * y));
        known += fabs(slack) + fabs(slack * y);
    }
    return isfinite(known);
}

/* optional/fast/proofs: whether the displacement of a group may be absurdly long, as far as float64
   shows: more than `times` what its load would move it. */
static int may_be_long(const Onward *s, double times)
{
    int64_t n = s->n;
    for (int64_t i = 0; i < 2 * s->groups; i++)
        s->squared[i] = 0.0;
    for (int64_t i = 0; i < n; i++) {
        double moved = 0.0, load = 0.0;
        for (int64_t j = i; j < n; j++)
            moved += s->L[n * j + i] * (s->delta_q[j] / s->unit[j]);
        for (int64_t j = 0; j <= i; j++)
            load += s->inverse[n * i + j] * (s->g[j] * s->unit[j]);
        /* No square of a displacement vanishes. */
        s->squared[2 * s->group[i]] += moved * moved + (s->delta_q[i] != 0.0 ? 0x1p-900 : 0.0);
        s->squared[2 * s->group[i] + 1] += load * load;
    }
    for (int64_t i = 0; i < 2 * s->groups; i += 2) {
        double moved = s->squared[i], load = s->squared[i + 1];
        if (moved != 0.0 && !(load > 0x1p-860 && moved <= times * times * load))
            return 1;
    }
    return 0;
}

/* The same after a proof. */
int step_proved(Onward *s)
{
    double lengths = 0.0;
    lap(s, PROOF);
    for (int64_t r = 0; r < s->m; r++)
        lengths += s->lam[r] * s->lam[r];
    if (!judged(s) || may_be_long(s, ILL_POSED / 8) || !(lengths < 0x1p199))
        return TO_PYTHON;
    return led(s);
}
