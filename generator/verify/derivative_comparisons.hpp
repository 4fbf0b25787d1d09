// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of derivatives with differences. In: the values of a function of the C ABI. Out: their differences from
// central differences of the right-hand side, of the energies and of M.
#pragma once

#include <string>

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// The values of a function of the ABI, and all that they are compared by.
struct FunctionAt {
  const ProgramForm& program;
  const system::EquationSystem& system;
  const Oracle& oracle;
  const SymbolValues& symbols;  // of `at`
  const AbiArguments& at;
  const std::string& function;
  const AbiResults &values, &sizes;  // sizes: of the terms of each value
  ComparisonTable& table;
};

/// The size of each value with its rounding error; empty where a bound of it is not finite: too close to another
/// branch.
AbiResults value_sizes(const ProgramForm& program, const std::string& function, const AbiArguments& at,
                       const AbiResults& values, const Oracle& oracle);

/// Compares the derivative that this function gives; false if it gives none.
bool compare_derivative(const FunctionAt& given);

}  // namespace eomgen::verify
