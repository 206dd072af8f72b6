/* The contacts of a cloud on a solid: contact/distance, `_cloud_on_solid`. */

#include "vectors.h"

enum { FACES = 6 };

/* contact/distance, `in_world`: the shape's pose, from that of its link, whose R is by columns. */
static void in_world(const double *R, const double *t, const double *on_link, double *world)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            world[4 * i + j] = (R[i] * on_link[j] + R[i + 3] * on_link[4 + j]) + R[i + 6] * on_link[8 + j];
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

/* shapes/half_space, `signed_distance`, of all points of the cloud. */
static void to_half_space(const Cloud *s, const double *pose, double *restrict distance)
{
    const double *px = s->point, *py = px + s->points, *pz = py + s->points;
    const double *n = s->size;
    for (int64_t p = 0; p < s->points; p++) {
        double at[3] = {px[p], py[p], pz[p]}, x[3];
        carried(pose, at, x);
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

/* shapes/rounded, `distance_to_rounded_box`, of all points of the cloud. */
static void to_core(const Cloud *s, const double *pose, double *restrict distance)
{
    const double *px = s->point, *py = px + s->points, *pz = py + s->points;
    double half[3] = {s->size[0], s->size[1], s->size[2]}, radius = s->size[3];
    for (int64_t p = 0; p < s->points; p++) {
        double at[3] = {px[p], py[p], pz[p]}, x[3], beyond[3], excess[3];
        carried(pose, at, x);
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

/* contact/normals, `cloud_surface`: whether two faces of a box may be as high, where a point touches
   or is inside. Then Python says which one the normal is of. */
static int faces_tie(const double *size, const double *x, double phi, double within)
{
    double height[FACES], most = -INFINITY;
    int level = 0;
    if (size[3] != 0.0 || phi > within)
        return 0;
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

/* contact/ranks, `closest`, of `rounded_gaps`: the `count` points that rank first, ties by index, and
   their distances. 0 if a distance is no number. */
static int closest(const Cloud *s)
{
    int64_t kept = 0;
    double resolution = *s->resolution, *ranks = s->phi, after = INFINITY;
    for (int64_t p = 0; p < s->points; p++) {
        if (s->distance[p] > after) /* a division less */
            continue;
        double rank = resolution > 0.0 ? rint(s->distance[p] / resolution) : s->distance[p];
        if (rank != rank)
            return 0;
        if (kept == s->count && !(rank < ranks[kept - 1]))
            continue;
        int64_t j = kept < s->count ? kept++ : s->count - 1;
        for (; j > 0 && rank < ranks[j - 1]; j--) {
            ranks[j] = ranks[j - 1];
            s->index[j] = s->index[j - 1];
        }
        ranks[j] = rank;
        s->index[j] = p;
        if (kept == s->count && resolution > 0.0)
            after = surely_after(ranks[kept - 1], resolution);
    }
    for (int64_t j = 0; j < kept; j++)
        s->phi[j] = s->distance[s->index[j]];
    return kept == s->count;
}

/* contact/distance, `_cloud_on_solid`; 0 where Python has to measure the pair. */
int closest_of_cloud(const Cloud *s)
{
    double solid[12], cloud[12], pose[12], places = 0.0, size = 0.0;
    in_world(s->R_solid, s->t_solid, s->solid_on_link, solid);
    in_world(s->R_cloud, s->t_cloud, s->cloud_on_link, cloud);
    relative_pose(solid, cloud, pose);
    for (int k = 0; k < 12; k++)
        size += fabs(pose[k]);
    if (!(size < INFINITY)) /* a comparison below may lose what is no number */
        return 0;
    if (s->is_half_space)
        to_half_space(s, pose, s->distance);
    else
        to_core(s, pose, s->distance);
    if (!closest(s))
        return 0;
    for (int k = 0; k < 3; k++)
        places += fabs(solid[4 * k + 3]) + fabs(cloud[4 * k + 3]);
    for (int64_t j = 0; j < s->count; j++) {
        double at[3], x[3], normal[3], n[3], on_solid[3], on_cloud[3], phi = s->phi[j] + 0.0;
        for (int i = 0; i < 3; i++) /* coordinates stand axis by axis */
            at[i] = s->point[i * s->points + s->index[j]];
        carried(pose, at, x);
        if (s->is_half_space)
            for (int i = 0; i < 3; i++)
                normal[i] = s->size[i];
        else {
            double within = 4e-12 * (s->size[0] + s->size[1] + s->size[2] + places);
            if (faces_tie(s->size, x, phi, within))
                return 0;
            normal_of_core(s->size, x, normal);
        }
        turned(solid, normal, n);
        carried(cloud, at, on_cloud);
        moved_by(on_cloud, -phi, n, on_solid);
        s->phi[j] = phi;
        for (int i = 0; i < 3; i++) {
            s->n[3 * j + i] = (s->cloud_is_alpha ? -n[i] : n[i]) + 0.0;
            s->alpha[3 * j + i] = s->cloud_is_alpha ? on_cloud[i] : on_solid[i];
            s->beta[3 * j + i] = s->cloud_is_alpha ? on_solid[i] : on_cloud[i];
        }
    }
    return 1;
}
