/* Closest points of clouds on solids, from the poses of the links. */

#include "scene.h"

/* contact/tied_faces: whether two faces of a solid are as high, within twice what counts there, where a
   point touches or is inside. NumPy then says which one the normal is of. */
static int faces_tie(const Solid *solid, const double *x, double phi, double places)
{
    double within = 4e-12 * (solid->size[0] + solid->size[1] + solid->size[2] + places), height[FACES];
    int faces = phi > within ? 0 : face_heights(solid, x, height), level = 0;
    double most = -INFINITY;
    for (int i = 0; i < faces; i++)
        most = larger(most, height[i]);
    for (int i = 0; i < faces; i++)
        level += height[i] >= most - within;
    return level > 1;
}

/* tracker/tracker_bound: below which signed distances no point outside the list can have come. Its rounding
   is in the bounds' room, so that any order of its sum will do. */
static double limit(const Scene *s, int64_t i, const double *pose)
{
    double least = INFINITY;
    for (int64_t j = i * s->bounds; j < (i + 1) * s->bounds; j++) {
        double sum = s->offset[j];
        for (int k = 0; k < 12; k++)
            sum += s->slope[12 * j + k] * pose[k];
        if (!(sum >= least))
            least = sum;
    }
    return least;
}

/* contact/distance: the `count` least distances in ascending order, ties by index; 0 if one is NaN. */
static int selected(const Scene *s, int64_t i, int64_t count, const double *pose)
{
    int64_t kept = 0;
    for (int64_t p = s->first[i]; p < s->first[i + 1]; p++) {
        double at[3];
        carried(pose, s->points + 3 * p, at);
        double phi = signed_distance(s->solid[i], at, 0);
        if (phi != phi)
            return 0;
        if (kept == count && !(phi < s->nearest[kept - 1]))
            continue;
        int64_t j = kept < count ? kept++ : count - 1;
        for (; j > 0 && phi < s->nearest[j - 1]; j--) {
            s->nearest[j] = s->nearest[j - 1];
            s->rank[j] = s->rank[j - 1];
        }
        s->nearest[j] = phi;
        s->rank[j] = p;
    }
    return kept == count;
}

/* contact/distance: the points and normal of one contact in the world; 0 if faces tie. */
static int witness(const Scene *s, int64_t i, const double *solid, const double *cloud, const double *pose, int64_t c, int64_t p)
{
    const double *point = s->points + 3 * p;
    double at[3], normal[3], n[3], centre[3], foot[3];
    int64_t swaps = s->swaps[i];
    carried(pose, point, at);
    s->phi[c] = signed_distance(s->solid[i], at, normal) + 0.0;
    s->point[c] = s->index[p];
    s->tie[c] = OWN;
    double places = 0.0;
    for (int k = 0; k < 3; k++)
        places += fabs(solid[4 * k + 3]) + fabs(cloud[4 * k + 3]);
    if (faces_tie(s->solid[i], at, s->phi[c], places))
        return 0;
    turned(solid, normal, n);
    carried(cloud, point, centre);
    moved_by(centre, -s->phi[c], n, foot);
    copied(swaps ? centre : foot, s->alpha + 3 * c);
    copied(swaps ? foot : centre, s->beta + 3 * c);
    for (int k = 0; k < 3; k++)
        s->n[3 * c + k] = (swaps ? -n[k] : n[k]) + 0.0; /* zero is 0.0, never -0.0 */
    return 1;
}

/* The closest points of all pairs; 0 where the lists do not prove them, or Python measures a pair. */
int closest_points(Scene *s)
{
    const SolidPairs *pairs = s->solids;
    for (int64_t i = 0; i < s->clouds; i++) {
        double solid[12], cloud[12], pose[12];
        int64_t p = s->pair[i], swaps = s->swaps[i], count = pairs->count[p];
        poses_of(pairs, p, swaps ? cloud : solid, swaps ? solid : cloud);
        relative(solid, cloud, pose);
        if (!selected(s, i, count, pose) || !(s->nearest[count - 1] < limit(s, i, pose)))
            return 0;
        for (int64_t j = 0; j < count; j++)
            if (!witness(s, i, solid, cloud, pose, pairs->start[p] + j, s->rank[j]))
                return 0;
    }
    return solid_pairs(s->solids);
}

/* The squared distances of all links' origins from that of the world, added up. */
double reach(const Scene *s)
{
    double sum = 0.0;
    for (int64_t i = 0; i < s->links; i++)
        for (int k = 0; k < 3; k++)
            sum += s->t[i][k] * s->t[i][k];
    return sum;
}
