// SPDX-License-Identifier: GPL-3.0-or-later
// In: the subjects and one state. Out: the difference of each pair there; a ComparisonTable collects the largest over
// all states.
#pragma once

#include <string>
#include <vector>

#include "oracle/dalembert.hpp"
#include "verify/certificate.hpp"

namespace eomgen::verify {

enum class Arithmetic { precise, binary64 };

inline constexpr const char* oracle_name = "d'Alembert";

/// Binary64 has 16 digits. A thousand operations and cancellation leave 11 of them, relative to the terms.
inline constexpr double tolerance_binary64 = 1e-11;

/// The largest difference of each pair so far.
class ComparisonTable {
 public:
  explicit ComparisonTable(int digits) : digits_(digits) {}
  void record(const std::string& a, const std::string& b, bool shares_code, double relative_difference,
              Arithmetic arithmetic = Arithmetic::precise);
  void count_point() { ++points_; }
  std::size_t points() const { return points_; }
  int digits() const { return digits_; }
  const std::vector<Comparison>& comparisons() const { return rows_; }

 private:
  int digits_;
  std::size_t points_ = 0;
  std::vector<Comparison> rows_;
};

/// Compares all subjects at one state. Throws std::domain_error if one of them has no value or is nearly singular
/// there.
void compare_at(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Oracle& oracle,
                const State& state, ComparisonTable& tally);

}  // namespace eomgen::verify
