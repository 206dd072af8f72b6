/* A step's data from the poses of the links: closest points, Eqs. (2)-(8).

   Each function does what a Python function of the same task does, in the same order of operations,
   so that the bits are the same; the comments name it. Products of matrices, which Python leaves to
   BLAS, are sums from zero over rising indices: with one rounding for each product and sum
   (-DFUSED), or with two. products.py finds out which of them NumPy has. */

#include <float.h>
#include <math.h>
#include <stdint.h>

#if FLT_EVAL_METHOD != 0
#error "float64 operations must be rounded to float64"
#endif

#ifdef FUSED
#define ADDED(x, y, sum) fma(x, y, sum)
#else
#define ADDED(x, y, sum) ((sum) + (x) * (y))
#endif

enum { ROUNDED_BOX, HALF_SPACE, CYLINDER };

/* One for one the fields of Scene in scene.py. */
typedef struct {
    int64_t pairs, n_c, n_v, n_x, links, mimics;
    /* Poses of the links: R by columns, as pinocchio keeps it; columns of the Jacobian. */
    const double *const *R, *const *t, *const *column;
    /* Of each pair: the two shapes' links and places on them (3 x 4), solid first. */
    const int64_t *link_solid, *link_cloud;
    const double *on_solid, *on_cloud;
    /* The solid: its kind, and numbers that belong to the kind. */
    const int64_t *kind;
    const double *size; /* 4 of each: half extents and ball; normal and offset; radius, half length */
    const double *sign; /* of the solid's normal in the contact's */
    /* The short list: points x, y, z apart, their numbers, and the bounds of all others. */
    const int64_t *first, *length, *index;
    const double *x, *y, *z;
    const int64_t *bounds;
    const double *slope, *offset;
    /* Where the contacts of the pair go, and how many. */
    const int64_t *start, *count;
    /* Of each column: the coordinate that it belongs to. */
    const int64_t *owner;
    /* Of each contact: which columns move its bodies, friction, number of rows. */
    const double *moves_alpha, *moves_beta, *mu_v, *mu_omega;
    const int64_t *rows;
    /* The cone: coefficients of slip_1, slip_2, spin in each row, and which of them it has. */
    const double *coefficient;
    const int64_t *has;
    /* Written at each step. */
    double *world, *nearest; /* 24 for each pair; as many as the largest count */
    int64_t *rank, *point;
    double *phi, *n, *alpha, *beta, *d1, *d2, *J, *A, *b;
    double *work; /* 14 n_x + 4 n_v */
} Scene;

int64_t scene_size(void) { return sizeof(Scene); }

/* model/poses: R @ on_link, then + t. */
static void placed(const double *R, const double *t, const double *on_link, double *world)
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++)
                sum = ADDED(R[i + 3 * k], on_link[4 * k + j], sum);
            world[4 * i + j] = sum;
        }
        world[4 * i + 3] += t[i];
    }
}

/* contact/poses: R_solid' @ [R_cloud, t_cloud - t_solid]. */
static void relative(const double *solid, const double *cloud, double *pose)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++) {
                double at = cloud[4 * k + j] - (j == 3 ? solid[4 * k + 3] : 0.0);
                sum = ADDED(solid[4 * k + i], at, sum);
            }
            pose[4 * i + j] = sum;
        }
}

static inline double larger(double a, double b) { return a > b ? a : b; }

static inline double along(const double *row, double x, double y, double z)
{
    return (row[0] * x + row[1] * y) + row[2] * z;
}

/* The same by np.add.reduce, which starts from zero: it never gives -0.0. */
static inline double turned(const double *row, double x, double y, double z)
{
    return ((0.0 + row[0] * x) + row[1] * y) + row[2] * z;
}

/* contact/cloud: signed_distance, and its normal where one is asked for. */
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
    double outside = hypot(beyond_side, beyond_end);
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

/* contact/batch: below which signed distances no point outside the list can have come. Its rounding
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
        at[i] = turned(pose + 4 * i, x, y, z) + pose[4 * i + 3];
}

/* contact/batch: the `count` least distances in ascending order, ties by index; 0 if one is NaN. */
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

/* contact/cloud_tracker: the points and normal of one contact in the world. */
static void witness(const Scene *s, int64_t pair, const double *pose, int64_t c, int64_t p)
{
    const double *solid = s->world + 24 * pair, *cloud = solid + 12;
    double at[3], normal[3];
    in_solid(pose, s->x[p], s->y[p], s->z[p], at);
    s->phi[c] = distance(s->kind[pair], s->size + 4 * pair, at, normal);
    s->point[c] = s->index[p];
    for (int i = 0; i < 3; i++) {
        double n = turned(solid + 4 * i, normal[0], normal[1], normal[2]);
        double centre = turned(cloud + 4 * i, s->x[p], s->y[p], s->z[p]) + cloud[4 * i + 3];
        double foot = centre - s->phi[c] * n;
        int swapped = s->sign[pair] < 0.0;
        s->n[3 * c + i] = s->sign[pair] * n;
        s->alpha[3 * c + i] = swapped ? centre : foot;
        s->beta[3 * c + i] = swapped ? foot : centre;
    }
}

/* The closest points of all pairs; 0 where the lists do not prove them. */
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
            witness(s, pair, pose, s->start[pair] + j, s->rank[j]);
    }
    return 1;
}

/* contact/jacobian: tangents. */
static void tangents(const double *n, double *d1, double *d2)
{
    int axis = fabs(n[1]) < fabs(n[0]) ? 1 : 0;
    if (fabs(n[2]) < fabs(n[axis]))
        axis = 2;
    double length = sqrt(1 - n[axis] * n[axis]);
    for (int i = 0; i < 3; i++)
        d1[i] = ((i == axis ? 1.0 : 0.0) - n[axis] * n[i]) / length;
    int next = (axis + 1) % 3, last = (axis + 2) % 3;
    d2[axis] = 0.0 / length; /* n x axis */
    d2[next] = (n[last] + 0.0) / length;
    d2[last] = (0.0 - n[next]) / length;
}

/* contact/jacobian: [nu; n'omega] of a body that all columns move, at the point r. */
static void columns_at(const double *col, int64_t n_x, const double *r, const double *n, double *out)
{
    const double *w = col + 3 * n_x;
    for (int64_t x = 0; x < n_x; x++) {
        double w0 = w[x], w1 = w[n_x + x], w2 = w[2 * n_x + x];
        out[x] = ADDED(-r[1], w2, ADDED(r[2], w1, col[x] + 0.0));
        out[n_x + x] = ADDED(r[0], w2, ADDED(-r[2], w0, col[n_x + x] + 0.0));
        out[2 * n_x + x] = ADDED(-r[0], w1, ADDED(r[1], w0, col[2 * n_x + x] + 0.0));
        out[3 * n_x + x] = ADDED(n[2], w2, ADDED(n[1], w1, ADDED(n[0], w0, 0.0)));
    }
}

/* contact/jacobian: J of one contact. Columns that mimic others are added to theirs. */
static void jacobian(const Scene *s, const double *col, int64_t c, double *own, double *J)
{
    int64_t n_x = s->n_x, n_v = s->n_v;
    double *of_alpha = own, *of_beta = own + 4 * n_x;
    columns_at(col, n_x, s->alpha + 3 * c, s->n + 3 * c, of_alpha);
    columns_at(col, n_x, s->beta + 3 * c, s->n + 3 * c, of_beta);
    for (int64_t i = 0; s->mimics && i < 4 * n_v; i++)
        J[i] = 0.0;
    for (int i = 0; i < 4; i++) /* Eqs. (2)-(3) */
        for (int64_t x = 0; x < n_x; x++) {
            double f = s->moves_beta[c * n_x + x] * of_beta[i * n_x + x]
                     - s->moves_alpha[c * n_x + x] * of_alpha[i * n_x + x];
            double *entry = J + i * n_v + s->owner[x];
            *entry = s->mimics ? *entry + f : f;
        }
}

/* step/friction: frame_jacobian of one axis, times a coefficient of friction. */
static void motion_along(const double *axis, const double *J, int64_t n_v, double mu, double *out)
{
    for (int64_t v = 0; v < n_v; v++)
        out[v] = mu * ((axis[0] * J[v] + axis[1] * J[n_v + v]) + axis[2] * J[2 * n_v + v]);
}

/* The tangents, J, A and b of all contacts from their closest points. */
void contact_rows(Scene *s)
{
    int64_t n_v = s->n_v, n_x = s->n_x, row = 0;
    double *col = s->work, *own = col + 6 * n_x, *motion = own + 8 * n_x;
    for (int64_t x = 0; x < n_x; x++)
        for (int i = 0; i < 6; i++)
            col[i * n_x + x] = s->column[x][i];
    for (int64_t c = 0; c < s->n_c; c++) {
        double *d1 = s->d1 + 3 * c, *d2 = s->d2 + 3 * c, *J = s->J + 4 * n_v * c;
        tangents(s->n + 3 * c, d1, d2);
        jacobian(s, col, c, own, J);
        motion_along(s->n + 3 * c, J, n_v, 1.0, motion);
        motion_along(d1, J, n_v, s->mu_v[c], motion + n_v);
        motion_along(d2, J, n_v, s->mu_v[c], motion + 2 * n_v);
        for (int64_t v = 0; v < n_v; v++)
            motion[3 * n_v + v] = s->mu_omega[c] * J[3 * n_v + v];
        for (int64_t i = 0; i < s->rows[c]; i++, row++) { /* Eqs. (4)-(8) */
            double *A = s->A + n_v * row;
            for (int64_t v = 0; v < n_v; v++)
                A[v] = motion[v];
            for (int k = 0; k < 3; k++)
                for (int64_t v = 0; s->has[3 * i + k] && v < n_v; v++)
                    A[v] = A[v] + s->coefficient[3 * i + k] * motion[(k + 1) * n_v + v];
            s->b[row] = -s->phi[c];
        }
    }
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
