// SPDX-License-Identifier: GPL-3.0-or-later
// Where an energy jumps: a derivative is 0 on either side of a step, and says nothing of the impulse or the work on it.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::conservation {

/// The functions at whose zeros `roots` may jump: a of sign(a), a - b of `if` with a < b. abs, min and max bend, but do
/// not jump.
std::vector<symbolic::Ref> jump_surfaces(symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots);

}  // namespace eomgen::conservation
