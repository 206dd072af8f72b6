// Frames of bodies, the velocities of their points, and q (+) delta_q with its inverse.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry.hpp"

using json = nlohmann::json;
using List = std::vector<double>;

inline Pose pose(const json& from) { return {rotation(from.at("quaternion")), from.at("xyz")}; }

struct Place {
  int q, v;  // where its entries of q and of delta_q begin
};

struct Body {
  Pose pose;
  std::vector<Vec> w, v;  // for each entry of delta_q, the velocity v + w cross x of a point x
};

struct Mechanism {
  json bodies;
  int n_q = 0, n_a = 0, n_v = 0;
  std::map<std::string, Place> places;

  explicit Mechanism(const json& from) : bodies(from.at("bodies")) {
    const std::map<std::string, Place> size = {{"fixed", {0, 0}},      {"revolute", {1, 1}}, {"prismatic", {1, 1}},
                                               {"continuous", {2, 1}}, {"floating", {7, 6}}, {"planar", {4, 3}}};
    for (bool actuated : {true, false}) {
      for (const json& body : bodies) {
        if (body.contains("mimic") && !body["mimic"].is_null()) continue;
        if (body["actuated"] != actuated) continue;
        places[body["name"]] = {n_q, n_v};
        n_q += size.at(body["joint"]).q;
        n_v += size.at(body["joint"]).v;
      }
      if (actuated) n_a = n_v;
    }
  }

  std::map<std::string, Body> frames(const List& q) const {
    std::map<std::string, Body> found;
    for (const json& body : bodies) {
      Body made = {{}, std::vector<Vec>(n_v, Vec{0, 0, 0}), std::vector<Vec>(n_v, Vec{0, 0, 0})};
      if (!body["parent"].is_null()) made = found.at(body["parent"]);
      Pose at = made.pose * ::pose(body["placement"]);
      std::string name = body["name"], joint = body["joint"];
      double factor = 1, offset = 0;
      if (body.contains("mimic") && !body["mimic"].is_null()) {
        name = body["mimic"]["of"];
        factor = body["mimic"]["multiplier"];
        offset = body["mimic"]["offset"];
      }
      if (joint != "fixed") {
        auto [i, j] = places.at(name);
        auto turns = [&](int j, Vec axis, Vec through) {
          made.w[j] = made.w[j] + axis;
          made.v[j] = made.v[j] + cross(through, axis);
        };
        Vec axis = body.value("axis", Vec{0, 0, 1});
        axis = unit(axis);
        if (joint == "revolute") {
          turns(j, factor * (at.R * axis), at.p);
          at.R = at.R * turn((factor * q[i] + offset) * axis);
        } else if (joint == "continuous") {
          turns(j, at.R * axis, at.p);
          at.R = at.R * turn(std::atan2(q[i + 1], q[i]) * axis);
        } else if (joint == "prismatic") {
          made.v[j] = made.v[j] + factor * (at.R * axis);
          at.p = at.p + (factor * q[i] + offset) * (at.R * axis);
        } else {
          at = at * base(joint, q, i);
          bool planar = joint == "planar";
          for (int k = 0; k < (planar ? 2 : 3); k++) made.v[j + k] = column(at.R, k);
          for (int k = planar ? 2 : 0; k < 3; k++) turns(planar ? j + k : j + 3 + k, column(at.R, k), at.p);
        }
      }
      made.pose = at;
      found[body["name"]] = made;
    }
    return found;
  }

  static Pose base(const std::string& joint, const List& q, int i) {
    if (joint == "planar") return {turn({0, 0, std::atan2(q[i + 3], q[i + 2])}), {q[i], q[i + 1], 0}};
    return {rotation({q[i + 3], q[i + 4], q[i + 5], q[i + 6]}), {q[i], q[i + 1], q[i + 2]}};
  }

  // q (+) delta_q.
  List integrated(const List& q, const List& by) const {
    List next(n_q);
    for (const json& body : bodies) {
      std::string joint = body["joint"];
      if (joint == "fixed" || (body.contains("mimic") && !body["mimic"].is_null())) continue;
      auto [i, j] = places.at(body["name"]);
      if (joint == "revolute" || joint == "prismatic") {
        next[i] = q[i] + by[j];
      } else if (joint == "continuous") {
        double angle = std::atan2(q[i + 1], q[i]) + by[j];
        next[i] = std::cos(angle);
        next[i + 1] = std::sin(angle);
      } else if (joint == "planar") {
        Pose to = base(joint, q, i) * exp6({by[j], by[j + 1], 0}, {0, 0, by[j + 2]});
        next[i] = to.p[0];
        next[i + 1] = to.p[1];
        next[i + 2] = to.R[0][0];
        next[i + 3] = to.R[1][0];
      } else {
        Pose to = base(joint, q, i) * exp6({by[j], by[j + 1], by[j + 2]}, {by[j + 3], by[j + 4], by[j + 5]});
        Quat turned = quaternion(to.R);
        for (int k = 0; k < 3; k++) next[i + k] = to.p[k];
        for (int k = 0; k < 4; k++) next[i + 3 + k] = turned[k];
      }
    }
    return next;
  }

  // target (-) q of the actuated joints.
  List difference(const List& target, const List& q) const {
    List found(n_a);
    for (const json& body : bodies) {
      std::string joint = body["joint"];
      if (joint == "fixed" || (body.contains("mimic") && !body["mimic"].is_null()) || !body["actuated"]) continue;
      auto [i, j] = places.at(body["name"]);
      if (joint == "revolute" || joint == "prismatic") {
        found[j] = target[i] - q[i];
      } else if (joint == "continuous") {
        double angle = std::atan2(target[i + 1], target[i]) - std::atan2(q[i + 1], q[i]);
        found[j] = std::remainder(angle, 2 * M_PI);
      } else {
        auto [v, w] = log6(inverse(base(joint, q, i)) * base(joint, target, i));
        bool planar = joint == "planar";
        for (int k = 0; k < (planar ? 2 : 3); k++) found[j + k] = v[k];
        for (int k = planar ? 2 : 0; k < 3; k++) found[planar ? j + k : j + 3 + k] = w[k];
      }
    }
    return found;
  }
};

inline Vec velocity(const Body& body, int j, Vec x) { return body.v[j] + cross(body.w[j], x); }
