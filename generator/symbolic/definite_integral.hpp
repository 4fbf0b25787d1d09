// SPDX-License-Identifier: GPL-3.0-or-later
// The integral of a function of time over [from, t] in closed form. Rules cover polynomials, powers of linear
// functions, exponentials, sines and cosines of linear functions, their products with polynomials, products of
// exponentials and sines, and sums of all these. For other functions it uses an antiderivative (antiderivative.hpp)
// that is continuous and defined wherever the integrand is.
#pragma once

#include <optional>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// The integral over `time`; everything else is constant. Nothing if no closed form is found. A factor of t inside a
/// sine or an exponential is assumed to be nonzero: if its value is 0, the result is undefined.
std::optional<Ref> definite_integral(Dag& dag, Ref integrand, Symbol time, Ref from);

}  // namespace eomgen::symbolic
