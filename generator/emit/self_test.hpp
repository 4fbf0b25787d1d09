// SPDX-License-Identifier: GPL-3.0-or-later
// The test vectors and the body of NAME_selftest. It compares every function of the file with high-precision values at
// several states and parameters.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The values of all functions at t, x, p, u, mode of `at`, the `index`-th vector. Returns nothing if the right-hand
/// side has no value there. Large functions are tested at the first vectors only, so that the self-test is not larger
/// than the code.
std::optional<TestVector> test_vector(const program::Program& program, const EmissionContext& context, TestVector at,
                                      std::size_t index);

/// Whether the first vector is the default state with the default parameters and inputs.
bool begins_with_defaults(const EmissionContext& context, bool single);

/// Names that differ between C and C++.
struct SelfTestNames {
  std::function<std::string(const std::string&)> function_name;  // name of a function of the ABI in code: "NAME_rhs"
  std::string comparison;                                        // name of the comparison function
  std::string null_pointer;
  bool start = false;  // whether the file has the function start
};

std::string selftest_body(const program::Program& program, const EmissionContext& context, const SelfTestNames& names,
                          const Dialect& dialect);

/// The comparison function: whether an array differs from its expected values by more than expected[0]. Empty if there
/// are no vectors.
std::string selftest_comparison(const EmissionContext& context, const SelfTestNames& names, const Dialect& dialect);

}  // namespace eomgen::emit
