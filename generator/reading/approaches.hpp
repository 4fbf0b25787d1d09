// SPDX-License-Identifier: GPL-3.0-or-later
// The two approaches; neither calls the other. Both throw work::OverBudget.
#pragma once

#include "reading/lagrangian.hpp"

namespace eomgen::reading {

void approach_one(const mechanics::Mechanics& mechanics, Bridge& bridge, ReadingForm& form);
void approach_two(const mechanics::Mechanics& mechanics, Bridge& bridge, ReadingForm& form);

}  // namespace eomgen::reading
