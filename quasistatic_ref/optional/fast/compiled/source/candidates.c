/* contact/distance.every_candidate, with test_solids.py: candidates for the contacts of two solids, which
   are corners on the other one (contact/tied_faces), crossings, the closest pair. */

#include "solids.h"

/* shapes: support_value, of a sphere, capsule, box or mesh. */
double support_value(const Solid *solid, const double *n)
{
    double way[3] = {fabs(n[0]), fabs(n[1]), fabs(n[2])}, most = -INFINITY;
    if (solid->kind != MESH)
        return solid->size[3] + dot(way, solid->size);
    for (int64_t i = 0; i < solid->corners; i++)
        most = larger(dot(n, solid->vertices + 3 * i), most);
    return most;
}

/* contact/tied_faces, `_over`. */
static int is_over(const Solid *solid, const double *x, double height, const double *n, double near)
{
    double foot[3];
    if (!(height <= near && height > -INFINITY))
        return 0;
    moved_by(x, -height, n, foot);
    return signed_distance(solid, foot, 0) <= near;
}

/* contact/tied_faces, `_facing`: of a box or a mesh. */
static const double *face_over(const Solid *solid, const double *x, const double *n, double near, double within, double *height)
{
    double heights[TRIANGLES];
    int highest = 0, count = face_heights(solid, x, heights);
    for (int f = 0; f < count; f++) {
        if (!(dot(face_normal(solid, f), n) >= TURNED))
            heights[f] = -INFINITY;
        if (heights[f] > heights[highest])
            highest = f;
    }
    *height = heights[highest];
    const double *normal = face_normal(solid, highest);
    for (int f = 0; f < count; f++)
        if (heights[f] >= *height - within && largest_difference(face_normal(solid, f), normal, 3) > SAME_NORMAL)
            return 0;
    return is_over(solid, x, *height, normal, near) ? normal : 0;
}

/* contact/tied_faces: what a corner of another solid has on a solid; n is the pair's normal out of it. */
static double corner_surface(const Solid *solid, const double *x, const double *n, double within, double *normal, int64_t *tie)
{
    double own[3], phi = signed_distance(solid, x, own), near = OVER_FACE * *solid->extent + within;
    double height, gap = 0.0;
    const double *chosen = 0;
    if (solid->kind != HALF_SPACE && (phi <= near || dot(own, n) < TURNED)) {
        if ((solid->kind == BOX || solid->kind == MESH) && (chosen = face_over(solid, x, n, near, within, &height)))
            phi = height;
        else if (is_over(solid, x, gap = dot(x, n) - support_value(solid, n), n, near)) {
            chosen = n;
            phi = gap;
        }
    }
    copied(chosen ? chosen : own, normal);
    *tie = chosen && dot(own, normal) < 1 - SAME_NORMAL ? OF_PAIR : OWN;
    return phi;
}

/* contact/distance, `_towards`: which way the other body is, for the corners on the rims. */
static void towards(const Solid *solid, const double *pose, const double *nearest, const double *n, double *way)
{
    double apart[3], local[3], radius = solid->size[0];
    from_origin(pose, nearest, apart);
    turned_back(pose, apart, local);
    turned_back(pose, n, way);
    if (planar_norm(local) >= (1 - ON_RIM) * radius && planar_norm(way) > UPRIGHT)
        copied(local, way);
}

/* shapes/revolved, `rim_corners`: corner i of a cylinder. */
static void rim_corner(const Solid *solid, int64_t i, const double *way, double *out)
{
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    const double *quarter = quarters[i % 4];
    double length = planar_norm(way), x = 1.0, y = 0.0;
    if (length > UPRIGHT) {
        x = way[0] / length;
        y = way[1] / length;
    }
    out[0] = solid->size[0] * (quarter[0] * x + quarter[1] * -y);
    out[1] = solid->size[0] * (quarter[0] * y + quarter[1] * x);
    out[2] = i < 4 ? -solid->size[1] : solid->size[1];
}

/* The corners of one solid on the other, as contacts from this to that; n is out of the second. */
static int64_t corners_on(const Solid *other, const double *from, const Solid *solid, const double *at,
                          const double *tip, const double *n, double within, Contact *found)
{
    double pose[12], out[3], back[3], way[3] = {0.0, 0.0, 0.0};
    double ball = other->kind == CAPSULE ? other->size[3] : 0.0;
    relative(at, from, pose);
    turned_back(at, n, out);
    negated(n, back);
    if (other->kind == CYLINDER)
        towards(other, from, tip, back, way);
    for (int64_t i = 0; i < other->corners; i++) {
        double corner[3], x[3], normal[3], centre[3];
        Contact *c = found + i;
        if (other->kind == CYLINDER)
            rim_corner(other, i, way, corner);
        else
            copied(other->vertices + 3 * i, corner);
        carried(pose, corner, x);
        double phi = corner_surface(solid, x, out, within, normal, &c->tie);
        turned(at, normal, c->n);
        carried(from, corner, centre);
        c->phi = phi - ball;
        c->point = i;
        moved_by(centre, -phi, c->n, c->alpha);
        moved_by(centre, -ball, c->n, c->beta);
    }
    return other->corners;
}

/* All candidates, the closest pair being the last; their number, 0 where they are too many. */
int64_t every_candidate(const Pair *pair, const Contact *nearest, int64_t n_c, Contact *found)
{
    const double *n = nearest->n;
    double back[3];
    negated(n, back);
    int64_t of_a = corners_on(pair->a, pair->at_a, pair->b, pair->at_b, nearest->alpha, back, pair->within, found);
    for (int64_t i = 0; i < of_a; i++)
        found[i] = swapped(found + i);
    int64_t count = of_a;
    count += corners_on(pair->b, pair->at_b, pair->a, pair->at_a, nearest->beta, n, pair->within, found + of_a);
    for (int64_t i = of_a; i < count; i++)
        found[i].point += of_a;
    int64_t crossing = crossings(pair, nearest, nearest->point + n_c, found + count);
    if (crossing < 0)
        return 0;
    count += crossing;
    found[count++] = *nearest;
    int64_t kept = 0;
    for (int64_t i = 0; i < count; i++) /* others cannot bear with the closest pair */
        if (dot(found[i].n, n) >= TURNED)
            found[kept++] = found[i];
    return kept;
}
