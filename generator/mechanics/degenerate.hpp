// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints written as a square or a higher power, expanded or not. Their gradient vanishes where they hold, so no
// force along it could enforce them. The test is numerical and does not take the expression apart.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::mechanics {

/// Runs Newton's method from a few points along the gradient with respect to the coordinates `of`. If all iterations
/// that approach psi = 0 converge only linearly, the roots are multiple. False if no iteration approaches psi = 0.
bool is_degenerate(const symbolic::Dag& dag, symbolic::Ref psi, const std::vector<symbolic::Symbol>& of,
                   const std::vector<symbolic::Ref>& gradient);

}  // namespace eomgen::mechanics
