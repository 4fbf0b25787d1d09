// SPDX-License-Identifier: GPL-3.0-or-later
// Which forces have a potential: the curl of their generalised components, eq. (2.20) in the coordinates of the model.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::derive {

enum class Verdict { yes, no, unknown };
const char* name(Verdict verdict);

struct ForceClass {
  std::string name;
  Verdict conservative = Verdict::unknown;
  bool has_potential = false;  // then `potential` is what entered U
  symbolic::Ref potential;
  std::string reason;          // one sentence where the verdict is not yes
};

/// One entry per Model::forces entry.
std::vector<ForceClass> classify_forces(mechanics::Mechanics& mechanics);

}  // namespace eomgen::derive
