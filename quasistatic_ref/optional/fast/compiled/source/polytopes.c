/* contact/solids/polytope_pair.polytope_pair of boxes, capsules and meshes, with test_solids.py. */

#include "solids.h"

/* Gaps along the normals of all faces of the Minkowski difference. */
typedef struct {
    int count, either_zero; /* whether a gap may be a zero of either sign */
    double gap[2 * TRIANGLES + LARGEST], normal[3 * (2 * TRIANGLES + LARGEST)];
} Gaps;

typedef struct {
    const double *tail;
    double way[3], middle[3], reach;
} Edge;

/* Two edges, or a corner and a face: how far apart, and the closest points. */
typedef struct {
    double distance, on_a[3], on_b[3], miss;
} Feature;

/* What a solid in another frame is written into. */
typedef struct {
    double vertices[3 * CORNERS], normals[3 * TRIANGLES], offsets[TRIANGLES];
} Workspace;

static Solid moved(const Solid *b, const double *pose, Workspace *workspace)
{
    Solid there = *b;
    double t[3] = {pose[3], pose[7], pose[11]};
    for (int64_t i = 0; i < b->corners; i++)
        carried(pose, b->vertices + 3 * i, workspace->vertices + 3 * i);
    for (int64_t f = 0; f < b->faces; f++) {
        turned(pose, b->normals + 3 * f, workspace->normals + 3 * f);
        workspace->offsets[f] = b->offsets[f] + dot(workspace->normals + 3 * f, t);
    }
    there.vertices = workspace->vertices;
    there.normals = workspace->normals;
    there.offsets = workspace->offsets;
    return there;
}

/* From the tail of an edge to its head. */
static const double *edge(const Solid *solid, int64_t e, double *way)
{
    const double *tail = solid->vertices + 3 * solid->ends[2 * e];
    difference(solid->vertices + 3 * solid->ends[2 * e + 1], tail, way);
    return tail;
}

static void along_faces(const Solid *a, const Solid *b, double side, Gaps *gaps)
{
    for (int64_t f = 0; f < a->faces; f++) {
        const double *n = a->normals + 3 * f;
        double least = INFINITY;
        for (int64_t i = 0; i < b->corners; i++)
            least = smaller(dot(n, b->vertices + 3 * i), least);
        gaps->gap[gaps->count] = least - a->offsets[f];
        gaps->either_zero |= least == 0.0 && a->offsets[f] == 0.0; /* the least of zeros has either sign */
        for (int i = 0; i < 3; i++)
            gaps->normal[3 * gaps->count + i] = side > 0 ? n[i] : -n[i];
        gaps->count++;
    }
}

/* The common normal, from a to b, of two edges whose arcs cross, and the gap along it. */
static void common_normal(const Solid *a, const Solid *b, int64_t i, int64_t j, Gaps *gaps)
{
    double u[3], v[3], n[3], middle_a[3], middle_b[3], apart[3];
    const double *tail_a = edge(a, i, u), *tail_b = edge(b, j, v);
    cross(u, v, n);
    double length = norm(n);
    if (!(length > ON_SURFACE * sqrt(dot(u, u) * dot(v, v))))
        return;
    for (int k = 0; k < 3; k++) {
        n[k] = n[k] / length;
        middle_a[k] = a->normals[3 * a->sides[2 * i] + k] + a->normals[3 * a->sides[2 * i + 1] + k];
        middle_b[k] = -(b->normals[3 * b->sides[2 * j] + k] + b->normals[3 * b->sides[2 * j + 1] + k]);
    }
    double side_a = dot(n, middle_a);
    if (!(side_a * dot(n, middle_b) > 0))
        return;
    for (int k = 0; k < 3; k++)
        n[k] = n[k] * (side_a > 0 ? 1.0 : -1.0);
    difference(tail_b, tail_a, apart);
    gaps->gap[gaps->count] = dot(n, apart);
    copied(n, gaps->normal + 3 * gaps->count++);
}

/* Whether the normals on both sides of an edge lie on different sides of a plane with the normal `way`. */
static int crosses(const Solid *solid, int64_t e, const double *way)
{
    const int64_t *sides = solid->sides + 2 * e;
    return dot(way, solid->normals + 3 * sides[0]) * dot(way, solid->normals + 3 * sides[1]) < 0;
}

/* 0 where they are too many. */
static int crossing_edges(const Solid *a, const Solid *b, Gaps *gaps)
{
    int most = gaps->count + LARGEST;
    for (int64_t i = 0; i < a->edges; i++)
        for (int64_t j = 0; j < b->edges; j++) {
            double u[3], v[3];
            edge(a, i, u);
            edge(b, j, v);
            if (!(crosses(b, j, u) && crosses(a, i, v)))
                continue;
            if (gaps->count == most)
                return 0;
            common_normal(a, b, i, j, gaps);
        }
    return 1;
}

static void nearest_on_segments(const double *p, const double *u, const double *q, const double *v, double *s, double *r)
{
    double w[3], across[3], v_w[3];
    difference(p, q, w);
    cross(u, v, across);
    cross(v, w, v_w);
    double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
    double det = dot(across, across);
    int parallel = det <= ON_SURFACE_SQUARED * uu * vv;
    *s = limited(parallel ? 0.0 : dot(v_w, across) / det);
    *r = limited((uv * *s + vw) / vv);
    *s = limited((uv * *r - uw) / uu);
}

/* The corner, of some in a core's frame, that is nearest to it: its distance, and the normal there. */
static int64_t nearest_corner(const Solid *core, const double *corners, int64_t count, double *distance, double *normal)
{
    int64_t best = -1;
    for (int64_t i = 0; i < count; i++) {
        const double *x = corners + 3 * i;
        double own[3], phi = core->kind == MESH ? hull_distance(core, x, own) : rounded_box(core->size, 0.0, x, own);
        if (best >= 0 && !(phi < *distance))
            continue;
        best = i;
        *distance = phi;
        copied(own, normal);
    }
    return best;
}

/* Of a corner of b, which is `there` in a's frame, and of a corner of a. */
static void corners_on_faces(const Solid *a, const Solid *b, const Solid *there, const double *pose, Feature *of_b, Feature *of_a)
{
    double own[3], normal[3], apart[3], x[3 * CORNERS];
    int64_t i = nearest_corner(a, there->vertices, b->corners, &of_b->distance, normal);
    copied(there->vertices + 3 * i, of_b->on_b);
    moved_by(there->vertices + 3 * i, -of_b->distance, normal, of_b->on_a);
    for (int64_t j = 0; j < a->corners; j++) {
        from_origin(pose, a->vertices + 3 * j, apart);
        turned_back(pose, apart, x + 3 * j);
    }
    i = nearest_corner(b, x, a->corners, &of_a->distance, own);
    turned(pose, own, normal);
    copied(a->vertices + 3 * i, of_a->on_a);
    moved_by(a->vertices + 3 * i, -of_a->distance, normal, of_a->on_b);
}

static void edges_of(const Solid *solid, Edge *edges)
{
    for (int64_t e = 0; e < solid->edges; e++) {
        Edge *own = edges + e;
        own->tail = edge(solid, e, own->way);
        for (int k = 0; k < 3; k++)
            own->middle[k] = own->tail[k] + own->way[k] / 2;
        own->reach = norm(own->way) / 2;
    }
}

/* Of the edges whose surrounding balls come within a bound, those at most so far apart; their number, -1
   where it is too large. */
static int of_edges(const Solid *a, const Solid *b, double bound, double at_most, Feature *found)
{
    Edge on_a[EDGES], on_b[EDGES];
    int count = 0;
    edges_of(a, on_a);
    edges_of(b, on_b);
    for (const Edge *i = on_a; i < on_a + a->edges; i++)
        for (const Edge *j = on_b; j < on_b + b->edges; j++) {
            double apart[3], s, r, near = i->reach + j->reach + bound;
            Feature *own = found + count;
            difference(i->middle, j->middle, apart);
            if (!(dot(apart, apart) <= near * near))
                continue;
            if (count == LARGEST)
                return -1;
            nearest_on_segments(i->tail, i->way, j->tail, j->way, &s, &r);
            moved_by(i->tail, s, i->way, own->on_a);
            moved_by(j->tail, r, j->way, own->on_b);
            difference(own->on_b, own->on_a, apart);
            own->distance = norm(apart);
            count += own->distance <= at_most;
        }
    return count;
}

/* `_nearest`: closest points of two cores that are apart or touch, and how far they miss a way; 0 where too
   many edges are as near. */
static int nearest_feature(const Solid *a, const Solid *b, const double *pose, const double *way, double size, Feature *nearest)
{
    Workspace workspace;
    Feature every[2 + LARGEST];
    Solid there = moved(b, pose, &workspace);
    corners_on_faces(a, b, &there, pose, every, every + 1);
    double least = smaller(every[0].distance, every[1].distance), apart[3], off[3];
    double rounding = OUTSIDE_FACE * size;
    int count = of_edges(a, &there, larger(least, 0.0), least + rounding, every + 2), best = 0, other = -1;
    if (count < 0)
        return 0;
    count += 2;
    for (int i = 0; i < count; i++) {
        difference(every[i].on_b, every[i].on_a, apart);
        difference(apart, way, off);
        every[i].miss = norm(off);
        if (every[i].distance < every[best].distance)
            best = i;
    }
    for (int i = count - 1; i >= 0; i--)
        if (every[i].distance <= every[best].distance + rounding && every[i].miss <= rounding)
            other = i;
    *nearest = every[every[best].miss <= rounding || other < 0 ? best : other];
    return 1;
}

static double size_of(const double *numbers, int64_t count, double least)
{
    for (int64_t i = 0; i < count; i++)
        least = larger(fabs(numbers[i]), least);
    return least;
}

static void with_margins(const Pair *pair, double gap, const double *on_a, const double *n, Contact *found)
{
    double margin_a = pair->a->size[3], margin_b = pair->b->size[3];
    double alpha[3], beta[3], on_b[3];
    moved_by(on_a, gap, n, on_b);
    moved_by(on_a, margin_a, n, alpha);
    moved_by(on_b, -margin_b, n, beta);
    found->phi = gap - margin_a - margin_b;
    turned(pair->at_a, n, found->n);
    carried(pair->at_a, alpha, found->alpha);
    carried(pair->at_a, beta, found->beta);
}

/* `_capsule_pair`; 0 where the axes meet. */
static int capsules(const Pair *pair, const double *pose, Contact *nearest)
{
    Workspace workspace;
    const Solid *a = pair->a, b = moved(pair->b, pose, &workspace);
    double u[3], v[3], s, r, on_a[3], on_b[3], n[3], across[3];
    const double *p = edge(a, 0, u), *q = edge(&b, 0, v);
    nearest_on_segments(p, u, q, v, &s, &r);
    moved_by(p, s, u, on_a);
    moved_by(q, r, v, on_b);
    difference(on_b, on_a, n);
    double gap = norm(n), size = size_of(b.vertices, 6, size_of(a->vertices, 6, 0.0));
    cross(u, v, across);
    double steepness = sqrt(dot(across, across) / (dot(u, u) * dot(v, v)));
    if (gap <= ON_SURFACE * size)
        return 0;
    if (0 < s && s < 1 && 0 < r && r < 1 && steepness * size > gap) {
        double side = dot(across, n) >= 0 ? 1.0 : -1.0, apart[3];
        copied(n, apart);
        for (int i = 0; i < 3; i++)
            n[i] = across[i] * side;
        gap = dot(n, apart) / norm(n);
    }
    double length = norm(n);
    for (int i = 0; i < 3; i++)
        n[i] = n[i] / length;
    with_margins(pair, gap, on_a, n, nearest);
    double radii = a->size[3] + b.size[3];
    return !(-nearest->phi - 2 * radii >= nearest->phi - pair->within);
}

int polytopes(const Pair *pair, Contact *nearest)
{
    const Solid *a = pair->a, *b = pair->b;
    double pose[12], n[3], none[3] = {0.0, 0.0, 0.0}, way[3], between[3];
    relative(pair->at_a, pair->at_b, pose);
    if (a->kind == CAPSULE && b->kind == CAPSULE)
        return capsules(pair, pose, nearest);
    Workspace workspace;
    Gaps gaps = {.count = 0};
    Solid there = moved(b, pose, &workspace);
    along_faces(a, &there, 1.0, &gaps);
    along_faces(&there, a, -1.0, &gaps);
    if (!crossing_edges(a, &there, &gaps))
        return 0;
    int best = 0;
    for (int i = 1; i < gaps.count; i++)
        if (gaps.gap[i] > gaps.gap[best])
            best = i;
    double gap = gaps.gap[best], t[3] = {pose[3], pose[7], pose[11]};
    double size = size_of(t, 3, size_of(b->vertices, 3 * b->corners, size_of(a->vertices, 3 * a->corners, 0.0)));
    for (int i = 0; i < 3; i++) {
        n[i] = gaps.normal[3 * best + i];
        way[i] = gap * n[i];
    }
    if (gap == 0.0 && gaps.either_zero)
        return 0;
    Feature touching;
    if (gap > 0) {
        if (!nearest_feature(a, b, pose, way, size, &touching))
            return 0;
        difference(touching.on_b, touching.on_a, between);
        double distance = norm(between);
        if (touching.miss > OUTSIDE_FACE * size && distance > ON_SURFACE * size) {
            gap = distance;
            for (int i = 0; i < 3; i++)
                n[i] = between[i] / distance;
        }
    } else {
        for (int i = 0; i < 3; i++)
            pose[4 * i + 3] -= way[i];
        if (!nearest_feature(a, b, pose, none, size, &touching))
            return 0;
    }
    with_margins(pair, gap, touching.on_a, n, nearest);
    if (gap > pair->within)
        return 1;
    for (int i = 0; i < gaps.count; i++) {
        gaps.gap[i] = gaps.gap[i] - a->size[3] - b->size[3];
        copied(gaps.normal + 3 * i, way);
        turned(pair->at_a, way, gaps.normal + 3 * i);
    }
    return one_normal(pair, nearest, gaps.gap, gaps.normal, gaps.count);
}
