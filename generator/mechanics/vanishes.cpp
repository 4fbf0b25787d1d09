// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/vanishes.hpp"

#include <cln/real.h>

#include <algorithm>
#include <stdexcept>

#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::mechanics {

using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;

namespace {

constexpr std::uint64_t points = 4;
constexpr int trial_digits = 40, more_digits = 70;

// The values at a point; none outside the domain of a function, which is inconclusive.
std::vector<cln::cl_R> values_at(const Dag& dag, const std::vector<Ref>& expressions, std::uint64_t point,
                                 int with = trial_digits) {
  try {
    return symbolic::evaluate(
        dag, expressions, [point](const Symbol& symbol) -> cln::cl_R { return symbolic::sample(symbol, point); }, with);
  } catch (const std::domain_error&) {
    return {};
  }
}

/// Whether a value is far above rounding residues of cancelled terms, or small but the same with more digits, as the
/// tail of a narrow bump.
bool is_nonzero(const Dag& dag, Ref expression, std::uint64_t point, const cln::cl_R& value) {
  if (cln::zerop(value)) return false;
  if (cln::abs(value) > cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 30))) return true;
  const std::vector<cln::cl_R> precise = values_at(dag, {expression}, point, more_digits);
  return !precise.empty() && cln::abs(precise[0] - value) < cln::abs(value) / 100000;
}

}  // namespace

bool vanishes(const Dag& dag, const std::vector<Ref>& expressions) {
  if (std::all_of(expressions.begin(), expressions.end(), [&](Ref r) { return dag.is_zero(r); })) return true;
  // An expression may differ beyond a kink: samples on one side prove nothing.
  if (dag.has_kinks(expressions)) return false;
  bool evaluated = false;
  for (std::uint64_t point = 1; point <= points; ++point) {
    const std::vector<cln::cl_R> values = values_at(dag, expressions, point);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (is_nonzero(dag, expressions[i], point, values[i])) return false;
    }
    evaluated = evaluated || !values.empty();
  }
  return evaluated;
}

bool is_somewhere_nonzero(const Dag& dag, Ref expression) {
  for (std::uint64_t point = 1; point <= points; ++point) {
    const std::vector<cln::cl_R> values = values_at(dag, {expression}, point);
    if (!values.empty() && is_nonzero(dag, expression, point, values[0])) return true;
  }
  return false;
}

}  // namespace eomgen::mechanics
