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

bool vanishes(const Dag& dag, const std::vector<Ref>& expressions) {
  if (std::all_of(expressions.begin(), expressions.end(), [&](Ref r) { return dag.is_zero(r); })) return true;
  // Beyond a kink an expression may be something else: sampling one side proves nothing.
  if (dag.has_kinks(expressions)) return false;
  const cln::cl_R small = cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 30));
  int evaluated = 0;
  for (std::uint64_t point = 1; point <= 4; ++point) {
    const auto value = [point](const Symbol& symbol) -> cln::cl_R { return symbolic::sample(symbol, point); };
    try {
      for (const cln::cl_R& r : symbolic::evaluate(dag, expressions, value, 40)) {
        if (cln::abs(r) > small) return false;
      }
      ++evaluated;
    } catch (const std::domain_error&) {
      continue;  // outside the domain of a function there: this point says nothing
    }
  }
  return evaluated > 0;
}

}  // namespace eomgen::mechanics
