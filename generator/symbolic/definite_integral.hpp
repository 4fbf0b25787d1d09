// SPDX-License-Identifier: GPL-3.0-or-later
// The integral of a function of time over [from, t] in closed form, where one of these rules gives it: polynomials,
// powers of linear functions, exponentials, sines and cosines of linear functions, their products with polynomials,
// products of exponentials and sines, and sums of all these. Else by an antiderivative (antiderivative.hpp) that is
// continuous and has a value wherever the integrand has one.
#pragma once

#include <optional>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Everything but `time` is constant. Nothing where no closed form is found. A factor of t inside of a sine or an
/// exponential is taken not to be 0: where its value is, the result has none.
std::optional<Ref> definite_integral(Dag& dag, Ref integrand, Symbol time, Ref from);

}  // namespace eomgen::symbolic
