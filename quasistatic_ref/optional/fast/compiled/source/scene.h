/* What the files of a step's data have in common. */

#ifndef SCENE_H
#define SCENE_H

#include <stdint.h>

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    /* Contacts; coordinates, actuated ones; columns of J that a contact keeps, and columns of joints
       that move it; whether these are the same for all contacts; links. */
    int64_t n_c, n_v, n_a, kept, moving, same, links;
    /* Origins of the links; columns of pinocchio's Jacobian. */
    const double *const *t, *const *column;
    /* Of each contact, or of all: those that move it, and where each belongs in J. */
    const int64_t *joint_column, *place;
    /* Of each contact: which of these columns move its bodies, friction, number of rows. */
    const double *moves_alpha, *moves_beta, *mu_v, *mu_omega;
    const int64_t *rows;
    /* The cone: coefficients of slip_1, slip_2, spin in each row, and which of them it has. */
    const double *coefficient;
    const int64_t *has;
    /* Written at each step. */
    double *phi, *n, *alpha, *beta, *d1, *d2, *J, *A, *b;
    double *work; /* 14 moving + 4 kept */
    /* The load: h; which coordinates weigh; gravity on the left of M dv + g = tau, as pinocchio
       keeps it; other forces; K_q and delta_q_bar_a. Then tau and g, which are written. */
    const double *h, *weighs, *const *gravity, *force, *K_q, *delta_q_bar_a;
    double *tau, *g;
} Scene;

#endif
