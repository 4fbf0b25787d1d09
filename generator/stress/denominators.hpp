// SPDX-License-Identifier: GPL-3.0-or-later
// The denominators of a function, as text.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "program/program.hpp"

namespace eomgen::stress {

struct Divisor {
  program::Operand operand;
  std::string expression, zero, test;
};

/// Factors of all denominators and pivots, each once, in the order of the code.
std::vector<Divisor> list_divisors(const program::Function& function, const program::Program& program,
                                   const mechanics::Mechanics& mechanics);

}  // namespace eomgen::stress
