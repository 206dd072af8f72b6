/* Closest points of clouds on solids, from the poses of the links. */

#include "scene.h"

int64_t scene_size(void) { return sizeof(Scene); }

/* contact/distance: R times on_link, then + t. */
static void placed(const double *R, const double *t, const double *on_link, double *world)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = R[i] * on_link[j];
            for (int k = 1; k < 3; k++)
                sum += R[i + 3 * k] * on_link[4 * k + j];
            world[4 * i + j] = sum;
        }
        world[4 * i + 3] += t[i];
    }
}

/* contact/distance: R_solid' times [R_cloud, t_cloud - t_solid]. */
static void relative(const double *solid, const double *cloud, double *pose)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            double terms[3];
            for (int k = 0; k < 3; k++) {
                double at = j < 3 ? cloud[4 * k + j] : cloud[4 * k + 3] - solid[4 * k + 3];
                terms[k] = solid[4 * k + i] * at;
            }
            pose[4 * i + j] = (terms[0] + terms[1]) + terms[2];
        }
}

static inline double larger(double a, double b) { return a > b ? a : b; }

static inline double along(const double *row, double x, double y, double z)
{
    return (row[0] * x + row[1] * y) + row[2] * z;
}

/* shapes: signed_distance, and its normal where one is asked for. */
static double rounded_box(const double *size, const double *x, double *normal)
{
    double excess[3], beyond[3], inside;
    for (int i = 0; i < 3; i++) {
        excess[i] = fabs(x[i]) - size[i];
        beyond[i] = larger(excess[i], 0.0);
    }
    double outside = sqrt((beyond[0] * beyond[0] + beyond[1] * beyond[1]) + beyond[2] * beyond[2]);
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
    return outside + (inside < 0.0 ? inside : 0.0) - size[3];
}

static double cylinder(const double *size, const double *x, double *normal)
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

static double distance(int64_t kind, const double *size, const double *x, double *normal)
{
    if (kind == ROUNDED_BOX)
        return rounded_box(size, x, normal);
    if (kind == CYLINDER)
        return cylinder(size, x, normal);
    for (int i = 0; normal && i < 3; i++)
        normal[i] = size[i];
    return along(size, x[0], x[1], x[2]) - size[3];
}

/* contact/tied_faces: whether two faces of a solid are as high, within twice what counts there, where a
   point touches or is inside. NumPy then says which one the normal is of. */
static int faces_tie(int64_t kind, const double *size, const double *x, double phi, double places)
{
    double within = 4e-12 * (size[0] + size[1] + size[2] + places), height[6];
    int faces = 0;
    if (phi > within || kind == HALF_SPACE || (kind == ROUNDED_BOX && size[3] > 0.0))
        return 0;
    if (kind == ROUNDED_BOX)
        for (int i = 0; i < 3; i++) {
            height[faces++] = x[i] - size[i];
            height[faces++] = -x[i] - size[i];
        }
    else {
        height[faces++] = sqrt(x[0] * x[0] + x[1] * x[1]) - size[0];
        height[faces++] = x[2] - size[1];
        height[faces++] = -x[2] - size[1];
    }
    double most = -INFINITY;
    for (int i = 0; i < faces; i++)
        most = larger(most, height[i]);
    int level = 0;
    for (int i = 0; i < faces; i++)
        level += height[i] >= most - within;
    return level > 1;
}

/* tracker/tracker_bound: below which signed distances no point outside the list can have come. Its rounding
   is in the bounds' room, so that any order of its sum will do. */
static double limit(const Scene *s, int64_t pair, const double *pose)
{
    double least = INFINITY;
    for (int64_t i = s->bounds[pair]; i < s->bounds[pair + 1]; i++) {
        double sum = s->offset[i];
        for (int k = 0; k < 12; k++)
            sum += s->slope[12 * i + k] * pose[k];
        if (!(sum >= least))
            least = sum;
    }
    return least;
}

static void in_solid(const double *pose, double x, double y, double z, double *at)
{
    for (int i = 0; i < 3; i++)
        at[i] = along(pose + 4 * i, x, y, z) + pose[4 * i + 3];
}

/* contact/distance: the `count` least distances in ascending order, ties by index; 0 if one is NaN. */
static int selected(const Scene *s, int64_t pair, const double *pose)
{
    int64_t kept = 0, count = s->count[pair];
    for (int64_t w = 0; w < s->length[pair]; w++) {
        double at[3];
        int64_t p = s->first[pair] + w;
        in_solid(pose, s->x[p], s->y[p], s->z[p], at);
        double phi = distance(s->kind[pair], s->size + 4 * pair, at, 0);
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
static int witness(const Scene *s, int64_t pair, const double *pose, int64_t c, int64_t p)
{
    const double *solid = s->world + 24 * pair, *cloud = solid + 12;
    double at[3], normal[3];
    in_solid(pose, s->x[p], s->y[p], s->z[p], at);
    s->phi[c] = distance(s->kind[pair], s->size + 4 * pair, at, normal) + 0.0;
    s->point[c] = s->index[p];
    double places = 0.0;
    for (int i = 0; i < 3; i++)
        places += fabs(solid[4 * i + 3]) + fabs(cloud[4 * i + 3]);
    if (faces_tie(s->kind[pair], s->size + 4 * pair, at, s->phi[c], places))
        return 0;
    for (int i = 0; i < 3; i++) {
        double n = along(solid + 4 * i, normal[0], normal[1], normal[2]);
        double centre = along(cloud + 4 * i, s->x[p], s->y[p], s->z[p]) + cloud[4 * i + 3];
        double foot = centre - s->phi[c] * n;
        int swapped = s->sign[pair] < 0.0;
        s->n[3 * c + i] = s->sign[pair] * n + 0.0; /* zero is 0.0, never -0.0 */
        s->alpha[3 * c + i] = swapped ? centre : foot;
        s->beta[3 * c + i] = swapped ? foot : centre;
    }
    return 1;
}

/* The closest points of all pairs; 0 where the lists do not prove them, or a normal is tied. */
int closest_points(Scene *s)
{
    for (int64_t pair = 0; pair < s->pairs; pair++) {
        double *solid = s->world + 24 * pair, *cloud = solid + 12, pose[12];
        int64_t a = s->link_solid[pair], b = s->link_cloud[pair];
        placed(s->R[a], s->t[a], s->on_solid + 12 * pair, solid);
        placed(s->R[b], s->t[b], s->on_cloud + 12 * pair, cloud);
        relative(solid, cloud, pose);
        if (!selected(s, pair, pose) || !(s->nearest[s->count[pair] - 1] < limit(s, pair, pose)))
            return 0;
        for (int64_t j = 0; j < s->count[pair]; j++)
            if (!witness(s, pair, pose, s->start[pair] + j, s->rank[j]))
                return 0;
    }
    return 1;
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
