// SPDX-License-Identifier: GPL-3.0-or-later
// Where a function finds what it does not compute: entries of its arguments, and what `mode` says.
#pragma once

#include <cstdint>
#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The value of a leaf, from the arguments of one state. `takes_inputs`: else inputs are at their defaults.
std::string leaf_value(const Dialect& dialect, const ModelNames& names, const EmissionContext& context,
                       program::Slot slot, std::uint32_t index, bool takes_inputs);

/// The same for the lanes of `block` (templates/batch).
std::string leaf_of_lanes(const Dialect& dialect, const EmissionContext& context, const std::string& block,
                          program::Slot slot, std::uint32_t index, bool takes_inputs);

}  // namespace eomgen::emit
