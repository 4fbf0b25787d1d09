// SPDX-License-Identifier: GPL-3.0-or-later
// Structural analysis of a model: degrees of freedom, classes of constraints and forces, conserved quantities,
// singular sets.
#pragma once

#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

/// A quantity that is constant along every motion.
struct ConservedQuantity {
  std::string name, title;
  Formula expression;
  bool proven = false;                       // symbolically; false: confirmed numerically only
  std::vector<std::string> where_zero = {};  // parameters that must be 0 for it, as they are; usually none
};

/// Result of `eomgen check`.
struct Examination {
  std::vector<std::string> coordinates;            // all
  std::vector<ExaminedQuantity> coordinate_units;  // of the same
  std::vector<ExaminedQuantity> parameters, inputs;
  std::vector<std::string> eliminated;  // by constraints
  long degrees_of_freedom = 0;
  std::vector<ConstraintClass> constraints;
  std::vector<ForceClass> forces;
  std::vector<ConservedQuantity> conserved;
  std::vector<Formula> singular;  // sets on which an approach fails; `role` is that approach
  std::vector<LeftOut> left_out;
};

}  // namespace eomgen
