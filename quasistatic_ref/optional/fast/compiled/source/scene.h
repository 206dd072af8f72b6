/* What the files of a step's data have in common. */

#ifndef SCENE_H
#define SCENE_H

#include "solids.h"

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t pairs, n_c, n_v, n_a, n_x, links, mimics;
    /* Poses of the links: R by columns, as pinocchio keeps it; columns of the Jacobian. */
    const double *const *R, *const *t, *const *column;
    /* Of each pair with a cloud: the shapes' links and places on them (3 x 4), solid first. */
    const int64_t *link_solid, *link_cloud;
    const double *on_solid, *on_cloud;
    const Solid *const *solid;
    const double *sign; /* of the solid's normal in the contact's */
    /* The short list: points, their numbers, and the bounds of all others. */
    const int64_t *first, *length, *index;
    const double *points;
    const int64_t *bounds;
    const double *slope, *offset;
    /* Where the contacts of the pair go, and how many. */
    const int64_t *start, *count;
    /* Of each column: the coordinate that it belongs to. */
    const int64_t *owner;
    /* Of each contact: which columns move its bodies, friction, number of rows. */
    const double *moves_alpha, *moves_beta, *mu_v, *mu_omega;
    const int64_t *rows;
    /* The cone: coefficients of slip_1, slip_2, spin in each row, and which of them it has. */
    const double *coefficient;
    const int64_t *has;
    /* Written at each step. */
    double *world, *nearest; /* 24 for each pair; as many as the largest count */
    int64_t *rank, *point, *tie;
    double *phi, *n, *alpha, *beta, *d1, *d2, *J, *A, *b;
    double *work; /* 14 n_x + 4 n_v */
    /* The load: h; which coordinates weigh; gravity on the left of M dv + g = tau, as pinocchio
       keeps it; other forces; K_q and delta_q_bar_a. Then tau and g, which are written. */
    const double *h, *weighs, *const *gravity, *force, *K_q, *delta_q_bar_a;
    double *tau, *g;
    SolidPairs *solids; /* all pairs without a cloud */
} Scene;

#endif
