// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mentions.hpp"

#include <fmt/format.h>

#include <unordered_set>

namespace eomgen::model {
namespace {

class Collector {
 public:
  explicit Collector(const Model& model) : model_(model) {}

  std::vector<ModelExpression> run() {
    for (const Definition& d : model_.definitions) add(fmt::format("definition '{}'", d.name), {d.expression});
    places();
    frames();
    for (const Body& b : model_.bodies) {
      const std::string of = fmt::format("the body '{}'", model_.frames[b.frame].name);
      add(of, {b.mass});
      for (const auto& row : b.inertia) add(of, {row[0], row[1], row[2]});
    }
    for (const Particle& p : model_.particles)
      add(fmt::format("the particle '{}'", model_.places[p.place].name), {p.mass});
    add("the energies", {model_.energy.kinetic, model_.energy.potential});
    for (const Force& force : model_.forces) {
      of_ = fmt::format("'{}'", force.name);
      for (const Argument& argument : force.arguments) more({argument.value});
      for (const Effect& effect : force.effects) {
        if (effect.load_type == Effect::LoadType::component) rubbed(effect.index);
      }
      if (force.dry) more({force.dry->normal}), law(force.dry->law), rubbed(force.dry->coordinate);
    }
    constraints();
    for (const State& z : model_.states) add(fmt::format("the state '{}'", z.name), {z.rate, z.energy});
    for (const Event& event : model_.events) add(fmt::format("event '{}'", event.name), {event.when});
    for (const Coordinate& c : model_.coordinates) add(fmt::format("the range of '{}'", c.name), {c.lower, c.upper});
    return std::move(roots_);
  }

 private:
  void add(const std::string& of, std::initializer_list<NodeId> expressions, std::uint32_t frame = 0,
           std::uint32_t place = 0) {
    for (const NodeId id : expressions) {
      if (id != no_node) roots_.push_back({id, of, frame, place});
    }
  }
  void more(std::initializer_list<NodeId> expressions) { add(of_, expressions); }

  void places() {
    for (std::uint32_t k = 1; k < model_.places.size(); ++k) {
      const std::string of = fmt::format("the position of '{}'", model_.places[k].name);
      add(of, {model_.places[k].position}, 0, k);
    }
  }
  void frames() {
    for (std::uint32_t k = 1; k < model_.frames.size(); ++k) {
      const std::string of = fmt::format("the rotation of '{}'", model_.frames[k].name);
      for (const NodeId entry : model_.frames[k].entries) add(of, {entry}, k);
      for (const RotationStage& stage : model_.frames[k].stages) add(of, {stage.e[0], stage.e[1], stage.e[2]}, k);
    }
  }
  void constraints() {
    for (const Constraint& c : model_.constraints) {
      of_ = fmt::format("constraint '{}'", c.name);
      for (const NodeId psi : c.psi) more({psi});
      more({c.restitution});
      if (c.contact) contact(*c.contact);
      if (c.friction) law(*c.friction);
    }
  }
  void contact(const BodyContact& t) {
    more({t.arm, t.other_arm, t.tangents[0], t.tangents[1], t.slip, t.tangential_velocity, t.offset});
    for (const NodeId id : t.normal_velocity) more({id});
  }
  void law(const Friction& f) { more({f.static_coefficient, f.dynamic_coefficient, f.width, f.surface_velocity}); }

  /// A force component along a coordinate uses it without an expression. The position or rotation that uses the
  /// coordinate is reported instead.
  void rubbed(std::uint32_t coordinate) {
    for (NodeId id = 0; id < model_.arena.nodes.size(); ++id) {
      const Node& node = model_.arena[id];
      if (node.op == Op::coordinate && node.index == coordinate) return more({id});
    }
  }

  const Model& model_;
  std::vector<ModelExpression> roots_;
  std::string of_;
};

}  // namespace

std::vector<ModelExpression> model_expressions(const Model& model) { return Collector(model).run(); }

std::string find_mention(const Model& model,
                         const std::function<std::string(const Node&, const ModelExpression&)>& what) {
  for (const ModelExpression& root : model_expressions(model)) {
    std::vector<NodeId> open{root.expression};
    std::unordered_set<NodeId> seen;
    while (!open.empty()) {
      const NodeId id = open.back();
      open.pop_back();
      if (id == no_node || !seen.insert(id).second) continue;
      const Node& node = model.arena[id];
      if (const std::string name = what(node, root); !name.empty())
        return fmt::format("{} is named by {}", name, root.of);
      open.insert(open.end(), node.args.begin(), node.args.end());
    }
  }
  return "";
}

}  // namespace eomgen::model
