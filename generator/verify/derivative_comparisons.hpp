// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons of derivatives with differences. In: the values of a function of the C ABI. Out: their differences from
// central differences of the right-hand side, of the energies and of M.
#pragma once

#include <memory>
#include <string>

#include "verify/comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {

/// The size of each value with its rounding error; empty where a bound of it is not finite: too close to another
/// branch.
AbiResults value_sizes(const ProgramForm& program, const std::string& function, const AbiArguments& at,
                       const AbiResults& values, const Oracle& oracle);

/// Comparisons at one state. Functions share the differences that they are compared with.
class DerivativeComparisons {
 public:
  /// `symbols`: of `at`. All arguments must outlive the object.
  DerivativeComparisons(const ProgramForm& program, const system::EquationSystem& system, const Oracle& oracle,
                        const SymbolValues& symbols, const AbiArguments& at, ComparisonTable& table);
  ~DerivativeComparisons();

  /// Compares the derivative that this function gives; false if it gives none. `sizes`: of the terms of each value.
  bool operator()(const std::string& function, const AbiResults& values, const AbiResults& sizes);

 private:
  class Comparison;
  std::unique_ptr<Comparison> comparison_;
};

}  // namespace eomgen::verify
