// SPDX-License-Identifier: GPL-3.0-or-later
// Splitting of long functions of emitted code, because compile time grows faster than the length of a function.
#pragma once

#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

/// The part of each instruction; sines and cosines that are computed together stay in one part.
std::vector<std::size_t> assign_parts(const Function& function);

}  // namespace eomgen::program
