// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical evaluation of expressions: in binary64, or with CLN at any precision.
#pragma once

#include <cln/real.h>

#include <functional>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Values of `roots` with CLN floats of `digits` decimal digits. Throws std::domain_error outside the real domain of a
/// function and for a division by zero.
std::vector<cln::cl_R> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                                const std::function<cln::cl_R(const Symbol&)>& lookup, int digits);

/// The same in binary64; NaN if there is no value.
std::vector<double> evaluate(const Dag& dag, const std::vector<Ref>& roots,
                             const std::function<double(const Symbol&)>& lookup);

}  // namespace eomgen::symbolic
