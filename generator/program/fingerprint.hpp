// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "program/program.hpp"

namespace eomgen::program {

/// Everything that a program calculates, as text: two programs with one fingerprint give the same values. For keys of
/// what is kept.
std::string fingerprint(const Program& program);

}  // namespace eomgen::program
