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
constexpr int digits = 40;

// The values at a point; none outside of the domain of a function, which says nothing.
std::vector<cln::cl_R> values_at(const Dag& dag, const std::vector<Ref>& expressions, std::uint64_t point) {
  try {
    return symbolic::evaluate(dag, expressions, [point](const Symbol& symbol) -> cln::cl_R { return symbolic::sample(symbol, point); }, digits);
  } catch (const std::domain_error&) {
    return {};
  }
}

}  // namespace

bool vanishes(const Dag& dag, const std::vector<Ref>& expressions) {
  if (std::all_of(expressions.begin(), expressions.end(), [&](Ref r) { return dag.is_zero(r); })) return true;
  // Beyond a kink an expression may be something else: sampling one side proves nothing.
  if (dag.has_kinks(expressions)) return false;
  const cln::cl_R small = cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 30));
  bool evaluated = false;
  for (std::uint64_t point = 1; point <= points; ++point) {
    for (const cln::cl_R& r : values_at(dag, expressions, point)) {
      if (cln::abs(r) > small) return false;
      evaluated = true;
    }
  }
  return evaluated;
}

bool is_somewhere_nonzero(const Dag& dag, Ref expression) {
  // Far above what is left of terms that cancel.
  const cln::cl_R plain = cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 10));
  for (std::uint64_t point = 1; point <= points; ++point) {
    for (const cln::cl_R& r : values_at(dag, {expression}, point)) {
      if (cln::abs(r) > plain) return true;
    }
  }
  return false;
}

}  // namespace eomgen::mechanics
