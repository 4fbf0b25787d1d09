// SPDX-License-Identifier: GPL-3.0-or-later
// Which forces have a potential: the curl of their generalised components, eq. (2.20) in the coordinates of the model,
// and the work along closed paths around what is singular. Theory: docs/theory.md, "Force fields".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conservation/potential.hpp"

namespace eomgen::conservation {

enum class Verdict { yes, no, unknown };
const char* name(Verdict verdict);

struct ForceClass {
  std::string name;
  Verdict conservative = Verdict::unknown;
  /// What entered U, and what was found of the rest; where `many_valued`, of a region that does not go around the
  /// singular points.
  std::optional<symbolic::Ref> potential;
  bool in_energy = false;  // the whole force is in U
  bool many_valued = false;
  std::vector<DomainCondition> domain;     // of the potential
  std::string reason;                      // one sentence where the verdict is not yes, or there is more to say
  std::optional<symbolic::Ref> work = {};  // of one turn around, where many_valued and known
};

/// One entry per Model::forces entry.
std::vector<ForceClass> classify_forces(mechanics::Mechanics& mechanics);

}  // namespace eomgen::conservation
