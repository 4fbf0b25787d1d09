// SPDX-License-Identifier: GPL-3.0-or-later
// A start that meets the constraints in all digits. One that is rounded to binary64 is beside them by its last digit,
// and the equations of motion keep what is beside: another motion, which singular places of the constraints tear away
// from the right one.
#pragma once

#include <cln/float.h>

#include <vector>

#include "program/program.hpp"

namespace eomgen::reference {

/// x = (q, qdot, ..) of n coordinates, moved least, to psi = 0 and then A qdot + b = 0, the results of `constraints`.
std::vector<cln::cl_F> consistent(const program::Function& constraints, std::size_t n, const cln::cl_F& t,
                                  std::vector<cln::cl_F> x, const std::vector<double>& p, int digits);

}  // namespace eomgen::reference
