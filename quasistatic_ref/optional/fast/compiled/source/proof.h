/* What the files of a proof have in common. */

#ifndef PROOF_H
#define PROOF_H

#include <stdint.h>

#include "fixed_point.h"

enum { DECIDED, NO_MEMORY, LOST, SINGULAR, OPEN_BOUND, OPEN_NUMBER, OPEN_CLAIM, REFUTED, NOT_POSED };

/* Why a coordinate does not move: nothing acts on it, or the working set may hold it. */
enum { AT_REST = 1, STILL };

/* Bits to which the solution is refined, and again where a small number is open; of the grid of its
   corrections. Ties of bodies at rest on each other are broken by 2^-260. */
enum { REFINED = 120, FINEST = 400, GRID = 440, ROUNDS = 16 };

#define UP (1 + 0x1p-40)   /* for the rounding of sums of non-negative float64 numbers */
#define DOWN (1 - 0x1p-40)
#define FLOOR 0x1p-410     /* a residual that is added, so that no bound is zero */
#define NORMAL 0x1p-900    /* numbers beyond this have exact neighbours and multiples */

struct Natural;

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t n_a, n_v, n_c, rows, working, answered, code;
    /* Where the group's coordinates, contacts and rows stand in the step, and the entries of its J and
       A among those that the step keeps; -1 of a zero. */
    const int64_t *coordinates, *contacts, *rows_of_step, *in_J, *in_A;
    /* h; the units S, and {length, size}: powers of two. What finds these, and the g, A and b that it
       reads; lam and slacks of an answer. */
    const double *h, *coordinate;
    double *units;
    struct Natural *natural;
    double *g, *A, *b, *pressure, *gap;
    /* H^-1 in SI units, by which other guesses are found. */
    const double *K_q, *M_u, *inverse;
    double *delta_q_bar_a, *tau;
    /* Of each contact: n, d1, d2 and spin, as four rows of four; 1, mu_v, mu_v and mu_omega. */
    double *phi, *frame, *J, *mu;
    /* The cone: four coefficients of each row; the same times one factor, as integers. */
    const double *cone;
    const int64_t *integers;
    /* Of each row its contact and its number there; the rows that the answer presses; the guess. */
    const int64_t *contact, *row;
    int64_t *answer, *guess;
    /* h H: kept while H is the same. A workspace of Numbers. */
    void *hessian;
    double *hessian_values;
    /* The answer, in SI units; and what rounding took from delta_q, within a bound. */
    double *delta_q, *lam, *net, *slack, *rest, *bound;
    /* What may be zero and was taken to be: rows that are not in the guess, and coordinates; how
       many of both, and of the digits that show it. Whether multipliers are unique, and whether
       delta_q is differentiable. */
    int64_t *idle, *still, *counts, *claims;
    /* Of an optimum the least slack that is not zero, and the least multiplier of the working set;
       infinite where there is none. */
    double *least;
} Proof;

/* A number that is half-way between two float64 numbers, to within its bound: the slack of a row, or
   an entry of delta_q or of A'lam; of these the middle, times h for A'lam. */
enum { OF_SLACK, OF_MOTION, OF_NET, TIES = 32 };
typedef struct {
    int of;
    int64_t at;
    Number middle;
} Tie;

/* What one proof computes. */
typedef struct {
    Number *g, *A, *b, *z, *r, *net;
    Float *change;
    double *K, *R, *G, *rest, *e;
    int64_t *table, *pivot, *others, *balanced;
    int64_t balances; /* how many entries of A'lam may be zero by cancellation: `balanced` */
    char *rests;
    int refuted, open; /* whether a sign is wrong, and whether a number is not rounded yet */
    int finest; /* whether z is refined as far as it will be */
    int64_t ties;
    Tie tie[TIES];
} Workspace;

/* x in other units, `by` being a power of two. */
static inline Float scaled(double x, double by)
{
    double y = x * by;
    if (x != 0.0 && !(fabs(y) > NORMAL && fabs(y) < 1 / NORMAL))
        lost = 1;
    return exact(y);
}

void load(const Proof *s, Number *g);
void row_of(const Proof *s, int64_t r, Number *a, Number *b);
void system_of(const Proof *s, Workspace *m);
void corrected(const Proof *s, Workspace *m);
int inverse(double *R, int64_t n, int64_t *pivot);
void defect(const double *R, const double *K, const double *size, int64_t n, double *G, double *sizes);
int error_bounds(const double *R, const double *G, const double *r, int64_t n, double *e);
int nearest(const Number *x, double e, double h, double unit, double *out);
int half_way(const Number *x, double e, double h, double unit, double *out, Number *middle);
int64_t closed(const Proof *s, const int64_t *rows, int64_t count, double *weight);
void motion(const Proof *s, const Number *x, const double *off, int64_t c, int with_gap, Number *out,
            double *e);
void *workspace_of(const Proof *s, Workspace *m);
int regular(const Proof *s, Workspace *m);
int64_t unspanned(const Proof *s, int64_t *table, int64_t *pivot, int64_t *others);
int zeros(Proof *s, Workspace *m);
int satisfied(const Proof *s, const Workspace *m, const Number *f, const Number *A, const Number *b,
              int64_t count);
void refined(const Proof *s, Workspace *m, int bits);
int proof(Proof *s);
int independent(Proof *s);
int mended(Proof *s);
int proof_nearby(Proof *s);
int natural_units(struct Natural *s);

#endif
