// SPDX-License-Identifier: GPL-3.0-or-later
// How the values of a Function are used: by this they get names, places in parts, and loads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "program/program.hpp"

namespace eomgen::emit {

/// Operands that are no values of instructions.
using Leaves = std::set<std::pair<program::Slot, std::uint32_t>>;

struct Uses {
  std::vector<std::size_t> part;     // of each instruction: the part that it is in (parts.hpp)
  std::vector<std::uint32_t> count;  // of each instruction: how often its value is written
  std::vector<bool> kept;            // of each instruction: a later part needs its value
  std::vector<Leaves> leaves;        // of each part
};
Uses uses_of(const program::Function& function);

}  // namespace eomgen::emit
