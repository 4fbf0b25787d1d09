// SPDX-License-Identifier: GPL-3.0-or-later
// Expands the formulas of a kind of force for one force of the model.
#include <fmt/format.h>

#include <algorithm>

#include "model/read_forces.hpp"

namespace eomgen::model {
namespace {

using forces::Domain;
using forces::LoadType;
using forces::Predicate;

const std::map<LoadType, Effect::LoadType>& effects() {
  static const std::map<LoadType, Effect::LoadType> all{{LoadType::acceleration, Effect::LoadType::acceleration},
                                                        {LoadType::potential, Effect::LoadType::potential},
                                                        {LoadType::force, Effect::LoadType::force},
                                                        {LoadType::moment, Effect::LoadType::moment},
                                                        {LoadType::work, Effect::LoadType::work},
                                                        {LoadType::damping, Effect::LoadType::damping}};
  return all;
}

bool is_vector(LoadType acts) {
  return acts == LoadType::acceleration || acts == LoadType::force || acts == LoadType::moment;
}

TypedNode known(NodeId node) {
  TypedNode result;
  result.node = node;
  return result;
}

Context formula(Shape shape) { return {"a force", on_anything, shape, std::nullopt, ""}; }

}  // namespace

bool ForcesReader::is_literal_zero(NodeId id) const {
  const Node& node = model_.arena[id];
  switch (node.op) {
    case Op::number: return cln::zerop(node.value);
    case Op::negate:
    case Op::divide: return is_literal_zero(node.args[0]);
    case Op::multiply: return is_literal_zero(node.args[0]) || is_literal_zero(node.args[1]);
    default: return false;
  }
}

bool ForcesReader::applies(const ForceDraft& open, const forces::Term& term) const {
  return std::all_of(term.conditions.begin(), term.conditions.end(), [&](const forces::Condition& when) {
    const Argument* argument = open.force.argument(when.key);
    switch (when.predicate) {
      case Predicate::given: return argument != nullptr;
      case Predicate::left_out: return argument == nullptr;
      case Predicate::zero: return argument != nullptr && is_literal_zero(argument->value);
      case Predicate::nonzero: return argument != nullptr && !is_literal_zero(argument->value);
      case Predicate::chosen: break;
    }
    const auto& keys = open.kind.keys;
    const auto key = std::find_if(keys.begin(), keys.end(),
                                  [&](const forces::Key& candidate) { return candidate.name == when.key; });
    return argument != nullptr && key->choices[argument->index].text == when.choice;
  });
}

void ForcesReader::add_effect(const ForceDraft& open, const forces::Term& term,
                              const std::map<std::string, TypedNode>& local) {
  const Span span = open.force.span;
  const auto text = [&](const std::string& written, Shape shape) {
    return resolver_.text(written, local, span, formula(shape)).node;
  };
  Effect effect;
  effect.load_type = effects().at(term.load_type);
  if (term.load_type == LoadType::moment) {
    effect.index = open.force.argument(term.at)->index;
    if (effect.index == 0) return;  // the ground
  }
  effect.value = text(term.formula, is_vector(term.load_type) ? Shape::vector : Shape::scalar);
  if (!term.extension.empty()) effect.extension = text(term.extension, Shape::scalar);
  if (term.load_type == LoadType::force) effect.at = text(term.at, Shape::vector);
  if (term.load_type == LoadType::work) effect.at = text(term.at, Shape::scalar);
  if (term.load_type == LoadType::damping || term.load_type == LoadType::potential) {
    effect.at = open.force.value("a");
    effect.other = open.force.value("b");
  }
  open.force.effects.push_back(effect);
}

std::map<std::string, TypedNode> ForcesReader::mass_names(std::uint32_t place, NodeId mass, const std::string& number,
                                                          Span span) {
  TypedNode r = resolver_.place(place, span);
  r.dimension = std::nullopt;
  return {{"m" + number, known(mass)}, {"r" + number, r}};
}

void ForcesReader::add_over_bodies(const ForceDraft& open, const forces::Term& term) {
  const Span span = open.force.span;
  for (std::uint32_t k = 0; k < model_.bodies.size(); ++k) {
    const Body& body = model_.bodies[k];
    std::map<std::string, TypedNode> local = open.local;
    local.merge(mass_names(body.place, body.mass, "", span));
    local["d"] = resolver_.text(term.arm, local, span, formula(Shape::vector));
    local["dJd"] = resolver_.inertia(k, local["d"], span);
    std::map<std::string, TypedNode> J;
    for (std::size_t i = 0; i < 3; ++i) {
      const NodeId moment = body.inertia[i][i];
      J[fmt::format("J{}", i + 1)] = moment == no_node ? resolver_.number(0, span) : known(moment);
    }
    local["trJ"] = resolver_.text("J1 + (J2 + J3)", J, span, formula(Shape::scalar));
    add_effect(open, term, local);
  }
}

void ForcesReader::expand_formulas(ForceDraft& open) {
  struct Mass {
    std::uint32_t place;
    NodeId mass;
  };
  std::vector<Mass> masses;
  for (const Particle& particle : model_.particles) masses.push_back({particle.place, particle.mass});
  for (const Body& body : model_.bodies) masses.push_back({body.place, body.mass});
  for (const forces::Term& term : open.kind.terms) {
    if (!applies(open, term)) continue;
    if (term.domain == Domain::once) add_effect(open, term, open.local);
    if (term.domain == Domain::bodies) add_over_bodies(open, term);
    for (std::size_t i = 0; i < masses.size() && (term.domain == Domain::masses || term.domain == Domain::pairs); ++i) {
      const bool pairs = term.domain == Domain::pairs;
      std::map<std::string, TypedNode> local = open.local;
      local.merge(mass_names(masses[i].place, masses[i].mass, pairs ? "1" : "", open.force.span));
      if (!pairs) add_effect(open, term, local);
      for (std::size_t k = i + 1; k < masses.size() && pairs; ++k) {
        std::map<std::string, TypedNode> both = local;
        both.merge(mass_names(masses[k].place, masses[k].mass, "2", open.force.span));
        add_effect(open, term, both);
      }
    }
  }
}

}  // namespace eomgen::model
