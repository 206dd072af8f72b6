/* model/screw: how far a twist carries a base, and which twist carries it so far.

   The lengths of rotation vectors come from Python, whose hypot is its own. */

#include <math.h>
#include <stdint.h>

enum { FLOATING, PLANAR, CONTINUOUS };

/* One for one the fields of Screws in screws.py. */
typedef struct {
    int64_t joints;
    /* Of each joint: its kind, and where its entries of q and of delta_q start. */
    const int64_t *kind, *q_start, *v_start;
    /* Length of each joint's rotation vector [rad]. */
    const double *angle;
    const double *q;
    double *q_next, *delta_q;
} Screws;

int64_t screws_size(void) { return sizeof(Screws); }

/* Sum of v, once w x v and twice e x (e x v), where w = a e. */
static void combined(const double *v, const double *w, double a, double once, double twice, double *out)
{
    double rest = 1 - twice;
    double along = a * a != 0.0 ? twice * ((w[0] * v[0] + w[1] * v[1]) + w[2] * v[2]) / (a * a) : 0.0;
    out[0] = rest * v[0] + once * (w[1] * v[2] - w[2] * v[1]) + along * w[0];
    out[1] = rest * v[1] + once * (w[2] * v[0] - w[0] * v[2]) + along * w[1];
    out[2] = rest * v[2] + once * (w[0] * v[1] - w[1] * v[0]) + along * w[2];
}

static double sinc(double x) { return x != 0.0 ? sin(x) / x : 1.0; }

/* Rows of the rotation matrix of a base, from its entries of q. */
static void rotation(int64_t kind, const double *q, double R[9])
{
    if (kind == PLANAR) {
        double c = q[2], s = q[3];
        double rows[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0};
        for (int i = 0; i < 9; i++)
            R[i] = rows[i];
        return;
    }
    double x = q[3], y = q[4], z = q[5], w = q[6];
    R[0] = 1 - 2 * (y * y + z * z), R[1] = 2 * (x * y - z * w), R[2] = 2 * (x * z + y * w);
    R[3] = 2 * (x * y + z * w), R[4] = 1 - 2 * (x * x + z * z), R[5] = 2 * (y * z - x * w);
    R[6] = 2 * (x * z - y * w), R[7] = 2 * (y * z + x * w), R[8] = 1 - 2 * (x * x + y * y);
}

static double turn(const double *before, const double *after)
{
    return atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
}

/* The rotation vector of a base's entries of delta_q. */
static void angular(int64_t kind, const double *delta_q, double w[3])
{
    for (int i = 0; i < 3; i++)
        w[i] = kind == FLOATING ? delta_q[3 + i] : 0.0;
    if (kind == PLANAR)
        w[2] = delta_q[2];
}

/* Translations of the bases at q (+) delta_q, written into q_next. */
void positions(Screws *s)
{
    for (int64_t joint = 0; joint < s->joints; joint++) {
        int64_t kind = s->kind[joint];
        if (kind == CONTINUOUS)
            continue;
        const double *q = s->q + s->q_start[joint], *delta_q = s->delta_q + s->v_start[joint];
        double v[3] = {delta_q[0], delta_q[1], kind == FLOATING ? delta_q[2] : 0.0};
        double w[3], R[9], x[3], a = s->angle[joint], half = sinc(a / 2);
        angular(kind, delta_q, w);
        combined(v, w, a, half * half / 2, 1 - sinc(a), x);
        rotation(kind, q, R);
        for (int i = 0; i < (kind == FLOATING ? 3 : 2); i++)
            s->q_next[s->q_start[joint] + i]
                = q[i] + ((R[3 * i] * x[0] + R[3 * i + 1] * x[1]) + R[3 * i + 2] * x[2]);
    }
}

/* Entries of q_next (-) q, of which delta_q holds the rotation vectors of floating bases. */
void changes(Screws *s)
{
    for (int64_t joint = 0; joint < s->joints; joint++) {
        int64_t kind = s->kind[joint];
        const double *here = s->q + s->q_start[joint], *there = s->q_next + s->q_start[joint];
        double *delta_q = s->delta_q + s->v_start[joint];
        if (kind == CONTINUOUS) {
            delta_q[0] = turn(here, there);
            continue;
        }
        if (kind == PLANAR)
            delta_q[2] = turn(here + 2, there + 2);
        double apart[3] = {there[0] - here[0], there[1] - here[1], 0.0};
        if (kind == FLOATING)
            apart[2] = there[2] - here[2];
        double w[3], R[9], moved[3], v[3], a = kind == PLANAR ? fabs(delta_q[2]) : s->angle[joint];
        angular(kind, delta_q, w);
        rotation(kind, here, R);
        for (int i = 0; i < 3; i++)
            moved[i] = (R[i] * apart[0] + R[3 + i] * apart[1]) + R[6 + i] * apart[2];
        combined(moved, w, a, -0.5, a != 0.0 ? 1 - a / 2 / tan(a / 2) : 0.0, v);
        for (int i = 0; i < (kind == FLOATING ? 3 : 2); i++)
            delta_q[i] = v[i];
    }
}
