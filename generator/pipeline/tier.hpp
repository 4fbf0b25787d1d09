// SPDX-License-Identifier: GPL-3.0-or-later
// Ways to make the functions of a program callable. Results do not depend on the choice.
#pragma once

#include <string>
#include <vector>

#include "program/program.hpp"

namespace eomgen::pipeline {

enum class Tier {
  automatic,  // chosen by the number of operations that the run is known to take
  jit,        // machine code in memory (jit/machine_code.hpp), at once
  compiled    // emitted C through the C compiler
};

std::vector<std::string> tier_names();     // "auto", "jit", "compiled"
std::string name(Tier tier);               // one of these names
Tier parse_tier(const std::string& text);  // from one of these names; throws Error

struct TierChoice {
  Tier tier = Tier::compiled;  // never automatic
  std::string reason;
  bool was_asked = false;  // the caller chose it
};

/// Resolves Tier::automatic. `steps`: the number of fixed steps of the run; 0 if steps are chosen. The choice depends
/// on counts alone, so that every process makes the same one, and on whether a C compiler runs. Throws
/// Error{ErrorKind::tool} if this build lacks Tier::jit and it is asked for.
TierChoice choose_tier(Tier asked, const program::Program& program, double steps);

}  // namespace eomgen::pipeline
