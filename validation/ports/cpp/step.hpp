// Layer 8: a whole step.
#pragma once
#include "contact.hpp"
#include "qp.hpp"

struct Candidate {
  Distance d;
  int index;
  bool behind;
};

inline std::vector<Candidate> candidates(const json& alpha, const Pose& at, const json& beta, const Pose& bt, int k) {
  std::vector<Candidate> found;
  if (alpha["kind"] == "cloud" || beta["kind"] == "cloud") {
    for (const Distance& d : distances(alpha, at, beta, bt)) found.push_back({d, int(found.size()), false});
    return found;
  }
  Distance closest = distance(alpha, at, beta, bt);
  if (k == 1) return {{closest, 0, false}};
  int number = 0;
  auto take = [&](const Distance& d) {
    int index = number++;
    if (dot(d.n, closest.n) < std::cos(0.25)) return;
    bool repeats = false;
    for (const Candidate& e : found)
      repeats |= std::abs(e.d.phi - d.phi) <= 1e-9 && norm(e.d.alpha - d.alpha) <= 1e-9 && norm(e.d.n - d.n) <= 1e-9;
    found.push_back({d, index, repeats});
  };
  for (Vec x : corners(alpha)) take(distance({{"kind", "sphere"}, {"radius", 0.}}, {identity, at * x}, beta, bt));
  for (Vec x : corners(beta)) take(distance(alpha, at, {{"kind", "sphere"}, {"radius", 0.}}, {identity, bt * x}));
  int nearer = 0;
  for (const Candidate& c : found) nearer += !c.behind && c.d.phi <= closest.phi + 1e-9;
  take(closest);
  if (nearer >= k) found.back().behind = true;
  Distance far = closest;
  far.phi = 1e6;
  for (int index = number; int(found.size()) < std::min(k, number); index++) found.push_back({far, index, true});
  return found;
}

// H = blockdiag(h K_q, M_u / h) and g = h (K_q delta_q_bar_a + tau_a, tau_u).
inline std::pair<Rows, List> dynamics(const json& scene, const Mechanism& mechanism, const std::map<std::string, Body>& bodies) {
  int n_a = mechanism.n_a, n_v = mechanism.n_v;
  double h = scene["h"];
  Vec gravity = scene["gravity"];
  Rows H(n_v, List(n_v, 0.));
  List tau(n_v, 0.);
  for (const json& body : mechanism.bodies) {
    const Body& at = bodies.at(body["name"]);
    double m = body.value("mass", 0.);
    Vec com = at.pose * body.value("com", Vec{0, 0, 0});
    Mat I = at.pose.R * body.value("inertia", Mat{}) * transpose(at.pose.R);
    for (int i = n_a; i < n_v; i++) {
      for (int j = n_a; j <= i; j++) H[i][j] += m * dot(velocity(at, i, com), velocity(at, j, com)) + dot(at.w[i], I * at.w[j]);
      tau[i] += m * dot(velocity(at, i, com), gravity);
    }
    for (const json& load : scene.value("wrenches", json::array()))
      if (load["body"] == body["name"])
        for (int i = 0; i < n_v; i++) tau[i] += dot(velocity(at, i, com), load["force"]) + dot(at.w[i], load["torque"]);
  }
  Rows K_q = scene["K_q"];
  List bar = mechanism.difference(scene["q_bar_a"], scene["q"]);
  for (int i = 0; i < n_v; i++)
    for (int j = 0; j < n_v; j++) {
      if (i < n_a && j < n_a) tau[i] += K_q[i][j] * bar[j];
      H[i][j] = i < n_a && j < n_a ? h * K_q[i][j] : j <= i ? H[i][j] / h : 0;
    }
  for (int i = n_a; i < n_v; i++)
    for (int j = n_a; j < i; j++) H[j][i] = H[i][j];
  for (double& t : tau) t = h * t;
  return {H, tau};
}

// The forces of the step in which each contact gives way by its compliance c.
inline Rows forces(Program program, const std::string& cone, const std::vector<Contact>& contacts, const List& c, double h) {
  std::vector<std::pair<int, Numbers>> C;
  for (size_t j = 0; j < contacts.size(); j++)
    for (Vec t : table(cone, contacts[j].rows)) C.push_back({int(j), {1, t[0], t[1], t[2]}});
  for (size_t i = 0; i < C.size(); i++)
    for (size_t k = 0; k < C.size(); k++)
      if (C[i].first == C[k].first) program.S[i][k] += inner(C[i].second, C[k].second) / Number(h / c[C[i].first]);
  Numbers lam = multipliers(program.S, program.d);
  Matrix s(contacts.size(), Numbers(4));
  for (size_t i = 0; i < C.size(); i++) {
    auto& [j, row] = C[i];
    for (int k = 0; k < 4; k++) s[j][k] += row[k] * lam[i] / Number(h / c[j]);
  }
  Rows found;
  for (size_t j = 0; j < contacts.size(); j++) {
    Number slip_1 = contacts[j].mu_v * s[j][1] / c[j], slip_2 = contacts[j].mu_v * s[j][2] / c[j];
    Number gap = s[j][0] / c[j], spin = contacts[j].mu_omega * s[j][3] / c[j];
    found.push_back(doubles({slip_1, slip_2, gap, spin}));
  }
  return found;
}

inline json step(const json& scene) {
  Mechanism mechanism(scene["mechanism"]);
  std::string cone = scene["cone"];
  double h = scene["h"];
  auto bodies = mechanism.frames(scene["q"]);
  std::vector<Contact> contacts;
  List compliances;
  json listed = json::array();
  for (const json& pair : scene["pairs"]) {
    const json &alpha = scene["shapes"][pair["alpha"].get<std::string>()], &beta = scene["shapes"][pair["beta"].get<std::string>()];
    auto placed = [&](const json& shape) {
      return shape["body"].is_null() ? pose(shape["pose"]) : bodies.at(shape["body"]).pose * pose(shape["pose"]);
    };
    size_t k = pair["k"];
    auto near = candidates(alpha["shape"], placed(alpha), beta["shape"], placed(beta), k);
    std::stable_sort(near.begin(), near.end(), [](const Candidate& a, const Candidate& b) {
      return a.behind != b.behind ? b.behind : a.d.phi < b.d.phi;
    });
    if (near.size() > k) near.resize(k);
    std::sort(near.begin(), near.end(), [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
    for (const Candidate& made : near) {
      const Distance& d = made.d;
      Contact c;
      c.phi = d.phi, c.alpha = d.alpha, c.beta = d.beta, c.n = d.n;
      c.d1 = tangent(d.n);
      c.d2 = cross(d.n, c.d1);
      c.alpha_body = alpha["body"], c.beta_body = beta["body"];
      c.mu_v = pair["mu_v"], c.mu_omega = pair["mu_omega"], c.rows = pair["rows"];
      c.J = jacobian(c, bodies, mechanism.n_v);
      contacts.push_back(c);
      compliances.push_back(pair.value("compliance", 1e-9));
      listed.push_back({{"pair", pair["name"]}, {"index", made.index}, {"phi", c.phi}, {"alpha", c.alpha}, {"beta", c.beta},
                        {"n", c.n}, {"d1", c.d1}, {"d2", c.d2}, {"J", c.J}});
    }
  }
  auto [A, b] = frictionRows(cone, contacts);
  auto [H, g] = dynamics(scene, mechanism, bodies);
  json answer = {{"contacts", listed}, {"A", A}, {"b", b}, {"H", H}, {"g", g}};
  Program program(H, g, A, b);
  try {
    program.solve();
  } catch (const Infeasible& none) {
    answer["farkas"] = none.farkas;
    return answer;
  }
  List lam = doubles(program.lam), delta_q = doubles(program.x);
  Rows wrenches;
  size_t at = 0;
  for (const Contact& c : contacts) {
    size_t rows = table(cone, c.rows).size();
    wrenches.push_back(wrench(cone, c, List(lam.begin() + at, lam.begin() + at + rows), h));
    at += rows;
  }
  answer["delta_q"] = delta_q;
  answer["lam"] = lam;
  answer["A_lam"] = doubles(program.impulse);
  answer["wrench"] = wrenches;
  answer["forces"] = forces(program, cone, contacts, compliances, h);
  answer["q_next"] = mechanism.integrated(scene["q"], delta_q);
  return answer;
}
