// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "conservation/conserved.hpp"
#include "reading/reading.hpp"

namespace eomgen::analysis {

/// Returns a conserved quantity from the display form of approach II, in which functions of time keep their names.
/// Returns nullopt if there is no such form.
std::optional<reading::Sum> express_in_named_functions(const mechanics::Mechanics& mechanics,
                                                       const reading::DisplayForm& form,
                                                       const conservation::ConservedQuantity& conserved);

}  // namespace eomgen::analysis
