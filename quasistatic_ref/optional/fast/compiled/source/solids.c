/* contact/distance.pair_closest_points of two solids, in the ordinary case, with test_solids.py.

   Where a normal is one of several, or bodies are too far away for float64, a pair is not decided
   here, and Python measures it. */

#include "solids.h"

Contact swapped(const Contact *contact)
{
    Contact other = *contact;
    copied(contact->beta, other.alpha);
    copied(contact->alpha, other.beta);
    negated(contact->n, other.n);
    return other;
}

/* Whether all numbers of a pose are such that nothing overflows; then the largest of its place. */
static int usual(const double *pose, double *place)
{
    int all = 1;
    for (int i = 0; i < 12; i++)
        all &= fabs(pose[i]) < 1e15;
    for (int i = 0; i < 3; i++)
        *place = larger(fabs(pose[4 * i + 3]), *place);
    return all;
}

static double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

/* shapes: support_point. */
static void support_point(const Solid *solid, const double *way, double *out)
{
    const double *size = solid->size;
    if (solid->kind == MESH) {
        int64_t best = 0;
        for (int64_t i = 1; i < solid->corners; i++)
            if (dot(solid->vertices + 3 * i, way) > dot(solid->vertices + 3 * best, way))
                best = i;
        copied(solid->vertices + 3 * best, out);
    } else if (solid->kind == CYLINDER) {
        double radial = planar_norm(way);
        out[0] = radial != 0.0 ? size[0] * way[0] / radial : 0.0;
        out[1] = radial != 0.0 ? size[0] * way[1] / radial : 0.0;
        out[2] = size[1] * sign(way[2]);
    } else
        for (int i = 0; i < 3; i++)
            out[i] = size[3] * way[i] + size[i] * sign(way[i]);
}

/* contact/solids/solid_pair. */
static void solid_on_plane(const Solid *plane, const double *at, const Solid *solid, const double *pose, Contact *c)
{
    double down[3], way[3], lowest[3], above[3];
    turned(at, plane->size, c->n);
    negated(c->n, down);
    turned_back(pose, down, way);
    support_point(solid, way, lowest);
    carried(pose, lowest, c->beta);
    from_origin(at, c->beta, above);
    c->phi = dot(c->n, above) - plane->size[3];
    moved_by(c->beta, -c->phi, c->n, c->alpha);
}

/* contact/separations: whether a sphere that touches a solid has one normal, as it surely has where no
   face is as high as its centre is far, or one is, or triangles in one plane, and no other is as high. */
static int one_face(const Solid *solid, const double *x, double phi, double within)
{
    double heights[TRIANGLES];
    int count = face_heights(solid, x, heights), most = 0;
    for (int f = 1; f < count; f++)
        if (heights[f] > heights[most])
            most = f;
    for (int f = 0; f < count; f++) {
        if (!(heights[f] >= phi - 2 * within))
            continue;
        int same = f == most;
        if (!same && solid->kind == MESH)
            same = largest_difference(face_normal(solid, f), face_normal(solid, most), 3) == 0.0;
        if (!same || phi != heights[most])
            return 0;
    }
    return 1;
}

/* contact/solids/solid_pair; `side` is that of the normal in the contact's. */
static int sphere_on_solid(const Pair *pair, double side, Contact *nearest)
{
    const Solid *solid = side > 0 ? pair->a : pair->b, *sphere = side > 0 ? pair->b : pair->a;
    const double *at = side > 0 ? pair->at_a : pair->at_b, *pose = side > 0 ? pair->at_b : pair->at_a;
    double centre[3] = {pose[3], pose[7], pose[11]}, above[3], x[3], normal[3];
    double radius = sphere->size[3];
    from_origin(at, centre, above);
    turned_back(at, above, x);
    double phi = signed_distance(solid, x, normal);
    turned(at, normal, nearest->n);
    nearest->phi = phi - radius;
    moved_by(centre, -phi, nearest->n, nearest->alpha);
    moved_by(centre, -radius, nearest->n, nearest->beta);
    if (side < 0)
        *nearest = swapped(nearest);
    return phi > pair->within || one_face(solid, x, phi, pair->within);
}

/* contact/separations: whether no gap is as large as the pair's along another normal than its own. */
int one_normal(const Pair *pair, const Contact *nearest, const double *gap, const double *normal, int count)
{
    const double *first = 0;
    for (int i = 0; i < count; i++) {
        const double *own = normal + 3 * i;
        if (!(gap[i] >= nearest->phi - pair->within))
            continue;
        first = first ? first : own;
        if (largest_difference(own, first, 3) > SAME_NORMAL)
            return 0;
    }
    return !first || largest_difference(nearest->n, first, 3) <= SAME_NORMAL;
}

/* contact/separations: pair_normal. */
static int nearest_of_solids(const Pair *pair, Contact *nearest)
{
    if (pair->b->kind == SPHERE)
        return sphere_on_solid(pair, 1.0, nearest);
    if (pair->a->kind == SPHERE)
        return sphere_on_solid(pair, -1.0, nearest);
    if (pair->a->kind == HALF_SPACE)
        solid_on_plane(pair->a, pair->at_a, pair->b, pair->at_b, nearest);
    else if (pair->b->kind == HALF_SPACE) {
        solid_on_plane(pair->b, pair->at_b, pair->a, pair->at_a, nearest);
        *nearest = swapped(nearest);
    } else
        return polytopes(pair, nearest);
    return 1;
}

/* contact/distance: which candidates rank last. */
static void rank_late(const Contact *every, int64_t count, int64_t k, int64_t *late)
{
    const Contact *last = every + count - 1;
    int64_t near = 0, corners = 0;
    for (int64_t i = 0; i < count; i++) {
        late[i] = 0;
        for (int64_t j = 0; j < i && !late[i]; j++)
            late[i] = fabs(every[i].phi - every[j].phi) <= REPEATED
                      && largest_difference(every[i].alpha, every[j].alpha, 3) <= REPEATED
                      && largest_difference(every[i].n, every[j].n, 3) <= REPEATED;
        int level = !late[i] && every[i].phi <= last->phi + REPEATED;
        near += level && i < count - 1;
        corners += level && every[i].point < last->point;
    }
    late[count - 1] |= near >= k;
    for (int64_t i = 0; i < count; i++)
        late[i] |= !(every[i].point < last->point) && corners >= k;
}

/* A stable sort of some candidates by distance; late ones last, where these are named. */
static void sort(const Contact *every, const int64_t *late, int64_t count, int64_t *order)
{
    for (int64_t i = 1; i < count; i++) {
        int64_t own = order[i], j = i;
        double phi = late && late[own] ? INFINITY : every[own].phi;
        for (; j > 0 && phi < (late && late[order[j - 1]] ? INFINITY : every[order[j - 1]].phi); j--)
            order[j] = order[j - 1];
        order[j] = own;
    }
}

void put(Pairs *s, int64_t c, const Contact *contact)
{
    s->phi[c] = contact->phi + 0.0; /* zero is 0.0, never -0.0 */
    s->point[c] = contact->point;
    s->tie[c] = contact->tie;
    for (int i = 0; i < 3; i++) {
        s->n[3 * c + i] = contact->n[i] + 0.0;
        s->alpha[3 * c + i] = contact->alpha[i];
        s->beta[3 * c + i] = contact->beta[i];
    }
}

void poses_of(const Pairs *s, int64_t p, double *at_a, double *at_b)
{
    int64_t a = s->link_a[p], b = s->link_b[p];
    placed(s->R[a], s->t[a], s->on_a + 12 * p, at_a);
    placed(s->R[b], s->t[b], s->on_b + 12 * p, at_b);
}

/* contact/distance: pair_closest_points. */
static int closest_of_pair(Pairs *s, int64_t p)
{
    Pair pair = {.a = s->a[p], .b = s->b[p]};
    int64_t count = s->count[p];
    double place = 0.0;
    poses_of(s, p, pair.at_a, pair.at_b);
    if (!(usual(pair.at_a, &place) & usual(pair.at_b, &place)))
        return 0;
    pair.within = TIED_FACES * larger(place, larger(*pair.a->extent, *pair.b->extent));
    Contact nearest = {.point = count > 1 ? s->corners[p] : 0, .tie = OWN};
    if (!nearest_of_solids(&pair, &nearest))
        return 0;
    if (count == 1) {
        put(s, s->start[p], &nearest);
        return 1;
    }
    int64_t found = every_candidate(&pair, &nearest, count, s->candidates);
    if (!found)
        return 0;
    rank_late(s->candidates, found, s->k[p], s->late);
    int64_t kept = found < s->k[p] ? found : s->k[p];
    if (kept > count)
        return 0;
    for (int64_t i = 0; i < found; i++)
        s->order[i] = i;
    sort(s->candidates, s->late, found, s->order);
    sort(s->candidates, 0, kept, s->order);
    for (int64_t i = 0; i < kept; i++)
        put(s, s->start[p] + i, s->candidates + s->order[i]);
    double beyond = larger(FILLED, 2 * nearest.phi);
    for (int64_t i = kept; i < count; i++) {
        nearest.phi = beyond;
        nearest.point = s->corners[p] + 1 + i - kept;
        put(s, s->start[p] + i, &nearest);
    }
    return 1;
}

/* The closest points of all pairs; 0 where Python has to measure some. */
int closest_points(Pairs *s)
{
    int all = 1;
    for (int64_t p = 0; p < s->pairs; p++) {
        s->decided[p] = s->cloud[p] ? closest_of_cloud(s, p) : s->a[p] && closest_of_pair(s, p);
        all &= s->decided[p] != 0;
    }
    return all;
}
