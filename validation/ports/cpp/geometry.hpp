// Vectors, matrices (lists of rows), rotations and rigid motions.
#pragma once
#include <array>
#include <cmath>

using Vec = std::array<double, 3>;
using Mat = std::array<Vec, 3>;
using Quat = std::array<double, 4>;  // x y z w

inline Vec operator+(Vec a, Vec b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(Vec a, Vec b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(double s, Vec a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(Vec a, Vec b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec unit(Vec a) { return 1 / norm(a) * a; }
inline Vec cross(Vec a, Vec b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
inline Vec operator*(const Mat& A, Vec x) { return {dot(A[0], x), dot(A[1], x), dot(A[2], x)}; }
inline Vec column(const Mat& A, int j) { return {A[0][j], A[1][j], A[2][j]}; }
inline Mat transpose(const Mat& A) { return {column(A, 0), column(A, 1), column(A, 2)}; }

inline Mat operator*(const Mat& A, const Mat& B) {
  Mat C;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[i][j] = dot(A[i], column(B, j));
  return C;
}

inline Mat operator+(Mat A, const Mat& B) {
  for (int i = 0; i < 3; i++) A[i] = A[i] + B[i];
  return A;
}

inline Mat operator*(double s, Mat A) {
  for (Vec& row : A) row = s * row;
  return A;
}

inline const Mat identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

// The matrix W with W x = w cross x.
inline Mat hat(Vec w) { return {{{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}}}; }

inline Mat rotation(Quat q) {
  double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  double x = q[0] / size, y = q[1] / size, z = q[2] / size, w = q[3] / size;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

// The quaternion of a rotation, from its largest entry.
inline Quat quaternion(const Mat& R) {
  double trace = R[0][0] + R[1][1] + R[2][2];
  int i = 0;
  for (int j = 1; j < 3; j++)
    if (R[j][j] > R[i][i]) i = j;
  if (trace >= R[i][i]) {
    double w = std::sqrt(1 + trace) / 2;
    return {(R[2][1] - R[1][2]) / (4 * w), (R[0][2] - R[2][0]) / (4 * w), (R[1][0] - R[0][1]) / (4 * w), w};
  }
  int j = (i + 1) % 3, k = (i + 2) % 3;
  double x = std::sqrt(1 + R[i][i] - R[j][j] - R[k][k]) / 2;
  Quat q;
  q[i] = x;
  q[j] = (R[j][i] + R[i][j]) / (4 * x);
  q[k] = (R[k][i] + R[i][k]) / (4 * x);
  q[3] = (R[k][j] - R[j][k]) / (4 * x);
  return q;
}

struct Pose {
  Mat R = identity;
  Vec p = {0, 0, 0};
  Vec operator*(Vec x) const { return R * x + p; }
  Pose operator*(const Pose& b) const { return {R * b.R, R * b.p + p}; }
};

inline Pose inverse(const Pose& a) { return {transpose(a.R), -1 * (transpose(a.R) * a.p)}; }

// sin t / t, (1 - cos t) / t^2 and (t - sin t) / t^3.
inline double sinc(double t) { return t == 0 ? 1 : std::sin(t) / t; }
inline double cosc(double t) { return sinc(t / 2) * sinc(t / 2) / 2; }
inline double cubic(double t) {
  if (std::abs(t) > 0.5) return (t - std::sin(t)) / (t * t * t);
  double s = t * t;
  return 1. / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156 * (1 - s / 210))))));
}

inline Mat turn(Vec w) {
  double t = norm(w);
  return identity + sinc(t) * hat(w) + cosc(t) * (hat(w) * hat(w));
}

// The motion of the twist (v, w).
inline Pose exp6(Vec v, Vec w) {
  double t = norm(w);
  Mat V = identity + cosc(t) * hat(w) + cubic(t) * (hat(w) * hat(w));
  return {turn(w), V * v};
}

// The least twist of a motion: w, and v with V v = p.
inline std::array<Vec, 2> log6(const Pose& pose) {
  Quat q = quaternion(pose.R);
  if (q[3] < 0) q = {-q[0], -q[1], -q[2], -q[3]};
  Vec u = {q[0], q[1], q[2]};
  double s = norm(u), t = 2 * std::atan2(s, q[3]);
  Vec w = (s > 0 ? t / s : 2) * u;
  Mat V = identity + cosc(t) * hat(w) + cubic(t) * (hat(w) * hat(w));
  double det = dot(V[0], cross(V[1], V[2]));
  Mat inverse = transpose({1 / det * cross(V[1], V[2]), 1 / det * cross(V[2], V[0]), 1 / det * cross(V[0], V[1])});
  return {inverse * pose.p, w};
}
