// SPDX-License-Identifier: GPL-3.0-or-later
// Optimisations of gcc -O2 that change bits of results of the emitted C: values that depend on constants alone are
// rounded once, where the C library may be wrong in the last place; sines and cosines of arctangents become algebraic
// (gcc/match.pd). Functions that are cut into parts (program/parts.hpp) are optimised part by part.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "program/program.hpp"

namespace eomgen::jit {

/// The constant value of each instruction, if it has one. `inputs`: values of the inputs where a function takes none.
std::vector<std::optional<double>> fold_constants(const program::Function& function, std::span<const double> constants,
                                                  const std::optional<std::vector<double>>& inputs);

/// The arctangents that nothing but one sine or cosine uses.
std::vector<bool> absorbed_arctangents(const program::Function& function);

}  // namespace eomgen::jit
