// SPDX-License-Identifier: GPL-3.0-or-later
// Loads of values that a function does not compute: entries of its arguments, and values decoded from `mode`.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"
#include "emit/uses.hpp"

namespace eomgen::emit {

/// The leaves of one kind and their values.
struct LeafLoads {
  program::Slot slot;
  std::vector<std::pair<std::uint32_t, std::string>> values;  // never empty
};

/// The leaves of a function that need a name, and the expressions that load them: from the arguments of one state, or
/// from the lanes of `block` (templates/batch) if the dialect has lanes.
std::vector<LeafLoads> leaf_loads(const std::string& function, const Leaves& leaves, const ModelNames& names,
                                  const EmissionContext& context, const Dialect& dialect, const std::string& block);

}  // namespace eomgen::emit
