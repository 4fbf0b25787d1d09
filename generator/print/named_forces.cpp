// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/named_forces.hpp"

#include <algorithm>

#include "forces/kind.hpp"
#include "print/formulas.hpp"

namespace eomgen::print {

using symbolic::Vec3;
using LoadType = model::Effect::LoadType;

using Terms = std::optional<std::vector<Formula>>;

namespace {

/// Appends factor * term with the sign in front; zero products are dropped.
void add(std::vector<Formula>& terms, const Formula& factor, const Formula& term) {
  const bool minus = factor.kind == FormulaKind::negative, minus_too = term.kind == FormulaKind::negative;
  const Formula &a = minus ? factor.args[0] : factor, &b = minus_too ? term.args[0] : term;
  if (reading::is_zero(a) || reading::is_zero(b)) return;
  Formula both = reading::product({a, b});
  terms.push_back(minus != minus_too ? reading::negative(std::move(both)) : std::move(both));
}

Terms negated(Terms terms) {
  if (!terms) return terms;
  for (Formula& term : *terms) term = reading::negative(std::move(term));
  return terms;
}

/// Vectors of the model in terms of named vectors: positions r of places, axes e of bodies, E. In: an expression of the
/// model. Out: a formula, and the places whose positions it contains.
class VectorFormula {
 public:
  /// `scalar`: the formula of a scalar factor; nothing if it is too long.
  VectorFormula(mechanics::Mechanics& mechanics, std::function<std::optional<reading::Formula>(model::NodeId)> scalar)
      : m_(mechanics), scalar_(std::move(scalar)) {}

  /// Returns nothing for other vectors, such as unit vectors of a chart or cross products.
  std::optional<Formula> operator()(model::NodeId vector) {
    Terms all = terms(vector);
    if (!all) return std::nullopt;
    return reading::sum(std::move(*all));
  }

  const std::vector<std::uint32_t>& places() const { return places_; }

 private:
  Terms terms(model::NodeId id) {
    const model::Node& node = m_.model->arena[id];
    const auto one = [](Formula f) { return Terms{{std::move(f)}}; };
    switch (node.op) {
      case model::Op::zero_vector: return Terms{std::in_place};
      case model::Op::fixed_basis: return one(mark("E", {index(node.index + 1)}));
      case model::Op::place:
        if (node.index == 0) return Terms{std::in_place};
        places_.push_back(node.index);
        return one(mark("r", {index(node.index)}));
      case model::Op::axis: {
        std::optional<Formula> e = axis(node);
        return e ? one(*std::move(e)) : std::nullopt;
      }
      case model::Op::definition: return terms(m_.model->definitions[node.index].expression);
      case model::Op::array: {
        std::vector<Formula> result;
        for (std::uint32_t k = 0; k < 3; ++k) {
          if (node.args[k] == model::no_node) continue;
          const std::optional<Formula> factor = scalar_(node.args[k]);
          if (!factor) return std::nullopt;
          add(result, *factor, mark("E", {index(k + 1)}));
        }
        return result;
      }
      case model::Op::negate: return negated(terms(node.args[0]));
      case model::Op::add:
      case model::Op::subtract: {
        Terms left = terms(node.args[0]), right = terms(node.args[1]);
        if (node.op == model::Op::subtract) right = negated(std::move(right));
        if (!left || !right) return std::nullopt;
        left->insert(left->end(), right->begin(), right->end());
        return left;
      }
      case model::Op::multiply:
      case model::Op::divide: {
        const bool first = m_.model->arena[node.args[0]].vector;
        const std::optional<Formula> factor = scalar_(node.args[first ? 1 : 0]);
        const Terms of = terms(node.args[first ? 0 : 1]);
        if (!factor || !of) return std::nullopt;
        std::vector<Formula> result;
        for (const Formula& term : *of)
          add(result, node.op == model::Op::divide ? reading::fraction(reading::number(1), *factor) : *factor, term);
        return result;
      }
      default: return std::nullopt;
    }
  }

  /// An axis has a letter if the inertia of its body refers to it.
  std::optional<Formula> axis(const model::Node& node) {
    const std::uint32_t k = node.order % 3;
    for (const mechanics::BodyRotation& spin : m_.body_rotations) {
      if (spin.frame != node.index) continue;
      const model::Frame& frame = m_.model->frames[spin.frame];
      if (node.order / 3 + 1u != frame.stages.size()) continue;
      if (mechanics::lower_vector(m_, frame.stages.back().e[k]) != spin.axes[k]) continue;
      return mark("e", {index(k + 1), index(spin.frame)});
    }
    return std::nullopt;
  }

  mechanics::Mechanics& m_;
  std::function<std::optional<reading::Formula>(model::NodeId)> scalar_;
  std::vector<std::uint32_t> places_;
};

/// The second effect of force 3 has F_(3 2).
std::vector<Formula> lower_index(std::uint32_t j, std::uint32_t k) {
  return k == 0 ? std::vector<Formula>{index(j + 1)} : std::vector<Formula>{index(j + 1), index(k + 1)};
}

}  // namespace

bool NamedForces::has_only_vector_effects(const model::Force& force) {
  return std::all_of(force.effects.begin(), force.effects.end(), [](const model::Effect& e) {
    return e.load_type != LoadType::work && e.load_type != LoadType::component;
  });
}

bool NamedForces::add_generalised_force(std::uint32_t j, std::uint32_t k, std::uint32_t i,
                                        std::vector<Formula>& terms) {
  const model::Effect& effect = m_.model->forces[j].effects[k];
  if (effect.load_type == LoadType::acceleration || effect.load_type == LoadType::potential) return true;  // in U
  const std::vector<Formula> of = lower_index(j, k);
  const bool moment = effect.load_type == LoadType::moment;
  const Formula F = mark(moment ? "bold M" : "bold F", of), s = mark("bold s", of);
  if (moment && std::none_of(m_.body_rotations.begin(), m_.body_rotations.end(),
                             [&](const mechanics::BodyRotation& spin) { return spin.frame == effect.index; }))
    return false;
  if (!std::count(effects_.begin(), effects_.end(), std::pair(j, k))) {
    const std::string& name = m_.model->forces[j].name;
    if (effect.load_type == LoadType::damping) {
      const std::optional<Formula> between = line(j, k), c = scalar(effect.value);
      if (!between || !c) return false;
      const Formula part = reading::fraction(dot_product(s, dotted(s)), dot_product(s, s));
      callbacks_.define("force", name, reading::relation({F, reading::negative(reading::product({*c, part, s}))}));
    } else {
      const std::optional<Formula> value = vector(effect.value), at = moment ? std::optional(F) : vector(effect.at);
      if (!value || !at) return false;
      if (!moment) callbacks_.define("point", name, reading::relation({s, *at}));
      callbacks_.define(moment ? "moment" : "force", name, reading::relation({F, *value}));
    }
    effects_.emplace_back(j, k);
  }
  terms.push_back(dot_product(
      F, moment ? partial(mark("bold omega", {index(effect.index)}), coordinate(i, 1)) : partial(s, coordinate(i, 0))));
  return true;
}

std::optional<Formula> NamedForces::line(std::uint32_t j, std::uint32_t k) {
  const model::Force& force = m_.model->forces[j];
  const model::Effect& effect = force.effects[k];
  const std::optional<Formula> a = vector(effect.at), b = vector(effect.other);
  if (!a || !b) return std::nullopt;
  Formula s = mark("bold s", lower_index(j, k));
  std::vector<Formula> terms{*a};
  if (!reading::is_zero(*b)) terms.push_back(reading::negative(*b));
  callbacks_.define("line", force.name, reading::relation({s, reading::sum(std::move(terms))}));
  return s;
}

std::optional<Formula> NamedForces::spring_energy(std::uint32_t j) {
  const model::Force& force = m_.model->forces[j];
  const forces::LinearSpring& keys = forces::find(force.kind)->linear_spring;
  const model::NodeId stiffness = force.value(keys.stiffness), length = force.value(keys.length);
  std::vector<Formula> terms;
  for (std::uint32_t k = 0; k < force.effects.size(); ++k) {
    const model::Effect& effect = force.effects[k];
    if (effect.load_type == LoadType::acceleration) return std::nullopt;
    if (effect.load_type != LoadType::potential) continue;  // no energy
    if (effect.other == model::no_node || stiffness == model::no_node) return std::nullopt;
    const std::optional<Formula> s = line(j, k), c = scalar(stiffness),
                                 free = length == model::no_node ? reading::number(0) : scalar(length);
    if (!s || !c || !free) return std::nullopt;
    Formula square = dot_product(*s, *s);
    if (!reading::is_zero(*free)) {
      Formula distance = reading::make_formula(FormulaKind::call, {square});
      distance.op = symbolic::Op::sqrt;
      square = reading::make_formula(
          FormulaKind::power, {reading::sum({std::move(distance), reading::negative(*free)}), reading::number(2)});
    }
    // A single numeric factor in front.
    if (c->kind == FormulaKind::number)
      terms.push_back(reading::product({reading::number(c->number / 2), std::move(square)}));
    else
      terms.push_back(
          reading::product({reading::fraction(reading::number(1), reading::number(2)), *c, std::move(square)}));
  }
  if (terms.empty()) return std::nullopt;
  return reading::sum(std::move(terms));
}

// As written in the model, unless constraints would have to be imposed on it.
std::optional<Formula> NamedForces::scalar(model::NodeId node) {
  const Ref lowered = mechanics::lower_scalar(m_, node);
  if (std::optional<Formula> written = callbacks_.as_written(node, lowered)) return written;
  return callbacks_.read(lowered);
}

// In terms of named vectors with their definitions; else components along E1, E2, E3.
std::optional<Formula> NamedForces::vector(model::NodeId node) {
  VectorFormula by_names(m_, [this](model::NodeId factor) { return scalar(factor); });
  if (std::optional<Formula> formula = by_names(node)) {
    for (const std::uint32_t place : by_names.places()) {
      if (!define_point(place)) return std::nullopt;
    }
    return formula;
  }
  const Vec3 components = mechanics::lower_vector(m_, node);
  std::vector<Formula> written, axes;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::optional<Formula> component = callbacks_.read(components[k]);
    if (!component) return std::nullopt;
    written.push_back(*component);
    axes.push_back(mark("E", {index(k + 1)}));
  }
  std::vector<Formula> sum;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!reading::is_zero(written[k])) sum.push_back(reading::product({written[k], axes[k]}));
  }
  return reading::sum(std::move(sum));
}

// Defines r of a place without a mass.
bool NamedForces::define_point(std::uint32_t place) {
  const auto is_there = [place](const mechanics::PointMass& mass) { return mass.place == place; };
  if (std::any_of(m_.masses.begin(), m_.masses.end(), is_there) || std::count(points_.begin(), points_.end(), place))
    return true;
  points_.push_back(place);
  const std::optional<Formula> written = vector(m_.model->places[place].position);
  if (written)
    callbacks_.define("position", m_.model->places[place].name,
                      reading::relation({mark("r", {index(place)}), *written}));
  return written.has_value();
}

}  // namespace eomgen::print
