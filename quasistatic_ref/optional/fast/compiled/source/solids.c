/* Closest points of pairs of solids: the ordinary case of contact/distance.

   Where a normal is one of several, or bodies are too far away for float64, a pair is not decided
   here, and Python measures it. */

#include "solids.h"

int64_t solid_size(void) { return sizeof(Solid); }
int64_t solid_pairs_size(void) { return sizeof(SolidPairs); }

Contact swapped(const Contact *contact)
{
    Contact other = *contact;
    for (int i = 0; i < 3; i++) {
        other.alpha[i] = contact->beta[i];
        other.beta[i] = contact->alpha[i];
        other.n[i] = -contact->n[i];
    }
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
        for (int i = 0; i < 3; i++)
            out[i] = solid->vertices[3 * best + i];
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

/* Heights of a sphere's centre over the faces of a solid, less the radius, and their normals in the
   world, times a sign: contact/separations. */
static int over_faces(const Solid *solid, const double *at, const double *x, double ball, double side, double *gap, double *normals)
{
    const double *size = solid->size;
    double own[9] = {0};
    if (solid->kind == CYLINDER) {
        double r = planar_norm(x);
        gap[0] = r - size[0], gap[1] = x[2] - size[1], gap[2] = -x[2] - size[1];
        own[0] = r == 0.0 ? 1.0 : x[0] / r;
        own[1] = r == 0.0 ? 0.0 : x[1] / r;
        own[5] = 1.0, own[8] = -1.0;
    }
    int count = solid->kind == BOX ? FACES_OF_BOX : solid->kind == CYLINDER ? 3 : 0;
    for (int f = 0; f < count; f++) {
        if (solid->kind == BOX)
            gap[f] = (f < 3 ? x[f] : -x[f - 3]) - size[f % 3];
        gap[f] -= ball;
        turned(at, solid->kind == BOX ? solid->normals + 3 * f : own + 3 * f, normals + 3 * f);
        for (int i = 0; i < 3; i++)
            normals[3 * f + i] *= side;
    }
    return count;
}

/* contact/solids/solid_pair; `side` is that of the normal in the contact's. */
static int sphere_on_solid(const Pair *pair, double side, Contact *nearest)
{
    const Solid *solid = side > 0 ? pair->a : pair->b, *sphere = side > 0 ? pair->b : pair->a;
    const double *at = side > 0 ? pair->at_a : pair->at_b, *pose = side > 0 ? pair->at_b : pair->at_a;
    double centre[3] = {pose[3], pose[7], pose[11]}, above[3], x[3], normal[3];
    double gap[FACES_OF_BOX], normals[3 * FACES_OF_BOX], radius = sphere->size[3];
    from_origin(at, centre, above);
    turned_back(at, above, x);
    double phi = signed_distance(solid, x, normal);
    turned(at, normal, nearest->n);
    nearest->phi = phi - radius;
    moved_by(centre, -phi, nearest->n, nearest->alpha);
    moved_by(centre, -radius, nearest->n, nearest->beta);
    if (side < 0)
        *nearest = swapped(nearest);
    if (solid->kind == HALF_SPACE || nearest->phi > pair->within)
        return 1;
    int count = over_faces(solid, at, x, radius, side, gap, normals);
    return one_normal(pair, nearest, gap, normals, count);
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

/* contact/distance, `closest`: the least distances in ascending order, ties by index; late ones last. */
static int64_t least(const Contact *every, const int64_t *late, int64_t count, int64_t kept, int64_t *order)
{
    int64_t held = 0;
    for (int64_t i = 0; i < count; i++) {
        double phi = late[i] ? INFINITY : every[i].phi;
        int64_t j = held < kept ? held++ : kept;
        for (; j > 0; j--) {
            int64_t other = order[j - 1];
            if (!(phi < (late[other] ? INFINITY : every[other].phi)))
                break;
            if (j < kept)
                order[j] = other;
        }
        if (j < kept)
            order[j] = i;
    }
    return held;
}

/* The same in ascending distance, late or not; ties stay in their order. */
static void by_phi(const Contact *every, int64_t count, int64_t *order)
{
    for (int64_t i = 1; i < count; i++) {
        int64_t own = order[i], j = i;
        for (; j > 0 && every[own].phi < every[order[j - 1]].phi; j--)
            order[j] = order[j - 1];
        order[j] = own;
    }
}

static void write(SolidPairs *s, int64_t c, const Contact *contact)
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

/* contact/distance: pair_closest_points. */
static int closest_of_pair(SolidPairs *s, int64_t p)
{
    Pair pair = {.a = s->a[p], .b = s->b[p]};
    int64_t link_a = s->link_a[p], link_b = s->link_b[p], count = s->count[p];
    double place = 0.0;
    placed(s->R[link_a], s->t[link_a], s->on_a + 12 * p, pair.at_a);
    placed(s->R[link_b], s->t[link_b], s->on_b + 12 * p, pair.at_b);
    if (!(usual(pair.at_a, &place) & usual(pair.at_b, &place)))
        return 0;
    pair.within = TIED_FACES * larger(place, larger(*pair.a->extent, *pair.b->extent));
    Contact nearest = {.point = count > 1 ? s->corners[p] : 0, .tie = OWN};
    if (!nearest_of_solids(&pair, &nearest))
        return 0;
    if (count == 1) {
        write(s, s->start[p], &nearest);
        return 1;
    }
    int64_t found = every_candidate(&pair, &nearest, count, s->candidates);
    rank_late(s->candidates, found, s->k[p], s->late);
    int64_t kept = least(s->candidates, s->late, found, s->k[p], s->order);
    if (kept > count)
        return 0;
    by_phi(s->candidates, kept, s->order);
    for (int64_t i = 0; i < kept; i++)
        write(s, s->start[p] + i, s->candidates + s->order[i]);
    for (int64_t i = kept; i < count; i++) {
        nearest.phi = FILLED;
        nearest.point = s->corners[p] + 1 + i - kept;
        write(s, s->start[p] + i, &nearest);
    }
    return 1;
}

/* The closest points of all pairs; 0 where Python has to measure some. */
int solid_pairs(SolidPairs *s)
{
    int all = 1;
    for (int64_t p = 0; p < s->pairs; p++) {
        s->decided[p] = s->a[p] && closest_of_pair(s, p);
        all &= s->decided[p] != 0 || !s->a[p];
    }
    return all;
}
