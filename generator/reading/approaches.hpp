// SPDX-License-Identifier: GPL-3.0-or-later
// The two approaches; neither calls the other. In: the rotations without constraints imposed. Both throw
// work::BudgetExceeded.
#pragma once

#include "reading/lagrangian.hpp"

namespace eomgen::reading {

void derive_approach_one(const mechanics::Mechanics& mechanics, GinacBridge& bridge,
                         const std::vector<DisplayRotation>& body_rotations, DisplayForm& form);
void derive_approach_two(const mechanics::Mechanics& mechanics, GinacBridge& bridge,
                         const std::vector<DisplayRotation>& body_rotations, DisplayForm& form);

}  // namespace eomgen::reading
