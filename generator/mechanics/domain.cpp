// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/domain.hpp"

#include <cln/float.h>
#include <cln/real.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "mechanics/vanishes.hpp"
#include "symbolic/arithmetic.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::Dag;

constexpr const char* out_of_range = "it is larger than the largest double, 1.8e308";

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

/// The reason why an expression of parameters alone has no value that a double holds; empty if it has one, or if other
/// symbols occur.
std::string why_no_number(const Dag& dag, Ref expression, const ParameterValue& parameter) {
  static const cln::cl_R pole = cln::expt(cln::cl_RA(10), 30);  // a pole after rounding
  static const cln::cl_R largest = cln::rational(cln::cl_float(std::numeric_limits<double>::max()));
  const std::vector<symbolic::Symbol> symbols = dag.symbols({expression});
  const auto moves = [](const symbolic::Symbol& symbol) { return symbol.kind != symbolic::SymbolKind::parameter; };
  if (std::any_of(symbols.begin(), symbols.end(), moves)) return "";
  const bool has_parameters = !symbols.empty();
  const auto value_of = [&](const symbolic::Symbol& symbol) { return parameter(symbol.index); };
  try {
    const cln::cl_R value = symbolic::evaluate(dag, {expression}, value_of, parameter_digits)[0];
    if (cln::abs(value) > largest && (has_parameters || dag[expression].op != Op::tan)) return out_of_range;
    return dag[expression].op == Op::tan && cln::abs(value) > pole && !has_parameters ? "a tangent at its pole" : "";
  } catch (const std::domain_error& outside) {
    return has_parameters && std::string(outside.what()) != symbolic::exponent_too_large ? "" : outside.what();
  }
}

}  // namespace

void require_nonzero_divisor(const Mechanics& m, Ref divisor, const model::Span& place) {
  if (!is_zero_everywhere(*m.dag, divisor)) return;
  throw Error("mechanics", m.model->where(place), "this divides by 0, at every state and time",
              "check the denominator; of a force between two points that these are not one and the same");
}

void require_nonzero_length(const Mechanics& m, Ref length, const model::Span& place) {
  if (!is_zero_everywhere(*m.dag, length)) return;
  throw Error("mechanics", m.model->where(place),
              "this is the direction of a vector that is 0, at every state and time",
              "give a vector that is not 0, or two points that are not one and the same");
}

void require_value(const Mechanics& m, Ref expression, const model::Span& place, const ParameterValue& parameter) {
  const Dag& dag = *m.dag;
  const symbolic::Node& node = dag[expression];
  const auto is_zero = [&](std::size_t i) { return is_zero_everywhere(dag, node.args[i]); };
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw Error("mechanics", m.model->where(place), what + ", at every state and time", remedy);
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
    case Op::exp:
    case Op::sinh:
    case Op::cosh:
    case Op::power:
    case Op::constant:
    case Op::mul:
    case Op::div:
    case Op::asin:
    case Op::acos: break;
    default: return;
  }
  const std::string why = why_no_number(dag, expression, parameter);
  if (why.empty()) return;
  if (!dag.symbols({expression}).empty()) {
    throw Error("mechanics", m.model->where(place), "this has no value for these parameters: " + why,
                "correct the values of the parameters, or the formula");
  }
  refuse("this has no value: " + why, "check the argument");
}

}  // namespace eomgen::mechanics
