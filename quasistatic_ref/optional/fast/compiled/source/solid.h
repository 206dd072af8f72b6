/* shapes/shape.Shape.signed_distance, with test_fast_pairs.py: a solid, vectors and poses; how far points
   are from the solid, in its own frame.

   Each function does what a Python function of the same task does, in the same order of operations,
   so that the bits are the same; the comments name it. Sums of products are those of step/ordered:
   over rising indices, from the first, each product and each sum rounded. */

#ifndef SOLID_H
#define SOLID_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#if FLT_EVAL_METHOD != 0
#error "float64 operations must be rounded to float64"
#endif

/* The first three are a point, a segment or a cuboid, the core, with a ball about each point. */
enum { SPHERE, CAPSULE, BOX, HALF_SPACE, CYLINDER, MESH };

/* Of a box; and the most that a mesh has, which then has at most 2 V - 4 triangles and 3 V - 6 edges. */
enum { FACES = 6, CORNERS = 64, TRIANGLES = 2 * CORNERS - 4, EDGES = 3 * CORNERS - 6 };

/* Of a mesh's surface: from each corner the way to the next one, its square, and the vector in the plane
   that points inwards from there. */
typedef struct {
    double normal[3], offset, corners[3][3], ways[3][3], squares[3], inward[3][3];
} Triangle;

/* structure.py reads this: 64-bit integers, then pointers. */
typedef struct {
    int64_t kind, corners, faces, edges, triangles;
    /* Half extents of the core and the ball's radius; or normal and offset; or radius and half
       length, or a mesh's largest coordinate, and zeros. Then the extent, which is 0 where it is infinite. */
    const double *size, *extent;
    /* contact/solids/polytope: of a mesh or a core, whose corners are the vertices. */
    const double *vertices, *normals, *offsets;
    const int64_t *ends, *sides;
    const Triangle *surface;
} Solid;

static inline double larger(double a, double b) { return a > b ? a : b; }

static inline double smaller(double a, double b) { return a < b ? a : b; }

/* The k-th smallest of n numbers, which change places. */
double ranked(double *x, int64_t n, int64_t k);

static inline double limited(double x) { return smaller(larger(x, 0.0), 1.0); }

static inline double along(const double *row, double x, double y, double z)
{
    return (row[0] * x + row[1] * y) + row[2] * z;
}

static inline double dot(const double *a, const double *b) { return along(a, b[0], b[1], b[2]); }

static inline double norm(const double *v) { return sqrt(dot(v, v)); }

static inline double planar_norm(const double *v) { return sqrt(v[0] * v[0] + v[1] * v[1]); }

static inline void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline void copied(const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i];
}

/* a + s b. */
static inline void moved_by(const double *a, double s, const double *b, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] + s * b[i];
}

static inline void difference(const double *a, const double *b, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[i] - b[i];
}

static inline double largest_difference(const double *a, const double *b, int count)
{
    double most = 0.0;
    for (int i = 0; i < count; i++)
        most = larger(fabs(a[i] - b[i]), most);
    return most;
}

static inline void negated(const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = -v[i];
}

/* Poses are [R, t], 3 x 4, by rows. R v, R' v, and R v + t. */
static inline void turned(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = dot(pose + 4 * i, v);
}

static inline void turned_back(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = (pose[i] * v[0] + pose[4 + i] * v[1]) + pose[8 + i] * v[2];
}

static inline void carried(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = dot(pose + 4 * i, v) + pose[4 * i + 3];
}

/* v - t. */
static inline void from_origin(const double *pose, const double *v, double *out)
{
    for (int i = 0; i < 3; i++)
        out[i] = v[i] - pose[4 * i + 3];
}

/* contact/distance: R times on_link, then + t; R by columns. */
static inline void placed(const double *R, const double *t, const double *on_link, double *world)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            world[4 * i + j] = (R[i] * on_link[j] + R[i + 3] * on_link[4 + j]) + R[i + 6] * on_link[8 + j];
        world[4 * i + 3] += t[i];
    }
}

/* contact/distance: R_solid' times [R_other, t_other - t_solid]. */
static inline void relative(const double *solid, const double *other, double *pose)
{
    for (int j = 0; j < 4; j++) {
        double column[3], own[3];
        for (int i = 0; i < 3; i++)
            column[i] = other[4 * i + j] - (j == 3 ? solid[4 * i + 3] : 0.0);
        turned_back(solid, column, own);
        for (int i = 0; i < 3; i++)
            pose[4 * i + j] = own[i];
    }
}

/* shapes: signed_distance, and its normal where one is asked for. */
static inline double rounded_box(const double *half, double ball, const double *x, double *normal)
{
    double excess[3], beyond[3], inside;
    for (int i = 0; i < 3; i++) {
        excess[i] = fabs(x[i]) - half[i];
        beyond[i] = larger(excess[i], 0.0);
    }
    double outside = norm(beyond);
    inside = larger(larger(excess[0], excess[1]), excess[2]);
    if (normal) {
        int face = excess[1] > excess[0] ? 1 : 0;
        if (excess[2] > excess[face])
            face = 2;
        for (int i = 0; i < 3; i++) {
            double away = outside == 0.0 ? (i == face) : beyond[i] / outside;
            normal[i] = copysign(away, x[i] + 0.0);
        }
    }
    return outside + (inside < 0.0 ? inside : 0.0) - ball;
}

static inline double cylinder(const double *size, const double *x, double *normal)
{
    double r = sqrt((x[0] * x[0] + x[1] * x[1]) + 0.0);
    double side = r - size[0], end = fabs(x[2]) - size[1];
    double beyond_side = larger(side, 0.0), beyond_end = larger(end, 0.0);
    double outside = sqrt(beyond_side * beyond_side + beyond_end * beyond_end);
    int is_outside = outside > 0.0;
    if (normal) {
        double of_side = is_outside ? beyond_side / outside : side >= end;
        double of_end = is_outside ? beyond_end / outside : !(side >= end);
        normal[0] = of_side * (r == 0.0 ? 1.0 : x[0] / r);
        normal[1] = of_side * (r == 0.0 ? 0.0 : x[1] / r);
        normal[2] = of_end * (x[2] < 0.0 ? -1.0 : 1.0);
    }
    return is_outside ? outside : larger(side, end);
}

static inline double height(const Triangle *t, const double *x) { return dot(t->normal, x) - t->offset; }

double hull_distance(const Solid *mesh, const double *x, double *normal);

static inline double signed_distance(const Solid *solid, const double *x, double *normal)
{
    const double *size = solid->size;
    if (solid->kind <= BOX)
        return rounded_box(size, size[3], x, normal);
    if (solid->kind == CYLINDER)
        return cylinder(size, x, normal);
    if (solid->kind == MESH)
        return hull_distance(solid, x, normal);
    for (int i = 0; normal && i < 3; i++)
        normal[i] = size[i];
    return along(size, x[0], x[1], x[2]) - size[3];
}

/* shapes: heights over the faces, of a box or a cylinder, or over a mesh's triangles; others have none. */
static inline int face_heights(const Solid *solid, const double *x, double *heights)
{
    const double *size = solid->size;
    if (solid->kind == CYLINDER) {
        heights[0] = planar_norm(x) - size[0];
        heights[1] = x[2] - size[1];
        heights[2] = -x[2] - size[1];
        return 3;
    }
    if (solid->kind == MESH) {
        for (int64_t t = 0; t < solid->triangles; t++)
            heights[t] = height(solid->surface + t, x);
        return solid->triangles;
    }
    for (int f = 0; solid->kind == BOX && f < FACES; f++)
        heights[f] = (f < 3 ? x[f] : -x[f - 3]) - size[f % 3];
    return solid->kind == BOX ? FACES : 0;
}

/* The normal of face f of a box, or of triangle f of a mesh. */
static inline const double *face_normal(const Solid *solid, int64_t f)
{
    return solid->kind == MESH ? solid->surface[f].normal : solid->normals + 3 * f;
}

#endif
