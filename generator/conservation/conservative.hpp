// SPDX-License-Identifier: GPL-3.0-or-later
// Tests which forces have a potential: by the curl of their generalised components, eq. (2.20) in the coordinates of
// the model, and by the work along closed paths around singular points. Theory: docs/theory.md, "Force fields".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conservation/potential.hpp"

namespace eomgen::conservation {

enum class ConservativeVerdict { yes, no, unknown };
const char* name(ConservativeVerdict verdict);

struct ForceClassification {
  std::string name;
  ConservativeVerdict conservative = ConservativeVerdict::unknown;
  /// The part in U and the potential found for the rest. If `many_valued`, it holds in a region that does not enclose
  /// the singular points.
  std::optional<symbolic::Ref> potential;
  bool in_energy = false;  // the whole force is in U
  bool many_valued = false;
  std::vector<DomainCondition> domain;     // of the potential
  std::string reason;                      // one sentence if the verdict is not yes, or needs a remark
  std::optional<symbolic::Ref> work = {};  // of one turn around a singular point, if many_valued and known
};

/// One entry per Model::forces entry.
std::vector<ForceClassification> classify_forces(mechanics::Mechanics& mechanics);

}  // namespace eomgen::conservation
