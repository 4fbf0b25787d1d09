// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the functions of the C ABI (docs/abi.md) for a Program, computed without a compiler in many digits. The
// self-test of emitted code and `verify` compare compiled code with these values.
#pragma once

#include <cln/real.h>

#include <optional>
#include <string>
#include <vector>

#include "program/interpret.hpp"

namespace eomgen::program {

/// One list for each array that the function writes.
using AbiResults = std::vector<std::vector<cln::cl_R>>;

/// Arguments of a function of the ABI. `at.side` and `at.w` are unused.
struct AbiArguments {
  Arguments<cln::cl_R> at;
  std::vector<cln::cl_R> default_inputs;  // the inputs of mass and constraints
  int order = 0;                          // for taylor
};

/// The program for the charts of a mode (docs/abi.md, "Modes"); nullptr if there is none.
const Program* program_in_charts(const Program& program, const std::vector<int>& mode);

/// Functions of the program: "rhs", "jac", .., "prepare", "rhs_prepared", "taylor".
std::vector<std::string> abi_function_names(const Program& program);

/// Returns nothing if the function has no value there: outside its domain, singular, no solution of the friction law,
/// or a mode of other charts.
std::optional<AbiResults> abi_values(const Program& program, const std::string& function, const AbiArguments& arguments,
                                     int digits);

/// Error bounds of binary64 (rounding.hpp), in the same lists; for taylor an estimate.
std::vector<std::vector<double>> abi_error_bounds(const Program& program, const std::string& function,
                                                  const AbiArguments& arguments);

}  // namespace eomgen::program
