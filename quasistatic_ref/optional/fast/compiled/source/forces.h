/* What C knows of the forces of a group. */

#ifndef FORCES_H
#define FORCES_H

#include "proof.h"

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    /* Rows of a face in the table: conditions, then four of s, as in faces.py; D, a multiple of all
       denominators. */
    int64_t width, sides, multiple;
    Proof *group;
    /* Of each contact the number of its rows, its first face in the table, and its face: a bit for each
       of the rows that span it. */
    const int64_t *count, *first;
    int64_t *face;
    const int64_t *table, *denominator; /* 0 of rows that depend on each other */
    const int64_t *side, *start;        /* coordinates of one side after the other; where each starts */
    const int64_t *bears;               /* whether n, d1 and d2 bear loads, in this cone */
    double *near, *compliance, *wrench; /* near: those without compliance */
} Forces;

int forces(Forces *f);

#endif
