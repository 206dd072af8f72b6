/* The points of a cloud that rank first on solids with a closed form: contact/batches/clouds, `contacts`. */

#include <stdbool.h>

#include "vectors.h"

enum { FACES = 6 };

/* One solid, its pose and the cloud's in the world, and the cloud's as seen from the solid. */
typedef struct {
    int64_t is_plane, has_faces, points;
    const double *size; /* half extents of the core and the radius; or normal and offset */
    double resolution;
    double solid[12], cloud[12], pose[12];
} Pair;

/* contact/shape_in_world, `poses_in_world`: a shape's pose, from those of its link and of it on this. */
static void in_world(const double *R, const double *t, const double *on_link, double *world)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            world[4 * i + j] = (R[3 * i] * on_link[j] + R[3 * i + 1] * on_link[4 + j]) + R[3 * i + 2] * on_link[8 + j];
        world[4 * i + 3] += t[i];
    }
}

/* contact/distance, `relative_pose`: R_solid' times [R_other, t_other - t_solid]. */
static void relative_pose(const double *solid, const double *other, double *pose)
{
    for (int j = 0; j < 4; j++) {
        double column[3];
        for (int i = 0; i < 3; i++)
            column[i] = other[4 * i + j] - (j == 3 ? solid[4 * i + 3] : 0.0);
        for (int i = 0; i < 3; i++)
            pose[4 * i + j] = (solid[i] * column[0] + solid[4 + i] * column[1]) + solid[8 + i] * column[2];
    }
}

/* shapes/half_space, `signed_distance`, of all points, which stand axis by axis. */
static void to_plane(const Pair *s, const double *point, double *restrict distance)
{
    const double *px = point, *py = px + s->points, *pz = py + s->points, *n = s->size;
    for (int64_t p = 0; p < s->points; p++) {
        double at[3] = {px[p], py[p], pz[p]}, x[3];
        carried(s->pose, at, x);
        distance[p] = dot(n, x) - n[3];
    }
}

/* How far x is beyond each pair of faces of a box, and how far it is outside. */
static inline double outside_of(const double *half, const double *x, double *excess, double *beyond)
{
    for (int i = 0; i < 3; i++) {
        excess[i] = fabs(x[i]) - half[i];
        beyond[i] = larger(excess[i], 0.0);
    }
    return sqrt(dot(beyond, beyond));
}

/* shapes/rounded, `distance_to_rounded_box`, of all points. */
static void to_core(const Pair *s, const double *point, double *restrict distance)
{
    const double *px = point, *py = px + s->points, *pz = py + s->points;
    double half[3] = {s->size[0], s->size[1], s->size[2]}, radius = s->size[3];
    for (int64_t p = 0; p < s->points; p++) {
        double at[3] = {px[p], py[p], pz[p]}, x[3], beyond[3], excess[3];
        carried(s->pose, at, x);
        double outside = outside_of(half, x, excess, beyond);
        double inside = larger(larger(excess[0], excess[1]), excess[2]);
        distance[p] = outside + smaller(inside, 0.0) - radius;
    }
}

/* shapes/rounded, `distance_to_rounded_box`: the normal. */
static void normal_of_core(const double *size, const double *x, double *normal)
{
    double excess[3], beyond[3], outside = outside_of(size, x, excess, beyond);
    int face = excess[1] > excess[0] ? 1 : 0;
    if (excess[2] > excess[face])
        face = 2;
    for (int i = 0; i < 3; i++)
        normal[i] = copysign(outside == 0.0 ? (i == face) : beyond[i] / outside, x[i] + 0.0);
}

/* contact/normals, `faces_apart`: whether another face of a box is as high as the highest. */
static int faces_tie(const double *size, const double *x, double within)
{
    double height[FACES], most = -INFINITY;
    int level = 0;
    for (int f = 0; f < FACES; f++) {
        height[f] = (f < 3 ? x[f] : -x[f - 3]) - size[f % 3];
        most = larger(most, height[f]);
    }
    for (int f = 0; f < FACES; f++)
        level += height[f] >= most - within;
    return level > 1;
}

/* A distance from which on every point ranks after `rank`: that of the next rank, which is half a rank
   farther than need be, for the rounding of the product and of the quotient. */
static double surely_after(double rank, double resolution)
{
    return fabs(rank) < 0x1p50 ? (rank + 1) * resolution : INFINITY;
}

/* contact/ranks, `closest`, of `rounded_gaps`: the points that rank first, ties by index; their ranks
   are written into `ranks`. 0 if a distance is no number. */
static int closest(const Pair *s, const double *distance, int64_t count, int64_t *index, double *ranks)
{
    int64_t kept = 0;
    double after = INFINITY;
    for (int64_t p = 0; p < s->points; p++) {
        if (distance[p] > after) /* a division less */
            continue;
        double rank = rint(distance[p] / s->resolution);
        if (rank != rank)
            return 0;
        if (kept == count && !(rank < ranks[kept - 1]))
            continue;
        int64_t j = kept < count ? kept++ : count - 1;
        for (; j > 0 && rank < ranks[j - 1]; j--) {
            ranks[j] = ranks[j - 1];
            index[j] = index[j - 1];
        }
        ranks[j] = rank;
        index[j] = p;
        if (kept == count)
            after = surely_after(ranks[kept - 1], s->resolution);
    }
    return kept == count;
}

/* `sizes`: pairs, points, contacts of a pair, whether the cloud is alpha's, and how far the numbers of a pair's points
   are from those of the next: 0 where all pairs have the same. Of each pair: two flags (a half-space; a solid with
   faces), four sizes and a resolution; an extent (0 of a half-space), the radius of the balls about the points, the
   grain of a half-space, and how far out it may be; the links of solid and cloud, and [R, t] of both on them; the
   points axis by axis. R and t of all links. Written: a workspace of as many numbers as points; which pairs are known;
   phi, alpha, beta and n, one after another, and the numbers of the points. */
int64_t cloud_contacts(const int64_t *sizes, const int64_t *flags, const double *solids, const double *resolution,
                       const double *more, const int64_t *links, const double *on_link, const double *point,
                       const double *R, const double *t, double *distance, bool *known, double *phi,
                       int64_t *index)
{
    int64_t pairs = sizes[0], points = sizes[1], count = sizes[2], is_alpha = sizes[3], all = pairs * count;
    double *alpha = phi + all, *beta = alpha + 3 * all, *n = beta + 3 * all;
    for (int64_t p = 0; p < pairs; p++, point += sizes[4], more += 4) {
        Pair s = {.is_plane = flags[2 * p], .has_faces = flags[2 * p + 1], .points = points,
                  .size = solids + 4 * p, .resolution = resolution[p]};
        const int64_t *link = links + 2 * p;
        double places = 0.0, size = 0.0, radius = more[1], least = INFINITY;
        int64_t level = 0;
        in_world(R + 9 * link[0], t + 3 * link[0], on_link + 24 * p, s.solid);
        in_world(R + 9 * link[1], t + 3 * link[1], on_link + 24 * p + 12, s.cloud);
        relative_pose(s.solid, s.cloud, s.pose);
        for (int k = 0; k < 12; k++)
            size += fabs(s.pose[k]);
        known[p] = size < INFINITY; /* a comparison below may lose what is no number */
        if (!known[p])
            continue;
        (s.is_plane ? to_plane : to_core)(&s, point, distance);
        for (int k = 0; k < 3; k++)
            places = larger(places, larger(fabs(s.solid[4 * k + 3]), fabs(s.cloud[4 * k + 3])));
        if (radius > 0)
            for (int64_t i = 0; i < points; i++)
                distance[i] -= radius;
        if (more[2] > 0) { /* contact/batches/balls, `of_poses` */
            for (int64_t i = 0; i < points; i++)
                least = smaller(least, distance[i]);
            for (int64_t i = 0; i < points; i++)
                level += distance[i] <= least + 2 * more[2];
            s.resolution = level > 2 ? larger(s.resolution, more[2]) : s.resolution;
        }
        known[p] = larger(places, s.is_plane ? fabs(s.size[3]) : 0.0) < more[3] &&
                   closest(&s, distance, count, index + p * count, phi + p * count);
        if (!known[p])
            continue;
        double within = 1e-12 * larger(places, more[0]); /* TIED_FACES */
        for (int64_t j = p * count; j < (p + 1) * count; j++) {
            double at[3], x[3], normal[3], out[3], on_cloud[3];
            phi[j] = distance[index[j]];
            for (int i = 0; i < 3; i++)
                at[i] = point[i * points + index[j]];
            carried(s.pose, at, x);
            double away = radius > 0 ? dot(s.size, x) - s.size[3] : phi[j]; /* only half-spaces have one */
            if (s.has_faces && phi[j] <= within && faces_tie(s.size, x, within))
                known[p] = 0;
            if (s.is_plane)
                for (int i = 0; i < 3; i++)
                    normal[i] = s.size[i];
            else
                normal_of_core(s.size, x, normal);
            turned(s.solid, normal, out);
            carried(s.cloud, at, on_cloud);
            for (int i = 0; i < 3; i++) {
                double on_solid = on_cloud[i] - away * out[i];
                n[3 * j + i] = is_alpha ? -out[i] : out[i];
                on_cloud[i] -= radius * out[i];
                alpha[3 * j + i] = is_alpha ? on_cloud[i] : on_solid;
                beta[3 * j + i] = is_alpha ? on_solid : on_cloud[i];
            }
        }
    }
    return 1;
}
