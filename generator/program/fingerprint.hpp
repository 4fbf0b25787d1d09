// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "program/program.hpp"

namespace eomgen::program {

/// Serialises everything that determines the values of a program. Programs with equal fingerprints compute equal
/// values. Used for cache keys.
std::string fingerprint(const Program& program);

}  // namespace eomgen::program
