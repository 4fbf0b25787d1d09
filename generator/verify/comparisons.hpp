// SPDX-License-Identifier: GPL-3.0-or-later
// In: the subjects and one state. Out: by how much each pair differs there, collected over the states by a Tally.
#pragma once

#include <string>
#include <vector>

#include "verify/certificate.hpp"
#include "verify/dalembert.hpp"

namespace eomgen::verify {

enum class Kind { precise, binary64 };

inline constexpr const char* judge_name = "d'Alembert";

/// Binary64 has 16 digits; some thousand operations and terms that cancel leave 11 of them, relative to the terms.
inline constexpr double tolerance_binary64 = 1e-11;

/// The largest difference of each pair so far.
class Tally {
 public:
  explicit Tally(int digits) : digits_(digits) {}
  void note(const std::string& a, const std::string& b, bool shares_code, double relative_difference,
            Kind kind = Kind::precise);
  void count_point() { ++points_; }
  std::size_t points() const { return points_; }
  int digits() const { return digits_; }
  const std::vector<Comparison>& comparisons() const { return rows_; }

 private:
  int digits_;
  std::size_t points_ = 0;
  std::vector<Comparison> rows_;
};

/// Throws std::domain_error where one of the subjects has no value or is too nearly singular.
void compare_at(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Judge& judge, const State& state,
                Tally& tally);

}  // namespace eomgen::verify
