/* contact/distance.pair_closest_points of a cloud, from few of its points, with test_fast_pairs.py.

   docs/distances.md derives the two bounds that keep all other points out. */

#include "solids.h"

/* A point is left out by its distance only if its margin is this many times that by height: distances
   change as fast as a cloud moves, the order of heights only as fast as it turns. */
#define RATIO 16.0

/* Steps: a list that suffices for fewer is made twice as long, up to so many points. */
enum { SHORT = 8, WIDE = 256 };

enum { BOX_CORNERS = 8 };

/* contact/tied_faces: whether two faces of a solid are as high, within twice what counts there, where a
   point touches or is inside. Python then says which one the normal is of. */
static int faces_tie(const Solid *solid, const double *x, double phi, double places)
{
    double within = 4e-12 * (solid->size[0] + solid->size[1] + solid->size[2] + places), height[TRIANGLES];
    int faces = phi > within ? 0 : face_heights(solid, x, height), level = 0;
    double most = -INFINITY;
    for (int i = 0; i < faces; i++)
        most = larger(most, height[i]);
    for (int i = 0; i < faces; i++)
        level += height[i] >= most - within;
    return level > 1;
}

/* How far a solid reaches along a unit vector. A half-space has such a plane along its own normal only. */
static double reach_along(const Solid *solid, const double *n)
{
    if (solid->kind == HALF_SPACE)
        return solid->size[3];
    if (solid->kind == CYLINDER)
        return solid->size[0] * planar_norm(n) + solid->size[1] * fabs(n[2]);
    return support_value(solid, n);
}

/* What may be rounding [m], relative to the sizes of cloud and solid and their distance. */
static double rounding(const Cloud *c)
{
    double size = 0.0, of_cloud = 0.0, apart = 0.0;
    for (int i = 0; i < 6; i++) {
        double way[3] = {0.0, 0.0, 0.0};
        way[i % 3] = i < 3 ? 1.0 : -1.0;
        size += fabs(reach_along(c->solid, way));
    }
    for (int i = 0; i < 3 * BOX_CORNERS; i++) {
        of_cloud = larger(of_cloud, fabs(c->box[i]));
        apart = larger(apart, fabs(c->corners[i]));
    }
    return UNSEEN * (size + of_cloud + apart);
}

/* Below which signed distance no point outside the list can have come. A point that moves by u has its
   height changed by n'u, its distance by |u| at most, and what is rounded by UNSEEN |u|. All these are
   concave in u, and u is affine in the point: over the box around the cloud the least is at a corner. */
static double limit(const Cloud *c, const double *pose)
{
    double lowest = INFINITY, farthest = 0.0;
    for (int i = 0; i < BOX_CORNERS; i++) {
        double at[3], u[3];
        carried(pose, c->box + 3 * i, at);
        difference(at, c->corners + 3 * i, u);
        lowest = smaller(lowest, dot(c->n, u) - UNSEEN * norm(u));
        farthest = larger(farthest, norm(u));
    }
    return smaller(c->bounds[0] + lowest, c->bounds[1] - (1 + UNSEEN) * farthest);
}

/* Make the list at a pose: points by what the motion must use up before they can matter. Those that
   matter at this pose are on it, and the next best. 0 if a distance is no number. */
static int list(Cloud *c, const double *pose, int64_t count)
{
    const Solid *solid = c->solid;
    int64_t first = 0, N = c->points;
    double x[3], height = INFINITY, distance = INFINITY;
    for (int64_t p = 0; p < N; p++) {
        carried(pose, c->point + 3 * p, x);
        c->score[p] = c->phi[p] = signed_distance(solid, x, 0);
        if (c->phi[p] != c->phi[p])
            return 0;
        if (c->phi[p] < c->phi[first])
            first = p;
    }
    for (int i = 0; i < BOX_CORNERS; i++)
        carried(pose, c->box + 3 * i, c->corners + 3 * i);
    carried(pose, c->point + 3 * first, x);
    signed_distance(solid, x, c->n);
    double phi_k = ranked(c->score, N, count - 1), touching = reach_along(solid, c->n), slack = rounding(c);
    for (int64_t p = 0; p < N; p++) {
        carried(pose, c->point + 3 * p, x);
        c->height[p] = dot(x, c->n) - touching;
        c->score[p] = larger(c->phi[p] - phi_k, RATIO * (c->height[p] - phi_k));
    }
    if (c->listed && c->age < SHORT && c->width < WIDE)
        c->width = 2 * c->width < WIDE ? 2 * c->width : WIDE;
    double most = c->width < N ? ranked(c->score, N, c->width - 1) : INFINITY;
    most = larger(most, RATIO * (2 * slack + *c->resolution));
    c->listed = 0;
    for (int64_t p = 0; p < N; p++) {
        double far = c->phi[p] - phi_k, high = RATIO * (c->height[p] - phi_k);
        if (larger(far, high) <= most)
            c->index[c->listed++] = p;
        else if (high > far)
            height = smaller(height, c->height[p]);
        else
            distance = smaller(distance, c->phi[p]);
    }
    c->bounds[0] = height - slack;
    c->bounds[1] = distance - slack;
    c->evaluated += N;
    c->age = 0;
    return 1;
}

/* contact/distance, `rounded_gaps`: a distance as it ranks. */
static double as_it_ranks(const Cloud *c, double phi)
{
    return *c->resolution > 0.0 ? rint(phi / *c->resolution) : phi;
}

/* contact/distance: the `count` points on the list that rank first, ties by index; 0 if a distance is no
   number, or the list is too short. */
static int selected(Cloud *c, const double *pose, int64_t count)
{
    int64_t kept = 0;
    c->evaluated += c->listed;
    for (int64_t i = 0; i < c->listed; i++) {
        double at[3];
        carried(pose, c->point + 3 * c->index[i], at);
        double phi = as_it_ranks(c, signed_distance(c->solid, at, 0));
        if (phi != phi)
            return 0;
        if (kept == count && !(phi < c->nearest[kept - 1]))
            continue;
        int64_t j = kept < count ? kept++ : count - 1;
        for (; j > 0 && phi < c->nearest[j - 1]; j--) {
            c->nearest[j] = c->nearest[j - 1];
            c->rank[j] = c->rank[j - 1];
        }
        c->nearest[j] = phi;
        c->rank[j] = c->index[i];
    }
    return kept == count;
}

/* contact/distance: one contact in the world, whose point is number p of the cloud; 0 if faces tie. */
static int witness(Pairs *s, const Cloud *c, const double *solid, const double *cloud, const double *pose, int64_t j, int64_t p)
{
    double at[3], normal[3], n[3], centre[3], foot[3], places = 0.0;
    carried(pose, c->point + 3 * p, at);
    double phi = signed_distance(c->solid, at, normal) + 0.0;
    for (int k = 0; k < 3; k++)
        places += fabs(solid[4 * k + 3]) + fabs(cloud[4 * k + 3]);
    if (faces_tie(c->solid, at, phi, places))
        return 0;
    turned(solid, normal, n);
    carried(cloud, c->point + 3 * p, centre);
    moved_by(centre, -phi, n, foot);
    Contact found = {.phi = phi, .point = p, .tie = OWN};
    copied(foot, found.alpha);
    copied(centre, found.beta);
    copied(n, found.n);
    if (c->is_alpha)
        found = swapped(&found);
    put(s, j, &found);
    return 1;
}

/* contact/distance: the closest points of a cloud; 0 where Python has to measure the pair. */
int closest_of_cloud(Pairs *s, int64_t p)
{
    Cloud *c = s->cloud[p];
    double solid[12], cloud[12], pose[12];
    int64_t count = s->count[p];
    poses_of(s, p, c->is_alpha ? cloud : solid, c->is_alpha ? solid : cloud);
    relative(solid, cloud, pose);
    c->age++;
    if (!selected(c, pose, count) || !(c->nearest[count - 1] < as_it_ranks(c, limit(c, pose))))
        if (!list(c, pose, count) || !selected(c, pose, count))
            return 0;
    for (int64_t j = 0; j < count; j++)
        if (!witness(s, c, solid, cloud, pose, s->start[p] + j, c->rank[j]))
            return 0;
    return 1;
}
