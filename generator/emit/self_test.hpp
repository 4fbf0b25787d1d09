// SPDX-License-Identifier: GPL-3.0-or-later
// The vectors of NAME_selftest, and its body. Every function of the file is held against values of high precision at
// states and parameters that differ from one another.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// The functions' values at t, x, p, u, mode of `at`, the `index`-th vector; nothing where the right-hand side has none
/// there. Large functions are held at the first vectors only, so that the size of the self test stays within that of
/// the code.
std::optional<TestVector> test_vector(const program::Program& program, const EmissionContext& context, TestVector at,
                                      std::size_t index);

/// Names that differ between C and C++.
struct SelfTestNames {
  std::function<std::string(const std::string&)> called;  // how a function of the ABI is called: "NAME_rhs"
  std::string differs;                                    // of the comparison
  std::string null;
};

std::string selftest_body(const program::Program& program, const EmissionContext& context, const SelfTestNames& names,
                          const Dialect& dialect);

/// The comparison: whether an array is off its values by more than expected[0]; empty where there are no vectors.
std::string selftest_comparison(const EmissionContext& context, const SelfTestNames& names, const Dialect& dialect);

}  // namespace eomgen::emit
