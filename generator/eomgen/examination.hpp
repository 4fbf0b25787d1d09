// SPDX-License-Identifier: GPL-3.0-or-later
// What a model is before anything moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

struct ConstraintClass {
  std::string name, kind;               // "holonomic" or "velocity"
  std::string integrable;               // "yes", "no", "unknown"
  std::optional<std::string> integral;  // an equation
  bool redundant = false;               // it has no multiplier
  std::string use, reason;              // what becomes of it; of `integrable`
};

struct ForceClass {
  std::string name, conservative;  // "yes", "no", "unknown"
  std::optional<Formula> potential;
  std::string reason;
};

struct ConservedQuantity {
  std::string name, title;
  Formula expression;
  bool proven = false;  // else shown by numbers
};

/// What `eomgen check` finds.
struct Examination {
  std::vector<std::string> coordinates;  // all
  std::vector<std::string> eliminated;   // those that constraints fix
  long degrees_of_freedom = 0;
  std::vector<ConstraintClass> constraints;
  std::vector<ForceClass> forces;
  std::vector<ConservedQuantity> conserved;
  std::vector<Formula> singular;  // sets where an approach fails; `role` says which
  std::vector<LeftOut> left_out;
};

}  // namespace eomgen
