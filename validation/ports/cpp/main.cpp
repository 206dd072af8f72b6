// The quasi-dynamic model, from the README of the vectors alone: layers 1 to 8 in polyhedral cones, distances in closed form.
//
//   port VECTORS ANSWERS    writes ANSWERS/LAYER.json for each layer
//   port                    answers the cases of a challenge, one a line
#include <fstream>
#include <iostream>

#include "step.hpp"

json shapes;  // those that the cases of a file share

json named(const json& shape) { return shape["kind"] == "shared" ? shapes[shape["name"].get<std::string>()] : shape; }

std::vector<Contact> contacts(const json& from) {
  std::vector<Contact> found;
  for (const json& c : from) found.push_back(contact(c));
  return found;
}

json answer(const std::string& layer, json in) {
  if (layer == "distance") {
    json alpha = named(in["alpha"]), beta = named(in["beta"]);
    Pose at = pose(in["pose_alpha"]), bt = pose(in["pose_beta"]);
    if (alpha["kind"] != "cloud" && beta["kind"] != "cloud") {
      Distance d = distance(alpha, at, beta, bt);
      return {{"phi", d.phi}, {"alpha", d.alpha}, {"beta", d.beta}, {"n", d.n}};
    }
    json all = {{"phi", json::array()}, {"alpha", json::array()}, {"beta", json::array()}, {"n", json::array()}};
    for (const Distance& d : distances(alpha, at, beta, bt)) {
      all["phi"].push_back(d.phi);
      all["alpha"].push_back(d.alpha);
      all["beta"].push_back(d.beta);
      all["n"].push_back(d.n);
    }
    return all;
  }
  if (layer == "selection") {
    json indices = json::array();
    for (size_t i = 0; i < in["phi"].size(); i++) {
      json normals = in.contains("normals") && !in["normals"].is_null() ? in["normals"][i] : json();
      indices.push_back(selection(in["phi"][i], normals, in["k"]));
    }
    return {{"indices", indices}};
  }
  if (layer == "jacobian") {
    Mechanism mechanism(in["mechanism"]);
    auto bodies = mechanism.frames(in["q"]);
    json J = json::array();
    for (const Contact& c : contacts(in["contacts"])) J.push_back(jacobian(c, bodies, mechanism.n_v));
    return {{"J", J}};
  }
  if (layer == "rows") {
    auto [A, b] = frictionRows(in["cone"], contacts(in["contacts"]));
    return {{"A", A}, {"b", b}};
  }
  if (layer == "qp") {
    if (in.contains("second_order")) throw std::domain_error("second-order cones");
    Program program(in["H"], in["g"], in["A"], in["b"]);
    try {
      program.solve();
    } catch (const Infeasible& none) {
      return {{"farkas", none.farkas}};
    }
    return {{"delta_q", doubles(program.x)}, {"lam", doubles(program.lam)}, {"A_lam", doubles(program.impulse)}, {"slack", doubles(program.slack)}};
  }
  if (layer == "wrench") {
    std::vector<Contact> all = contacts(in["contacts"]);
    Rows wrenches;
    for (size_t j = 0; j < all.size(); j++) wrenches.push_back(wrench(in["cone"], all[j], in["contacts"][j]["lam"], in["h"]));
    return {{"wrench", wrenches}, {"net", net(all, wrenches, in["bodies"])}};
  }
  if (layer == "integrate") return {{"q", Mechanism(in["mechanism"]).integrated(in["q"], in["delta_q"])}};
  if (layer == "step") {
    for (auto& [name, placed] : in["shapes"].items()) placed["shape"] = named(placed["shape"]);
    return step(in);
  }
  throw std::domain_error(layer);
}

// A case's line: its output, that it is not supported, or why there is none.
json answered(const std::string& layer, const json& asked) {
  json line = {{"id", asked["id"]}};
  try {
    line["output"] = answer(layer, asked["input"]);
  } catch (const std::domain_error& outside) {
    line["unsupported"] = true;
  } catch (const std::exception& error) {
    line["error"] = error.what();
  }
  return line;
}

int main(int count, char** words) {
  mpf_set_default_prec(400);
  const std::vector<std::string> layers = {"distance", "selection", "jacobian", "rows", "qp", "wrench", "integrate", "step"};
  if (count > 2) {
    for (const std::string& layer : layers) {
      json file = json::parse(std::ifstream(words[1] + ("/inputs/" + layer + ".json"))), answers = json::array();
      shapes = file.value("shapes", json::object());
      for (const json& asked : file["cases"]) {
        json line = answered(layer, asked);
        if (line.contains("output")) answers.push_back(line);
      }
      std::ofstream(words[2] + ("/" + layer + ".json"))
          << json{{"format", "quasistatic-ref/vectors-answers"}, {"version", 1}, {"layer", layer}, {"implementation", "the port in C++"}, {"answers", answers}};
    }
    return 0;
  }
  std::cout << json{{"protocol", 1}, {"implementation", "the port in C++"}, {"layers", layers}} << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    json asked = json::parse(line);
    std::cout << answered(asked["layer"], asked) << std::endl;
  }
}
