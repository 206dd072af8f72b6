/* What C knows of the forces of a group; what a guess of their faces and its proof have in common. */

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

static const int of_p[4] = {2, 0, 1, 3}; /* p is (n, d1, d2, spin), a wrench (d1, d2, n, spin) */

/* A sum of a contact's lengths z that may be zero, or half-way between two float64: row z by = middle. */
typedef struct {
    int64_t contact;
    const int64_t *row;
    double by;
    Number middle;
} Open;

typedef struct {
    const Forces *f;
    const Proof *s;
    Workspace m; /* of x; K is h H + k sum B'P B */
    double c, k, units[2];
    double *B, *size, *x, *way; /* size: of what K is the sum of */
    double *z, *along;          /* z at x, and how it changes along the way */
    double *borne, *large;      /* J along n, d1 and d2; sizes of what the entries of B are the sums of */
    int64_t *before;            /* faces */
    Sum *sum;
    int64_t opened;
    Open *open;
} Force;

/* The numbers of a face: conditions of a contact's rows, then s, all times z and a denominator. */
static inline const int64_t *numbers(const Forces *f, int64_t c, int64_t face)
{
    return f->table + 4 * f->width * (f->first[c] + face);
}

static inline const int64_t *of_s(const Forces *f, int64_t c)
{
    return numbers(f, c, f->face[c]) + 4 * f->count[c];
}

static inline double denominator(const Forces *f, int64_t c, int64_t face)
{
    return (double)f->denominator[f->first[c] + face];
}

void seek(const Forces *f, int64_t c, const double *z, double share);
void assembled(Force *g);
int guessed(Force *g, int start);
int forces(Forces *f);

#endif
