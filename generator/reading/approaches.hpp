// SPDX-License-Identifier: GPL-3.0-or-later
// The two approaches; neither calls the other. In: the rotations without constraints imposed. Both throw
// work::BudgetExceeded.
#pragma once

#include "reading/lagrangian.hpp"

namespace eomgen::reading {

void approach_one(const mechanics::Mechanics& mechanics, Bridge& bridge, const std::vector<ReadSpin>& spins,
                  DisplayForm& form);
void approach_two(const mechanics::Mechanics& mechanics, Bridge& bridge, const std::vector<ReadSpin>& spins,
                  DisplayForm& form);

}  // namespace eomgen::reading
