/* Pairs of shapes, and what the files that find their closest points share. */

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

/* A pair of a cloud and a solid. structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    /* Whether the cloud is alpha's; how many points it has; those that the next list is to have, that the
       list has, and that were measured so far; steps since the list was made. */
    int64_t is_alpha, points, width, listed, evaluated, age;
    const Solid *solid;
    const double *point, *box; /* in the cloud's frame: the points, and 8 corners of the box around them */
    /* The list: numbers of its points, ascending. Every other point is at least as high above the plane
       with normal n that touches the solid as the first bound says, or as far as the second: where the
       corners were at these places in the solid's frame. */
    int64_t *index;
    double *bounds, *n, *corners;
    double *phi, *height, *score; /* workspaces, of as many as there are points */
    const double *resolution;     /* of the pair */
    double *nearest;              /* of as many as contacts, as the next */
    int64_t *rank;
} Cloud;

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct Pairs {
    int64_t pairs;
    const double *const *R, *const *t; /* of the links: R by columns, as pinocchio keeps it */
    /* Of each pair: its cloud, or both solids; zeros where it is another, or Python measures it. The
       shapes' links and places on them (3 x 4); k, where its contacts go and how many they are, and the
       corners of both. */
    Cloud *const *cloud;
    const Solid *const *a, *const *b;
    const int64_t *link_a, *link_b;
    const double *on_a, *on_b;
    const int64_t *k, *start, *count, *corners;
    /* A workspace for all candidates of a pair, and for their order. */
    Contact *candidates;
    int64_t *order, *late;
    /* Written: whether the pair is decided, and its contacts. */
    int64_t *decided;
    double *phi, *n, *alpha, *beta;
    int64_t *point, *tie;
} Pairs;

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

double support_value(const Solid *solid, const double *n);

/* The world's poses of the two shapes of pair p. */
void poses_of(const Pairs *s, int64_t p, double *at_a, double *at_b);

/* Write contact c. */
void put(Pairs *s, int64_t c, const Contact *contact);

int closest_of_cloud(Pairs *s, int64_t p);
int closest_points(Pairs *s);

#endif
