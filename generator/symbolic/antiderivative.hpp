// SPDX-License-Identifier: GPL-3.0-or-later
// Integrals that can be seen: of sums of terms c u^n u' (with u a part of the term), of powers times such terms by
// parts, of even powers of sines and cosines. What is found is differentiated again and proven; the rest is not found.
#pragma once

#include <optional>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Of c u'/u: c log u, or c log(u^2)/2, which has a value where u is negative too.
enum class Logarithms { positive, any_sign };

/// F with dF/dx = e, proven; nothing where none was found.
std::optional<Ref> antiderivative(Dag& dag, Ref e, Symbol x, Logarithms logarithms = Logarithms::positive);

/// An expression of which it is proven that it does not depend on `x`, written without it: simplified, or its value at
/// some x. Nothing where neither works.
std::optional<Ref> without(Dag& dag, Ref expression, Symbol x);

bool depends_on(const Dag& dag, Ref expression, Symbol x);

/// A term of a sum as base^exponent factors; a constant factor is a base with exponent 1.
std::vector<std::pair<Ref, long>> factors_of(Dag& dag, Ref term);
/// The terms of nested sums and differences.
std::vector<Ref> terms_of(Dag& dag, Ref sum);

}  // namespace eomgen::symbolic
