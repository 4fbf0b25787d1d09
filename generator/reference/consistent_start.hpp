// SPDX-License-Identifier: GPL-3.0-or-later
// A start that satisfies the constraints in all digits. A start in binary64 violates them in its last digit, and the
// equations of motion preserve this defect. The result is a slightly different motion, which diverges from the true one
// near singular configurations.
#pragma once

#include <cln/float.h>

#include <vector>

#include "program/program.hpp"

namespace eomgen::reference {

/// Projects x = (q, qdot, ..) of n coordinates, by the least change, onto psi = 0 and then A qdot + b = 0, the results
/// of `constraints`.
std::vector<cln::cl_F> make_consistent(const program::Function& constraints, std::size_t n, const cln::cl_F& t,
                                       std::vector<cln::cl_F> x, const std::vector<double>& p, int digits);

}  // namespace eomgen::reference
