// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-built models for the tests of the oracle, without the reader: formulas append nodes to the Arena.
#pragma once

#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::verify::test {

using model::Fn;
using model::Node;
using model::NodeId;
using model::Op;
using model::Rational;

struct ModelFormula {
  model::Model* model = nullptr;
  NodeId id = model::no_node;
};

inline bool is_vector(ModelFormula f) { return f.model->arena[f.id].vector; }

inline ModelFormula make(model::Model& m, Node node) {
  m.arena.nodes.push_back(std::move(node));
  return {&m, static_cast<NodeId>(m.arena.nodes.size() - 1)};
}
inline ModelFormula make(model::Model& m, Op op, std::vector<ModelFormula> args, bool vector) {
  Node node;
  node.op = op;
  node.vector = vector;
  for (std::size_t i = 0; i < args.size(); ++i) node.args[i] = args[i].id;
  return make(m, node);
}
inline ModelFormula number(model::Model& m, Rational value) {
  Node node;
  node.value = value;
  return make(m, node);
}
inline ModelFormula operator+(ModelFormula a, ModelFormula b) { return make(*a.model, Op::add, {a, b}, is_vector(a)); }
inline ModelFormula operator-(ModelFormula a, ModelFormula b) {
  return make(*a.model, Op::subtract, {a, b}, is_vector(a));
}
inline ModelFormula operator-(ModelFormula a) { return make(*a.model, Op::negate, {a}, is_vector(a)); }
inline ModelFormula operator*(ModelFormula a, ModelFormula b) {
  return make(*a.model, Op::multiply, {a, b}, is_vector(a) || is_vector(b));
}
inline ModelFormula operator/(ModelFormula a, ModelFormula b) {
  return make(*a.model, Op::divide, {a, b}, is_vector(a));
}
inline ModelFormula operator+(ModelFormula a, int b) { return a + number(*a.model, b); }
inline ModelFormula operator-(ModelFormula a, int b) { return a - number(*a.model, b); }
inline ModelFormula operator*(int a, ModelFormula b) { return number(*b.model, a) * b; }
inline ModelFormula operator/(ModelFormula a, int b) { return a / number(*a.model, b); }
inline ModelFormula operator^(ModelFormula a, int n) {
  return make(*a.model, Op::power, {a, number(*a.model, n)}, false);
}

inline ModelFormula call(Fn fn, ModelFormula x) {
  Node node;
  node.op = Op::call;
  node.fn = fn;
  node.args[0] = x.id;
  return make(*x.model, node);
}
inline ModelFormula sin(ModelFormula x) { return call(Fn::sin, x); }
inline ModelFormula cos(ModelFormula x) { return call(Fn::cos, x); }
inline ModelFormula ddt(ModelFormula x) { return make(*x.model, Op::total_derivative, {x}, is_vector(x)); }
inline ModelFormula diff(ModelFormula x, ModelFormula by) {
  return make(*x.model, Op::partial_derivative, {x, by}, is_vector(x));
}
inline ModelFormula dot(ModelFormula a, ModelFormula b) { return make(*a.model, Op::dot, {a, b}, false); }
inline ModelFormula norm(ModelFormula a) { return make(*a.model, Op::norm, {a}, false); }
inline ModelFormula vector(ModelFormula x, ModelFormula y, ModelFormula z) {
  return make(*x.model, Op::array, {x, y, z}, true);
}

inline ModelFormula leaf(model::Model& m, Op op, std::uint32_t index, std::uint8_t order = 0, bool is_vec = false) {
  Node node;
  node.op = op;
  node.index = index;
  node.order = order;
  node.vector = is_vec;
  return make(m, node);
}
inline ModelFormula time(model::Model& m) { return leaf(m, Op::time, 0); }
inline ModelFormula E(model::Model& m, std::uint32_t i) { return leaf(m, Op::fixed_basis, i - 1, 0, true); }

inline ModelFormula parameter(model::Model& m, std::string name, Rational value) {
  model::Parameter p;
  p.name = std::move(name);
  p.value = number(m, value).id;
  m.parameters.push_back(std::move(p));
  return leaf(m, Op::parameter, static_cast<std::uint32_t>(m.parameters.size() - 1));
}
inline ModelFormula coordinate(model::Model& m, std::string name) {
  model::Coordinate c;
  c.name = std::move(name);
  m.coordinates.push_back(std::move(c));
  return leaf(m, Op::coordinate, static_cast<std::uint32_t>(m.coordinates.size() - 1));
}
inline ModelFormula rate(ModelFormula q) { return leaf(*q.model, Op::coordinate, q.model->arena[q.id].index, 1); }
inline ModelFormula function(model::Model& m, std::string name, ModelFormula is) {
  model::Function f;
  f.name = std::move(name);
  f.expression = is.id;
  m.functions.push_back(std::move(f));
  return leaf(m, Op::function, static_cast<std::uint32_t>(m.functions.size() - 1));
}
inline ModelFormula input(model::Model& m, std::string name) {
  model::Input u;
  u.name = std::move(name);
  u.default_value = number(m, 0).id;
  m.inputs.push_back(std::move(u));
  return leaf(m, Op::input, static_cast<std::uint32_t>(m.inputs.size() - 1));
}
/// Adds a place and, if `mass` is given, a particle there. Returns the leaf for the position.
inline ModelFormula place(model::Model& m, std::string name, ModelFormula position, ModelFormula mass = {}) {
  if (m.places.empty()) m.places.emplace_back();  // the origin
  model::Place p;
  p.name = std::move(name);
  p.position = position.id;
  m.places.push_back(std::move(p));
  const auto index = static_cast<std::uint32_t>(m.places.size() - 1);
  if (mass.model != nullptr) m.particles.push_back({index, mass.id, {}});
  return leaf(m, Op::place, index, 0, true);
}
inline ModelFormula basis(Op op, ModelFormula place, ModelFormula q) {
  Node node;
  node.op = op;
  node.vector = true;
  node.index = place.model->arena[place.id].index;
  node.args[0] = q.id;
  return make(*place.model, node);
}
/// A force as the reader produces it: the arguments from the file for the oracle, and the effects for mechanics.
inline void force(model::Model& m, std::string kind, std::vector<model::Argument> arguments,
                  std::vector<model::Effect> effects = {}) {
  m.forces.push_back({"force " + std::to_string(m.forces.size() + 1),
                      std::move(kind),
                      std::move(arguments),
                      std::move(effects),
                      std::nullopt,
                      {}});
}
using LoadType = model::Effect::LoadType;
inline model::Effect effect(LoadType load_type, ModelFormula value, ModelFormula at = {}, ModelFormula other = {}) {
  return {load_type, value.id, at.id, other.id, model::no_node, 0};
}
inline void gravity(model::Model& m, ModelFormula g) {
  force(m, "gravity", {{"gravity", g.id}}, {effect(LoadType::acceleration, g)});
}
inline void applied(model::Model& m, ModelFormula F, ModelFormula at) {
  force(m, "force", {{"force", F.id}, {"on", at.id}}, {effect(LoadType::force, F, at)});
}
inline void spring(model::Model& m, ModelFormula a, ModelFormula b, ModelFormula stiffness, ModelFormula length) {
  const ModelFormula energy = ((norm(a - b) - length) ^ 2) * stiffness / 2;
  force(m, "spring", {{"a", a.id}, {"b", b.id}, {"stiffness", stiffness.id}, {"length", length.id}},
        {effect(LoadType::potential, energy)});
}
inline void damper(model::Model& m, ModelFormula a, ModelFormula b, ModelFormula c) {
  force(m, "damper", {{"a", a.id}, {"b", b.id}, {"coefficient", c.id}}, {effect(LoadType::damping, c, a, b)});
}
inline void generalized(model::Model& m, std::uint32_t coordinate, ModelFormula F) {
  model::Effect along = effect(LoadType::component, F);
  along.index = coordinate;
  force(m, "generalized", {{m.coordinates[coordinate].name, F.id, coordinate}}, {along});
}
inline void holonomic(model::Model& m, std::string name, std::vector<ModelFormula> psi) {
  model::Constraint c;
  c.name = std::move(name);
  for (const ModelFormula& f : psi) c.psi.push_back(f.id);
  m.constraints.push_back(std::move(c));
}
inline void default_scene(model::Model& m) {
  model::Scene scene;
  scene.name = "default";
  m.scenes.push_back(scene);
}

}  // namespace eomgen::verify::test
