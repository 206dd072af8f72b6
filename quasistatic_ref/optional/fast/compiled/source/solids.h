/* Pairs of solids, and what the files that find their closest points share. */

#ifndef SOLIDS_H
#define SOLIDS_H

#include "solid.h"

enum { OWN, OF_PAIR }; /* contact/separations */

enum { LARGEST = 1024 }; /* of lists of a pair; Python measures pairs with more */

/* Of ClosestPoints and of Witness: one contact. */
typedef struct {
    double phi, alpha[3], beta[3], n[3];
    int64_t point, tie;
} Contact;

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t pairs;
    const double *const *R, *const *t; /* of the links: R by columns, as pinocchio keeps it */
    /* Of each pair: both solids, or two zeros where it has a cloud or Python measures it; the shapes'
       links and places on them (3 x 4); k, where its contacts go and how many they are, and the corners of both. */
    const Solid *const *a, *const *b;
    const int64_t *link_a, *link_b;
    const double *on_a, *on_b;
    const int64_t *k, *start, *count, *corners;
    /* Room for all candidates of a pair, and for their order. */
    Contact *candidates;
    int64_t *order, *late;
    /* Written: whether the pair is decided, and its contacts. */
    int64_t *decided;
    double *phi, *n, *alpha, *beta;
    int64_t *point, *tie;
} SolidPairs;

/* Two solids in the world, and what of their distances is rounding. */
typedef struct {
    const Solid *a, *b;
    double at_a[12], at_b[12], within;
} Pair;

/* What follows returns 0 where Python has to say: a normal that is one of several, or a sign that
   rounding decides. */
int polytopes(const Pair *pair, Contact *nearest);
int one_normal(const Pair *pair, const Contact *nearest, const double *gap, const double *normal, int count);
int64_t every_candidate(const Pair *pair, const Contact *nearest, int64_t n_c, Contact *found);
int64_t crossings(const Pair *pair, const Contact *nearest, int64_t first, Contact *found);
Contact swapped(const Contact *contact);

/* The world's poses of the two shapes of pair p. */
void poses_of(const SolidPairs *s, int64_t p, double *at_a, double *at_b);

int solid_pairs(SolidPairs *s);

#endif
