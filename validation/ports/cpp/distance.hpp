// Closed forms of distances: half-spaces against everything, points and balls against boxes, balls, capsules and cylinders.
#pragma once
#include <algorithm>

#include "mechanism.hpp"

struct Distance {
  double phi;
  Vec alpha, beta, n;
};

inline Distance turned(Distance d) { return {d.phi, d.beta, d.alpha, -1 * d.n}; }

inline std::vector<Vec> corners(const json& shape) {
  std::vector<Vec> found;
  if (shape["kind"] == "box") {
    Vec size = shape["size"];
    for (double z : {-0.5, 0.5})
      for (double y : {-0.5, 0.5})
        for (double x : {-0.5, 0.5}) found.push_back({x * size[0], y * size[1], z * size[2]});
  }
  if (shape["kind"] == "convex") found = shape["vertices"].get<std::vector<Vec>>();
  return found;
}

// The point of a shape that is farthest along n.
inline Vec support(const json& shape, const Pose& at, Vec n) {
  std::string kind = shape["kind"];
  Vec m = transpose(at.R) * n;
  Vec x = {0, 0, 0};
  if (kind == "sphere") return at.p + shape["radius"].get<double>() * n;
  if (kind == "capsule" || kind == "cylinder") {
    double length = shape["length"], radius = shape["radius"];
    x[2] = m[2] > 0 ? length / 2 : -length / 2;
    if (kind == "capsule") return at * x + radius * n;
    double rho = std::hypot(m[0], m[1]);
    if (rho > 0) x = {radius * m[0] / rho, radius * m[1] / rho, x[2]};
    return at * x;
  }
  std::vector<Vec> all = corners(shape);
  if (all.empty()) throw std::domain_error(kind);
  x = *std::max_element(all.begin(), all.end(), [&](Vec a, Vec b) { return dot(m, a) < dot(m, b); });
  return at * x;
}

// From a half-space to the point x of a solid that is the deepest along its normal.
inline Distance plane(const json& shape, const Pose& at, Vec n, Vec x) {
  double phi = dot(n, x - at.p) - shape["offset"].get<double>() / norm(shape["normal"]);
  return {phi, x - phi * n, x, n};
}

// From a solid to a point x, in the frame of the solid: phi and n.
inline std::pair<double, Vec> point(const json& shape, Vec x) {
  std::string kind = shape["kind"];
  if (kind == "sphere") {
    double r = norm(x);
    return {r - shape["radius"].get<double>(), r > 0 ? 1 / r * x : Vec{1, 0, 0}};
  }
  if (kind == "capsule") {
    double half = shape["length"].get<double>() / 2;
    Vec d = {x[0], x[1], x[2] - std::clamp(x[2], -half, half)};
    double r = norm(d);
    return {r - shape["radius"].get<double>(), r > 0 ? 1 / r * d : Vec{1, 0, 0}};
  }
  if (kind == "cylinder") {
    double rho = std::hypot(x[0], x[1]), side = rho - shape["radius"].get<double>();
    double end = std::abs(x[2]) - shape["length"].get<double>() / 2;
    Vec out = rho > 0 ? Vec{x[0] / rho, x[1] / rho, 0} : Vec{1, 0, 0};
    Vec up = {0, 0, x[2] < 0 ? -1. : 1.};
    if (side > 0 && end > 0) {
      double r = std::hypot(side, end);
      return {r, side / r * out + end / r * up};
    }
    return side >= end ? std::pair{side, out} : std::pair{end, up};
  }
  if (kind != "box") throw std::domain_error(kind);
  Vec size = shape["size"], outside = {0, 0, 0}, n = {0, 0, 0};
  double depth = -1e300;
  for (int i = 0; i < 3; i++) {
    double sign = x[i] < 0 ? -1 : 1;
    double over = std::abs(x[i]) - size[i] / 2;
    outside[i] = sign * std::max(over, 0.);
    if (over > depth) {
      depth = over;
      n = {0, 0, 0};
      n[i] = sign;
    }
  }
  double r = norm(outside);
  return r > 0 ? std::pair{r, 1 / r * outside} : std::pair{depth, n};
}

inline Distance ball(const json& shape, const Pose& at, Vec centre, double radius) {
  auto [phi, m] = point(shape, transpose(at.R) * (centre - at.p));
  Vec n = at.R * m;
  return {phi - radius, centre - phi * n, centre - radius * n, n};
}

inline Distance distance(const json& alpha, const Pose& at, const json& beta, const Pose& bt) {
  std::string first = alpha["kind"], second = beta["kind"];
  if (first == "halfspace") {
    Vec n = at.R * unit(alpha["normal"]);
    return plane(alpha, at, n, support(beta, bt, -1 * n));
  }
  if (second == "sphere") return ball(alpha, at, bt.p, beta["radius"]);
  if (second == "halfspace" || first == "sphere") return turned(distance(beta, bt, alpha, at));
  throw std::domain_error(first + " on " + second);
}

inline std::vector<Distance> distances(const json& alpha, const Pose& at, const json& beta, const Pose& bt) {
  const json dot = {{"kind", "sphere"}, {"radius", 0.}};
  std::vector<Distance> found;
  if (alpha["kind"] == "cloud")
    for (Vec x : alpha["points"]) found.push_back(distance(dot, {identity, at * x}, beta, bt));
  else
    for (Vec x : beta["points"]) found.push_back(distance(alpha, at, dot, {identity, bt * x}));
  return found;
}
