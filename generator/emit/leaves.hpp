// SPDX-License-Identifier: GPL-3.0-or-later
// Where a function finds what it does not compute: entries of its arguments, and what `mode` says.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"
#include "emit/uses.hpp"

namespace eomgen::emit {

/// The leaves of one kind, and their values.
struct Loaded {
  program::Slot slot;
  std::vector<std::pair<std::uint32_t, std::string>> values;  // never empty
};

/// The leaves of a function that need a name of their own, and what they are loaded from: the arguments of one state,
/// or the lanes of `block` (templates/batch) where the dialect has lanes.
std::vector<Loaded> loaded(const std::string& function, const Leaves& leaves, const ModelNames& names,
                           const EmissionContext& context, const Dialect& dialect, const std::string& block);

}  // namespace eomgen::emit
