// SPDX-License-Identifier: GPL-3.0-or-later
// Elementary integration: sums of terms c u^n u' (with u a part of the term), powers times such terms by parts, and
// even powers of sines and cosines. A result is returned only if its derivative is proven to be the integrand.
#pragma once

#include <optional>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// The integral of c u'/u: c log u, or c log(u^2)/2, which is also defined for negative u.
enum class LogarithmDomain { positive, any_sign };

/// F with dF/dx = e, proven; nothing if none was found.
std::optional<Ref> antiderivative(Dag& dag, Ref e, Symbol x, LogarithmDomain logarithms = LogarithmDomain::positive);

/// Rewrites an expression that is proven to be independent of `x` without it: simplified, or evaluated at some x.
/// Nothing if neither works.
std::optional<Ref> eliminate_symbol(Dag& dag, Ref expression, Symbol x);

bool depends_on(const Dag& dag, Ref expression, Symbol x);

/// The factors base^exponent of a term; a constant factor is a base with exponent 1.
std::vector<std::pair<Ref, long>> factors_of(Dag& dag, Ref term);
/// The terms of nested sums and differences.
std::vector<Ref> terms_of(Dag& dag, Ref sum);

}  // namespace eomgen::symbolic
