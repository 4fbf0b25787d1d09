// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted code (docs/abi.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eomgen/certificate.hpp"

namespace eomgen {

struct EmitOptions {
  std::string target = "cpp";  // of targets()
  Approach approach = Approach::automatic;
  /// "auto", "multipliers", "nullspace" or "chaplygin": how constraints that stay are solved.
  std::string form = "auto";
  std::vector<std::string> with = {};  // functions beside rhs: "jac", "mass", "outputs", ... (docs/commands.md, emit)
  std::vector<std::string> outputs = {};  // names for the function `outputs`
  std::vector<std::string> fix = {};      // parameters that become numbers
  std::uint64_t seed = 1;
  std::string real = "double";  // or "float": single precision (docs/abi.md, "Single precision")
};

struct SourceFile {
  std::string name;  // without a folder
  std::string text;
};

struct Sources {
  std::vector<SourceFile> files;
  std::string route, approach, form;
  std::size_t flops = 0;    // of rhs
  std::string certificate;  // the summary; what fails is not emitted
  double single_error =
      0;  // in single precision: how far rhs is off at the states of the self test, by its largest entry
};

/// Names that EmitOptions::target takes.
std::vector<std::string> targets();

}  // namespace eomgen
