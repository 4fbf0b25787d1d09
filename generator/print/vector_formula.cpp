// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/vector_formula.hpp"

#include "print/formulas.hpp"

namespace eomgen::print {

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

}  // namespace

std::optional<Formula> VectorFormula::operator()(model::NodeId vector) {
  Terms all = terms(vector);
  if (!all) return std::nullopt;
  return reading::sum(std::move(*all));
}

/// An axis has a letter if the inertia of its body refers to it.
std::optional<Formula> VectorFormula::axis(const model::Node& node) {
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

Terms VectorFormula::terms(model::NodeId id) {
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

}  // namespace eomgen::print
