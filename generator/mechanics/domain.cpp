// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/domain.hpp"

#include <cln/real.h>

#include <set>
#include <stdexcept>

#include "mechanics/vanishes.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::Dag;
using symbolic::Op;

/// Whether a product has a factor that vanishes identically. Rounding residues would be larger under a root.
bool is_zero_everywhere(const Dag& dag, Ref expression) {
  std::vector<Ref> open{expression};
  std::set<Ref> seen;
  while (!open.empty()) {
    const Ref factor = open.back();
    open.pop_back();
    if (!seen.insert(factor).second) continue;
    const symbolic::Node& node = dag[factor];
    switch (node.op) {
      case Op::mul: open.push_back(node.args[1]); [[fallthrough]];
      case Op::div:
      case Op::neg:
      case Op::power:
      case Op::sqrt:
      case Op::abs: open.push_back(node.args[0]); break;
      default:
        if (vanishes(dag, {factor})) return true;
    }
  }
  return false;
}

/// The reason why an expression without symbols has no value.
std::string why_no_number(const Dag& dag, Ref expression) {
  constexpr int digits = 40;
  static const cln::cl_R beyond = cln::expt(cln::cl_RA(10), 30);  // a pole after rounding
  const auto nothing = [](const symbolic::Symbol&) -> cln::cl_R { throw std::logic_error("a symbol"); };
  try {
    const cln::cl_R value = symbolic::evaluate(dag, {expression}, nothing, digits)[0];
    return dag[expression].op == Op::tan && cln::abs(value) > beyond ? "a tangent at its pole" : "";
  } catch (const std::domain_error& outside) {
    return outside.what();
  }
}

}  // namespace

void require_nonzero_divisor(const Mechanics& m, Ref divisor, const model::Span& place) {
  if (!is_zero_everywhere(*m.dag, divisor)) return;
  throw Error("mechanics", m.model->where(place), "this divides by 0, whatever the state and the time",
              "check the denominator; of a force between two points that these are not one and the same");
}

void require_nonzero_length(const Mechanics& m, Ref length, const model::Span& place) {
  if (!is_zero_everywhere(*m.dag, length)) return;
  throw Error("mechanics", m.model->where(place),
              "this is the direction of a vector that is 0, whatever the state and the time",
              "give a vector that is not 0, or two points that are not one and the same");
}

void require_value(const Mechanics& m, Ref expression, const model::Span& place) {
  const Dag& dag = *m.dag;
  const symbolic::Node& node = dag[expression];
  const auto is_zero = [&](std::size_t i) { return is_zero_everywhere(dag, node.args[i]); };
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw Error("mechanics", m.model->where(place), what + ", whatever the state and the time", remedy);
  };
  switch (node.op) {
    case Op::sqrt:
      if (is_zero(0))
        refuse("this is the root of 0, which has no derivative", "write 0, or check what it is the root of");
      break;
    case Op::log:
      if (is_zero(0)) refuse("this is the logarithm of 0", "check the argument");
      break;
    case Op::pow:
      if (is_zero(0)) refuse("this is a power of 0", "check the base");
      break;
    case Op::atan2:
      if (is_zero(0) && is_zero(1)) refuse("this is the angle of a direction of length 0", "check the arguments");
      break;
    case Op::tan:
    case Op::asin:
    case Op::acos: break;
    default: return;
  }
  if (!dag.symbols({expression}).empty()) return;
  if (const std::string why = why_no_number(dag, expression); !why.empty())
    refuse("this has no value: " + why, "check the argument");
}

}  // namespace eomgen::mechanics
