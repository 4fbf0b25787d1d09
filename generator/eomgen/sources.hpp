// SPDX-License-Identifier: GPL-3.0-or-later
// Generated source code (docs/abi.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eomgen/certificate.hpp"

namespace eomgen {

/// Options of Model::emit().
struct EmitOptions {
  std::string target = "cpp";  // one of targets()
  Approach approach = Approach::automatic;
  /// How the remaining constraints are solved: "auto", "multipliers", "nullspace" or "chaplygin".
  std::string form = "auto";
  std::vector<std::string> extra_functions =
      {};                                 // functions in addition to rhs: "jac", "mass", .. (docs/commands.md, emit)
  std::vector<std::string> outputs = {};  // outputs computed by the function `outputs`
  std::vector<std::string> fixed_parameters = {};  // parameters replaced by their numbers
  std::uint64_t seed = 1;
  std::string real_type = "double";  // "double" or "float" (docs/abi.md, "Single precision")
};

/// Result of Model::emit().
struct Sources {
  std::vector<SourceFile> files;
  std::string formulation, approach, form;
  std::size_t flops = 0;    // floating-point operations of rhs
  std::string certificate;  // summary of the verification, which passed
  /// Single precision: error of rhs at the states of the self test, relative to its largest entry. Otherwise 0.
  double single_precision_error = 0;
};

/// Names of all targets, for EmitOptions::target.
std::vector<std::string> targets();

}  // namespace eomgen
