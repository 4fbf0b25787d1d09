// SPDX-License-Identifier: GPL-3.0-or-later
// What the functions of the C ABI (docs/abi.md) return for a Program, read without a compiler in many digits: what
// compiled code is held against, by its self test and by `verify`.
#pragma once

#include <cln/real.h>

#include <optional>
#include <string>
#include <vector>

#include "program/interpret.hpp"

namespace eomgen::program {

/// One list for each array that the function writes.
using AbiResults = std::vector<std::vector<cln::cl_R>>;

/// Arguments of a function of the ABI. `at.mode` is that of docs/abi.md, with the bits of kinks and charts; `at.side`
/// and `at.w` are not used.
struct AbiArguments {
  Arguments<cln::cl_R> at;
  std::vector<cln::cl_R> default_inputs;  // what mass and constraints see
  int order = 0;                          // of taylor
};

/// The program whose charts a mode names; nullptr: there is none.
const Program* in_charts(const Program& program, int mode);

/// "rhs", "jac", .., "prepare", "rhs_prepared", "taylor": those that the program has.
std::vector<std::string> abi_function_names(const Program& program);

/// Nothing where the function has no value there: outside a domain, singular, no law of friction, not in these charts.
std::optional<AbiResults> abi_values(const Program& program, const std::string& function, const AbiArguments& arguments,
                                     int digits);

/// How far binary64 may be off (rounding.hpp), in the same lists; of taylor an estimate.
std::vector<std::vector<double>> abi_bounds(const Program& program, const std::string& function,
                                            const AbiArguments& arguments);

}  // namespace eomgen::program
