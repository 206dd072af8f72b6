/* What the files of a step's data have in common. */

#ifndef SCENE_H
#define SCENE_H

#include "solids.h"

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t clouds, bounds, n_c, n_v, n_a, n_x, links;
    /* All pairs, and of each with a cloud its number among these, the solid, and whether that is beta's. */
    SolidPairs *solids;
    const int64_t *pair, *swaps;
    const Solid *const *solid;
    /* The short lists: where each starts, and the last ends; the points, and their numbers in the cloud;
       and of each pair as many bounds of all others. */
    const int64_t *first, *index;
    const double *points, *slope, *offset;
    /* Origins of the links; columns of the Jacobian, and the coordinate that each belongs to. */
    const double *const *t, *const *column;
    const int64_t *owner;
    /* Of each contact: which columns move its bodies, friction, number of rows. */
    const double *moves_alpha, *moves_beta, *mu_v, *mu_omega;
    const int64_t *rows;
    /* The cone: coefficients of slip_1, slip_2, spin in each row, and which of them it has. */
    const double *coefficient;
    const int64_t *has;
    /* Written at each step. */
    double *nearest; /* as many as the largest count of a pair, as the next */
    int64_t *rank, *point, *tie;
    double *phi, *n, *alpha, *beta, *d1, *d2, *J, *A, *b;
    double *work; /* 14 n_x + 4 n_v */
    /* The load: h; which coordinates weigh; gravity on the left of M dv + g = tau, as pinocchio
       keeps it; other forces; K_q and delta_q_bar_a. Then tau and g, which are written. */
    const double *h, *weighs, *const *gravity, *force, *K_q, *delta_q_bar_a;
    double *tau, *g;
} Scene;

#endif
