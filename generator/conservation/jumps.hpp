// SPDX-License-Identifier: GPL-3.0-or-later
// Jumps of an energy. A derivative is 0 on either side of a step and does not show the impulse or the work there.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::conservation {

/// The functions at whose zeros `roots` may jump: a of sign(a), a - b of `if` with a < b. abs, min and max have kinks
/// but no jumps.
std::vector<symbolic::Ref> jump_surfaces(symbolic::Dag& dag, const std::vector<symbolic::Ref>& roots);

}  // namespace eomgen::conservation
