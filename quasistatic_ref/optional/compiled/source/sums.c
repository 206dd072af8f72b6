/* model/sums, `plus` and `change`: q (+) delta_q and q_next (-) q, in the order of operations of model/screw.

   Sines and angles are those of long double, where their error leaves one float64; else the joint is `open`, and
   left to Python. `joints` has the kinds of all, where their entries of q start, and where those of delta_q. Both
   functions return how many are open. */

#include <stdbool.h>

#include "vectors.h"

enum { FLOATING, PLANAR, CONTINUOUS, SCALAR };

/* The float64 nearest to a number whose long double is wrong by less than 2^-60 of itself (the sines
   and angles of C libraries, by 2^-62); 0 if that leaves two. */
static int nearest(long double found, double *out)
{
    volatile long double one = 1.0L;
    long double margin = found * 0x1p-60L;
    *out = (double)(found - margin);
    return one + 0x1p-62L != one && *out == (double)(found + margin);
}

/* numbers/angles, `cos_sin` and `angle_of`; 0 if they are in doubt. A zero has no sign. */
static int cos_sin(double angle, double *cosine, double *sine)
{
    angle += 0.0;
    return fabs(angle) < 1e6 && nearest(cosl(angle), cosine) && nearest(sinl(angle), sine);
}

static int angle_of(double y, double x, double *angle)
{
    return isfinite(y) && isfinite(x) && nearest(atan2l(y + 0.0, x + 0.0), angle);
}

static double length(const double *w) { return sqrt(dot(w, w)); }

/* model/screw, `half_turn`, of a turn by a. */
static int half_turn(double a, double *C, double *ratio)
{
    double b = a / 2, S;
    int sure = cos_sin(b, C, &S);
    *ratio = a == 0 ? 1.0 : S / b;
    return sure;
}

/* model/screw, `combined`. */
static void combined(const double *v, const double *w, double a, double once, double twice, double *out)
{
    double rest = 1 - twice, along = a * a == 0 ? 0.0 : twice * dot(w, v) / (a * a);
    out[0] = rest * v[0] + once * (w[1] * v[2] - w[2] * v[1]) + along * w[0];
    out[1] = rest * v[1] + once * (w[2] * v[0] - w[0] * v[2]) + along * w[1];
    out[2] = rest * v[2] + once * (w[0] * v[1] - w[1] * v[0]) + along * w[2];
}

/* model/screw, `rows`. */
static void rows(const double *quaternion, double R[9])
{
    double x = quaternion[0], y = quaternion[1], z = quaternion[2], w = quaternion[3];
    R[0] = 1 - 2 * (y * y + z * z), R[1] = 2 * (x * y - z * w), R[2] = 2 * (x * z + y * w);
    R[3] = 2 * (x * y + z * w), R[4] = 1 - 2 * (x * x + z * z), R[5] = 2 * (y * z - x * w);
    R[6] = 2 * (x * z - y * w), R[7] = 2 * (y * z + x * w), R[8] = 1 - 2 * (x * x + y * y);
}

/* model/screw, `turned`. */
static void turned_by(const double *here, const double *w, double C, double ratio, double *out)
{
    double scale = ratio / 2, p = w[0] * scale, q = w[1] * scale, r = w[2] * scale;
    double x = here[0], y = here[1], z = here[2], s = here[3];
    double a = s * p + x * C + y * r - z * q, b = s * q + y * C + z * p - x * r;
    double c = s * r + z * C + x * q - y * p, d = s * C - x * p - y * q - z * r;
    double shorter = (3 - (a * a + b * b + c * c + d * d)) / 2, after[4] = {a, b, c, d};
    int stays = p == 0 && q == 0 && r == 0;
    for (int i = 0; i < 4; i++)
        out[i] = stays ? here[i] : shorter * after[i];
}

/* model/screw, `heading`. */
static int heading(const double *here, double angle, double *out)
{
    double c = here[0], s = here[1], C, S;
    int sure = cos_sin(angle / 2, &C, &S);
    double cosine = 1 - 2 * (S * S), sine = 2 * (S * C);
    double x = c * cosine - s * sine, y = s * cosine + c * sine, shorter = (3 - (x * x + y * y)) / 2;
    out[0] = angle == 0 ? c : shorter * x;
    out[1] = angle == 0 ? s : shorter * y;
    return sure;
}

/* model/joints, `moved`, of a base that is free, and of one in the plane. */
static int base_moved(int64_t kind, const double *q, const double *delta_q, double *there)
{
    int free = kind == FLOATING, size = free ? 3 : 2, sure;
    double v[3] = {delta_q[0], delta_q[1], free ? delta_q[2] : 0.0}, w[3] = {0.0, 0.0, delta_q[2]};
    double R[9] = {q[2], -q[3], 0.0, q[3], q[2], 0.0, 0.0, 0.0, 1.0}, t[3], C, ratio;
    if (free) {
        for (int i = 0; i < 3; i++)
            w[i] = delta_q[3 + i];
        rows(q + 3, R);
    }
    double a = length(w);
    sure = half_turn(a, &C, &ratio);
    combined(v, w, a, ratio * ratio / 2, 1 - ratio * C, t); /* `translation` */
    for (int i = 0; i < size; i++)
        there[i] = q[i] + dot(R + 3 * i, t);
    if (free)
        turned_by(q + 3, w, C, ratio, there + 3);
    else
        sure &= heading(q + 2, delta_q[2], there + 2);
    return sure;
}

int64_t plus(const int64_t *count, const int64_t *joints, const double *q, const double *delta_q, double *q_next,
             bool *open)
{
    int64_t left = 0;
    for (int64_t j = 0; j < *count; j++) {
        int64_t kind = joints[j], at = joints[*count + j], v = joints[2 * *count + j];
        int sure = 1;
        if (kind == SCALAR)
            q_next[at] = q[at] + delta_q[v];
        else if (kind == CONTINUOUS)
            sure = heading(q + at, delta_q[v], q_next + at);
        else
            sure = base_moved(kind, q + at, delta_q + v, q_next + at);
        left += open[j] = !sure;
    }
    return left;
}

/* model/joints/floating, `change`, with model/screw, `rotation_between`. */
static int free_change(const double *q, const double *there, double *change)
{
    double x = q[3], y = q[4], z = q[5], s = q[6], p = there[3], o = there[4], r = there[5], k = there[6], b;
    double v[3] = {s * p - x * k - y * r + z * o, s * o - y * k - z * p + x * r, s * r - z * k - x * o + y * p};
    double w = s * k + x * p + y * o + z * r, S = length(v), C = fabs(w), R[9], apart[3], *turn = change + 3;
    int sure = angle_of(S, C, &b);
    double ratio = S == 0 ? 1.0 : b / S, scale = w >= 0 ? 2 * ratio : -2 * ratio;
    rows(q + 3, R);
    for (int i = 0; i < 3; i++) {
        double axis[3] = {R[i], R[3 + i], R[6 + i]};
        double between[3] = {there[0] - q[0], there[1] - q[1], there[2] - q[2]};
        apart[i] = dot(axis, between);
        turn[i] = scale * v[i];
    }
    combined(apart, turn, 2 * b, -0.5, S == 0 ? 0.0 : 1 - ratio * C, change);
    return sure;
}

static int joint_change(int64_t kind, const double *here, const double *there, double *out)
{
    if (kind == SCALAR)
        out[0] = there[0] - here[0];
    else if (kind == CONTINUOUS)
        return angle_of(here[0] * there[1] - here[1] * there[0], here[0] * there[0] + here[1] * there[1], out);
    return kind == SCALAR || (kind == FLOATING && free_change(here, there, out));
}

/* simulate/form_step, `StepPlan.loads`: tau, and q_next (-) q of the first joints. `sizes`: coordinates, actuated ones,
   joints, and parts that must have length one, which start `at`, with so many numbers. `torque` is minus the force of
   gravity in the order that `paper` says, `within` the error of the squared lengths. 0 where Python has to say. */
int64_t step_loads(const int64_t *sizes, const int64_t *joints, const int64_t *at, const int64_t *paper,
                   const double *acts, double within, const double *torque, const double *force, const double *q,
                   const double *q_next, double *loads)
{
    int64_t n_v = sizes[0], n_a = sizes[1], count = sizes[2];
    double off = 0.0;
    for (int64_t i = 0; i < sizes[3]; i++) {
        double square = -1.0;
        for (int64_t k = at[i]; k < at[i] + at[sizes[3] + i]; k++)
            square += q_next[k] * q_next[k];
        off += square * square;
    }
    for (int64_t i = 0; i < n_v; i++)
        loads[i] = ((0.0 - torque[paper[i]]) * (i < n_a ? acts[i] : 1.0) + force[i]) + 0.0;
    for (int64_t j = 0; j < count; j++)
        if (!joint_change(joints[j], q + joints[count + j], q_next + joints[count + j],
                          loads + n_v + joints[2 * count + j]))
            return 0; /* an angle that it cannot round */
    for (int64_t i = n_v; i < n_v + n_a; i++)
        loads[i] += 0.0;
    return off < within;
}
