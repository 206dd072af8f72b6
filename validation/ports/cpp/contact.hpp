// Selection, tangents, Jacobians, rows of friction and wrenches.
#pragma once
#include <numeric>

#include "distance.hpp"

using Rows = std::vector<List>;

struct Contact {
  double phi = 0;
  Vec alpha, beta, n, d1, d2;
  json alpha_body, beta_body;
  Rows J;
  double mu_v, mu_omega;
  int rows;
};

inline Contact contact(const json& from) {
  Contact c;
  c.phi = from.value("phi", 0.);
  c.alpha = from.value("alpha", Vec{0, 0, 0});
  c.beta = from.value("beta", Vec{0, 0, 0});
  c.n = from.at("n");
  c.d1 = from.at("d1");
  c.d2 = from.at("d2");
  c.alpha_body = from.value("alpha_body", json());
  c.beta_body = from.value("beta_body", json());
  c.J = from.value("J", Rows());
  c.mu_v = from.value("mu_v", 0.);
  c.mu_omega = from.value("mu_omega", 0.);
  c.rows = from.value("rows", 6);
  return c;
}

inline Vec tangent(Vec n) {
  int i = 0;
  if (std::abs(n[1]) < std::abs(n[i])) i = 1;
  if (std::abs(n[2]) < std::abs(n[i])) i = 2;
  Vec e = {0, 0, 0};
  e[i] = 1;
  return unit(e - n[i] * n);
}

// The places of the k least, in the order of phi and then of the place.
inline std::vector<int> selection(const List& phi, const json& normals, size_t k) {
  std::vector<int> places;
  for (size_t i = 0; i < phi.size(); i++)
    if (normals.is_null() || dot(normals[i], normals.back()) >= std::cos(0.25)) places.push_back(i);
  std::sort(places.begin(), places.end(), [&](int a, int b) { return phi[a] < phi[b] || (phi[a] == phi[b] && a < b); });
  if (places.size() > k) places.resize(k);
  int next = phi.size();
  if (!normals.is_null())
    while (places.size() < std::min(k, phi.size())) places.push_back(next++);
  return places;
}

inline Rows jacobian(const Contact& c, const std::map<std::string, Body>& bodies, int n_v) {
  Rows J(4, List(n_v, 0.));
  for (int j = 0; j < n_v; j++) {
    Vec slip = {0, 0, 0};
    double spin = 0;
    if (!c.beta_body.is_null()) {
      const Body& body = bodies.at(c.beta_body);
      slip = slip + velocity(body, j, c.beta);
      spin += dot(c.n, body.w[j]);
    }
    if (!c.alpha_body.is_null()) {
      const Body& body = bodies.at(c.alpha_body);
      slip = slip - velocity(body, j, c.alpha);
      spin -= dot(c.n, body.w[j]);
    }
    for (int i = 0; i < 3; i++) J[i][j] = slip[i];
    J[3][j] = spin;
  }
  return J;
}

// The table of the cones: t_1, t_2, t_3 of each row.
inline std::vector<Vec> table(const std::string& cone, int rows) {
  std::vector<Vec> t;
  if (cone == "frictionless") return {{0, 0, 0}};
  int sides = cone.rfind("facets-", 0) == 0 ? std::stoi(cone.substr(7)) : 4;
  for (int k = 0; k < sides; k++) {
    double angle = 2 * M_PI * k / sides;
    t.push_back({std::cos(angle), std::sin(angle), 0});
  }
  if (sides == 4) t = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  if (rows == 4) return t;
  if (cone == "product") {
    std::vector<Vec> both;
    for (double spin : {1., -1.})
      for (Vec side : t) both.push_back({side[0], side[1], spin});
    return both;
  }
  t.push_back({0, 0, 1});
  t.push_back({0, 0, -1});
  return t;
}

inline std::pair<Rows, List> frictionRows(const std::string& cone, const std::vector<Contact>& contacts) {
  Rows A;
  List b;
  for (const Contact& c : contacts)
    for (Vec t : table(cone, c.rows)) {
      List row(c.J[0].size(), 0.);
      for (size_t j = 0; j < row.size(); j++) {
        Vec slip = {c.J[0][j], c.J[1][j], c.J[2][j]};
        row[j] = dot(c.n, slip) + c.mu_v * t[0] * dot(c.d1, slip) + c.mu_v * t[1] * dot(c.d2, slip) + c.mu_omega * t[2] * c.J[3][j];
      }
      A.push_back(row);
      b.push_back(-c.phi);
    }
  return {A, b};
}

inline List wrench(const std::string& cone, const Contact& c, const List& lam, double h) {
  if (cone == "ellipsoid") return {lam[1] / h, lam[2] / h, lam[0] / h, lam[3] / h};
  List f = {0, 0, 0, 0};
  std::vector<Vec> t = table(cone, c.rows);
  for (size_t i = 0; i < t.size(); i++) {
    f[0] += c.mu_v * t[i][0] * lam[i] / h;
    f[1] += c.mu_v * t[i][1] * lam[i] / h;
    f[2] += lam[i] / h;
    f[3] += c.mu_omega * t[i][2] * lam[i] / h;
  }
  return f;
}

inline std::map<std::string, List> net(const std::vector<Contact>& contacts, const Rows& wrenches, const json& bodies) {
  std::map<std::string, List> total;
  for (auto& [name, body] : bodies.items()) {
    Vec point = body["point"], force = {0, 0, 0}, torque = {0, 0, 0};
    for (size_t j = 0; j < contacts.size(); j++) {
      const Contact& c = contacts[j];
      const List& f = wrenches[j];
      Vec F = f[0] * c.d1 + f[1] * c.d2 + f[2] * c.n;
      if (c.beta_body == name) {
        force = force + F;
        torque = torque + cross(c.beta - point, F) + f[3] * c.n;
      }
      if (c.alpha_body == name) {
        force = force - F;
        torque = torque - cross(c.alpha - point, F) - f[3] * c.n;
      }
    }
    total[name] = {force[0], force[1], force[2], torque[0], torque[1], torque[2]};
  }
  return total;
}
