/* contact/crossings.edge_crossings of boxes, meshes and lines of capsules, with test_solids.py. */

#include "solids.h"

enum { CURVES_OF_ROUND = 3 };

typedef struct {
    int64_t count, total, number[EDGES];
    double tail[3 * EDGES], way[3 * EDGES];
} Edges;

static void add(Edges *edges, int64_t number, const double *pose, const double *tail, const double *head)
{
    double *from = edges->tail + 3 * edges->count, to[3];
    carried(pose, tail, from);
    carried(pose, head, to);
    difference(to, from, edges->way + 3 * edges->count);
    edges->number[edges->count++] = number;
}

/* `line`: on the side of a capsule that faces a way. */
static void line(const Solid *capsule, const double *pose, const double *way, Edges *edges)
{
    double half = capsule->size[2], radius = capsule->size[3], radial = planar_norm(way);
    double tail[3] = {0.0, 0.0, -half}, head[3] = {0.0, 0.0, half};
    edges->total = CURVES_OF_ROUND;
    if (2 * half * radial < TURNED * (2 * half))
        return;
    for (int i = 0; i < 2; i++) {
        tail[i] = radius * (way[i] / radial);
        head[i] = tail[i] + 0.0; /* zero is 0.0, never -0.0 */
    }
    add(edges, 0, pose, tail, head);
}

/* `_of_polytope`: of faces that hold x and face a way; and those that hold x and are as level. */
static void of_polytope(const Solid *solid, const double *pose, const double *x, const double *way, Edges *edges)
{
    int on[TRIANGLES], facing[TRIANGLES];
    edges->total = solid->edges;
    for (int64_t f = 0; f < solid->faces; f++) {
        const double *n = solid->normals + 3 * f;
        on[f] = dot(n, x) >= solid->offsets[f] - OVER_FACE * *solid->extent;
        facing[f] = on[f] && dot(n, way) >= TURNED;
    }
    for (int64_t e = 0; e < solid->edges; e++) {
        const double *tail = solid->vertices + 3 * solid->ends[2 * e];
        const double *head = solid->vertices + 3 * solid->ends[2 * e + 1];
        int64_t one = solid->sides[2 * e], other = solid->sides[2 * e + 1];
        double along[3];
        difference(head, tail, along);
        int level = on[one] && on[other] && fabs(dot(along, way)) <= LEVEL * norm(along);
        if (facing[one] || facing[other] || level)
            add(edges, e, pose, tail, head);
    }
}

/* `edges`: those that may bear, in the world; n is out of the body. */
static void of_body(const Solid *solid, const double *pose, const double *tip, const double *n, Edges *edges)
{
    double way[3], apart[3], x[3];
    edges->count = 0;
    turned_back(pose, n, way);
    from_origin(pose, tip, apart);
    turned_back(pose, apart, x);
    if (solid->kind == CAPSULE)
        line(solid, pose, way, edges);
    else
        of_polytope(solid, pose, x, way, edges);
}

static double triple(const double *a, const double *b, const double *n)
{
    double product[3];
    cross(a, b, product);
    return dot(product, n);
}

/* All crossings, with the pair's normal; their number, -1 where it is too large. The first would have the
   number `first`. */
int64_t crossings(const Pair *pair, const Contact *nearest, int64_t first, Contact *found)
{
    Edges on_a, on_b;
    int64_t count = 0;
    const double *n = nearest->n;
    double back[3], w[3], apart[3];
    if (!(pair->a->faces && pair->b->faces))
        return 0;
    negated(n, back);
    of_body(pair->a, pair->at_a, nearest->alpha, n, &on_a);
    of_body(pair->b, pair->at_b, nearest->beta, back, &on_b);
    for (int64_t i = 0; i < on_a.count; i++)
        for (int64_t j = 0; j < on_b.count; j++) {
            const double *tail = on_a.tail + 3 * i, *u = on_a.way + 3 * i;
            const double *start = on_b.tail + 3 * j, *v = on_b.way + 3 * j;
            double steep = triple(u, v, n);
            if (!(fabs(steep) > SKEW * norm(u) * norm(v)))
                continue;
            difference(start, tail, w);
            double s = triple(w, v, n) / steep, t = triple(w, u, n) / steep;
            if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1))
                continue;
            if (count == LARGEST)
                return -1;
            Contact *c = found + count++;
            *c = *nearest;
            moved_by(tail, s, u, c->alpha);
            moved_by(start, t, v, c->beta);
            difference(c->beta, c->alpha, apart);
            c->phi = dot(apart, n);
            c->point = first + 2 * (on_a.number[i] * on_b.total + on_b.number[j]);
        }
    return count;
}
