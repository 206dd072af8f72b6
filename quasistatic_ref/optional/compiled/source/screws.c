/* model/system, `integrate` and `actuated_difference`: q (+) delta_q and q_a (-) q, in the order of
   operations of model/screw.

   Sines and angles are correctly rounded: those of long double, where their error leaves no doubt about that, or
   else those of Python. */

#include "vectors.h"

enum { FLOATING, PLANAR, CONTINUOUS, SCALAR };

/* model/screw, `combined`. */
static void combined(const double *v, const double *w, double a, double once, double twice, double *out)
{
    double rest = 1 - twice, along = a * a != 0.0 ? twice * dot(w, v) / (a * a) : 0.0;
    out[0] = rest * v[0] + once * (w[1] * v[2] - w[2] * v[1]) + along * w[0];
    out[1] = rest * v[1] + once * (w[2] * v[0] - w[0] * v[2]) + along * w[1];
    out[2] = rest * v[2] + once * (w[0] * v[1] - w[1] * v[0]) + along * w[2];
}

/* model/screw, `rows`, of a base, from its entries of q. */
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

/* The rotation vector of a base's entries of delta_q. */
static void angular(int64_t kind, const double *delta_q, double w[3])
{
    for (int i = 0; i < 3; i++)
        w[i] = kind == FLOATING ? delta_q[3 + i] : 0.0;
    if (kind == PLANAR)
        w[2] = delta_q[2];
}

/* Of a joint that turns by a: sin(a / 2) / (a / 2). */
static double half_of(const Sums *s, int64_t joint)
{
    double b = s->angle[joint] / 2;
    return b != 0.0 ? s->sine[joint] / b : 1.0;
}

/* model/screw, `turned`. */
static void quaternion(const double *here, const double *w, double C, double half, double *out)
{
    double p = half / 2 * w[0], q = half / 2 * w[1], r = half / 2 * w[2];
    double x = here[0], y = here[1], z = here[2], s = here[3];
    for (int i = 0; i < 4; i++)
        out[i] = here[i];
    if (p == 0.0 && q == 0.0 && r == 0.0)
        return;
    double a = s * p + x * C + y * r - z * q, b = s * q + y * C + z * p - x * r;
    double c = s * r + z * C + x * q - y * p, d = s * C - x * p - y * q - z * r;
    double shorter = (3 - (a * a + b * b + c * c + d * d)) / 2;
    out[0] = shorter * a, out[1] = shorter * b, out[2] = shorter * c, out[3] = shorter * d;
}

/* model/screw, `heading`; C and S are the cosine and the sine of half the angle. */
static void heading(const double *here, double angle, double C, double S, double *out)
{
    double c = here[0], s = here[1], cosine = 1 - 2 * (S * S), sine = 2 * (S * C);
    double x = c * cosine - s * sine, y = s * cosine + c * sine;
    double shorter = (3 - (x * x + y * y)) / 2;
    out[0] = angle == 0.0 ? c : shorter * x;
    out[1] = angle == 0.0 ? s : shorter * y;
}

/* The float64 nearest to a number whose long double is wrong by less than 2^-60 of itself (the sines
   and angles of C libraries, by 2^-62); 0 if that leaves two. */
static int nearest(long double found, double *out)
{
    volatile long double one = 1.0L;
    long double margin = found * 0x1p-60L;
    *out = (double)(found - margin);
    return one + 0x1p-62L != one && *out == (double)(found + margin);
}

/* Cosine and sine of half of a joint's angle; 0, and no cosine, if they are in doubt. */
static int half_turn(Sums *s, int64_t joint)
{
    long double b = s->angle[joint] / 2;
    int sure = nearest(cosl(b), s->cosine + joint) & nearest(sinl(b), s->sine + joint);
    if (!sure)
        s->cosine[joint] = NAN;
    return sure;
}

/* model/screw, `half_turn`: how far each joint turns, with cosine and sine of half of that; 0 if one is in doubt. */
int half_turns(Sums *s)
{
    int sure = 1;
    for (int64_t joint = 0; joint < s->joints; joint++) {
        const double *delta_q = s->delta_q + s->v_start[joint], *w = delta_q + 3;
        if (s->kind[joint] == SCALAR)
            continue;
        s->angle[joint] = s->kind[joint] == FLOATING ? sqrt(dot(w, w))
                                                     : delta_q[s->kind[joint] == PLANAR ? 2 : 0];
        sure &= half_turn(s, joint);
    }
    return sure;
}

/* model/system, `integrate`. */
void sums(const Sums *s)
{
    for (int64_t joint = 0; joint < s->joints; joint++) {
        int64_t kind = s->kind[joint];
        const double *q = s->q + s->q_start[joint], *delta_q = s->delta_q + s->v_start[joint];
        double *there = s->q_next + s->q_start[joint], C = s->cosine[joint], S = s->sine[joint];
        if (kind == SCALAR) {
            there[0] = q[0] + delta_q[0];
            continue;
        }
        if (kind == CONTINUOUS) {
            heading(q, delta_q[0], C, S, there);
            continue;
        }
        double v[3] = {delta_q[0], delta_q[1], kind == FLOATING ? delta_q[2] : 0.0};
        double w[3], R[9], t[3], half = half_of(s, joint);
        angular(kind, delta_q, w);
        combined(v, w, s->angle[joint], half * half / 2, 1 - half * C, t);
        rotation(kind, q, R);
        for (int i = 0; i < (kind == FLOATING ? 3 : 2); i++)
            there[i] = q[i] + dot(R + 3 * i, t);
        if (kind == FLOATING)
            quaternion(q + 3, w, C, half, there + 3);
        else
            heading(q + 2, delta_q[2], C, S, there + 2);
    }
}

/* model/configuration, `UnitParts.check`: whether a part of n numbers surely has length one. */
static int is_unit(const double *part, int n)
{
    double square = 0.0;
    for (int i = 0; i < n; i++)
        square += part[i] * part[i];
    return fabs(square - 1) < 1e-10;
}

/* numbers/angles, `angle_of`; 0 if it is in doubt. A zero has no sign. */
static int angle_of(double y, double x, double *angle)
{
    return nearest(atan2l(y + 0.0, x), angle);
}

/* model/screw, `rotation_between`, whose length is *a; 0 if it is in doubt. */
static int rotation_between(const double *here, const double *there, double *w, double *a, double *c2)
{
    double x = here[0], y = here[1], z = here[2], s = here[3];
    double p = there[0], q = there[1], r = there[2], k = there[3], b;
    double v[3] = {s * p - x * k - y * r + z * q, s * q - y * k - z * p + x * r,
                   s * r - z * k - x * q + y * p};
    double cosine = s * k + x * p + y * q + z * r, S = sqrt(dot(v, v)), C = fabs(cosine);
    int sure = angle_of(S, C, &b);
    double ratio = S != 0.0 ? b / S : 1.0, scale = cosine >= 0 ? 2 * ratio : -2 * ratio;
    for (int i = 0; i < 3; i++)
        w[i] = scale * v[i];
    *a = 2 * b;
    *c2 = S != 0.0 ? 1 - ratio * C : 0.0;
    return sure;
}

/* model/joints/floating, `change`; 0 if it is in doubt. */
static int change(const double *q, const double *there, double *delta_q)
{
    double R[9], a, c2, v[3], *w = delta_q + 3;
    double apart[3] = {there[0] - q[0], there[1] - q[1], there[2] - q[2]};
    int sure = rotation_between(q + 3, there + 3, w, &a, &c2);
    rotation(FLOATING, q, R);
    for (int i = 0; i < 3; i++) {
        double axis[3] = {R[i], R[3 + i], R[6 + i]};
        v[i] = dot(axis, apart);
    }
    combined(v, w, a, -0.5, c2, delta_q);
    return sure;
}

/* model/system, `actuated_difference`; 0 if a part may not have length one, an angle is in doubt, or
   a base in the plane is actuated. */
int differences(const Sums *s)
{
    int sure = 1;
    for (int64_t joint = 0; joint < s->joints; joint++) {
        int64_t kind = s->kind[joint];
        const double *q = s->here + s->q_start[joint], *there = s->target + s->q_start[joint];
        double *delta_q = s->delta_q_bar_a + s->v_start[joint];
        int first = kind == FLOATING ? 3 : kind == PLANAR ? 2 : 0, n = kind == FLOATING ? 4 : 2;
        int actuated = joint < s->actuated;
        if (kind != SCALAR)
            sure &= is_unit(q + first, n) && (!actuated || is_unit(there + first, n));
        if (!actuated)
            continue;
        if (kind == FLOATING)
            sure &= change(q, there, delta_q);
        else if (kind == CONTINUOUS)
            sure &= angle_of(q[0] * there[1] - q[1] * there[0], q[0] * there[0] + q[1] * there[1], delta_q);
        else if (kind == SCALAR)
            delta_q[0] = there[0] - q[0];
        else
            sure = 0;
    }
    return sure;
}

/* simulate/limits, `out_of_reach`: the squared distances of all links' origins from that of the world. */
double squared_distances(int64_t links, const double *const *t)
{
    double sum = 0.0;
    for (int64_t i = 0; i < links; i++)
        for (int k = 0; k < 3; k++)
            sum += t[i][k] * t[i][k];
    return sum;
}
