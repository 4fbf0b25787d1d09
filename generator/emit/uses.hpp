// SPDX-License-Identifier: GPL-3.0-or-later
// Usage of the values of a Function, which determines names, parts and loads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "program/program.hpp"

namespace eomgen::emit {

/// Operands that are not values of instructions.
using Leaves = std::set<std::pair<program::Slot, std::uint32_t>>;

struct Uses {
  std::vector<std::size_t> part;     // per instruction: its part (program/parts.hpp)
  std::vector<std::uint32_t> count;  // per instruction: how often its value is printed
  std::vector<bool> needed_later;    // per instruction: whether a later part needs its value
  std::vector<Leaves> leaves;        // per part
};
Uses count_uses(const program::Function& function);

}  // namespace eomgen::emit
