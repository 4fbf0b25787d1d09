// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "conservation/conserved.hpp"
#include "reading/reading.hpp"

namespace eomgen::analysis {

/// A conserved quantity from the reading form of Approach II, where functions of time keep their names; nothing if it
/// has no such form.
std::optional<reading::Sum> in_named_functions(const mechanics::Mechanics& mechanics, const reading::ReadingForm& form,
                                               const conservation::Conserved& conserved);

}  // namespace eomgen::analysis
