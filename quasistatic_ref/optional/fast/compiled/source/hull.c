/* shapes/hull.distance_to_hull, with test_fast_pairs.py. */

#include "solid.h"

/* `nearest_offsets`: from the nearest point of the surface to a point outside. */
static void nearest_offset(const Solid *mesh, const double *x, double *offset)
{
    double best = INFINITY, arm[3], away[3], foot = INFINITY;
    int is_above = 0;
    for (const Triangle *t = mesh->surface; t < mesh->surface + mesh->triangles; t++) {
        int within = 1;
        for (int k = 0; k < 3 && within; k++) {
            difference(x, t->corners[k], arm);
            within = dot(arm, t->inward[k]) >= 0;
        }
        if (!within)
            continue;
        difference(x, t->corners[0], arm);
        double level = dot(arm, t->normal), square = level * level;
        int above = level > 0;
        if (above < is_above || (above == is_above && !(square < foot)))
            continue;
        is_above = above;
        foot = square;
        for (int i = 0; i < 3; i++)
            offset[i] = level * t->normal[i];
    }
    if (is_above)
        return; /* nearer edges are rounding */
    for (int k = 0; k < 3; k++)
        for (const Triangle *t = mesh->surface; t < mesh->surface + mesh->triangles; t++) {
            difference(x, t->corners[k], arm);
            moved_by(arm, -limited(dot(arm, t->ways[k]) / t->squares[k]), t->ways[k], away);
            double square = dot(away, away);
            if (!(square < best))
                continue;
            best = square;
            if (!(foot < best))
                copied(away, offset);
        }
}

/* `distance_to_hull`, and the normal where one is asked for. */
double hull_distance(const Solid *mesh, const double *x, double *normal)
{
    const Triangle *face = mesh->surface;
    double phi = height(face, x), away[3], sideways[3];
    for (const Triangle *t = face + 1; t < mesh->surface + mesh->triangles; t++)
        if (height(t, x) > phi) {
            face = t;
            phi = height(t, x);
        }
    if (normal)
        copied(face->normal, normal);
    if (!(phi > 0))
        return phi;
    nearest_offset(mesh, x, away);
    double distance = norm(away), size = mesh->size[0];
    moved_by(away, -phi, face->normal, sideways);
    if (!(norm(sideways) > OUTSIDE_FACE * size && distance > ON_SURFACE * size))
        return phi;
    for (int i = 0; normal && i < 3; i++)
        normal[i] = away[i] / distance;
    return distance;
}
