// SPDX-License-Identifier: GPL-3.0-or-later
// The denominator audit: what the right-hand side divides by and where that is zero, how close the motions came to it,
// the condition of the mass matrix, and how many digits binary64 loses against the same program in 60 digits.
#pragma once

#include <string>
#include <vector>

#include "program/program.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {

inline constexpr double no_value = -1;

struct Denominator {
  std::string expression, zero;             // "r", "r = 0"
  std::string test = {};                    // of the emitted code: what it says where this vanishes
  double smallest = no_value, largest = 0;  // |value| at the states that were looked at
  std::string at = {};                      // the case of the smallest
};

/// A largest value, and in which case it was met.
struct Extreme {
  double value = no_value;
  std::string at;
};

struct Audit {
  std::size_t states = 0;
  std::vector<Denominator> denominators;  // factors, each once, in the order of the program
  Extreme mass_condition;                 // of M on what the constraints leave free, in the units of the model
  Extreme scaled_mass_condition;          // with its diagonal scaled to 1: what elimination feels
  Extreme pivot;                          // smallest pivot relative to the entry that it is what is left of; as 1/that
  Extreme digits_lost;                    // of accelerations, beyond the last digit of binary64
  std::size_t without_digits = 0;         // states at which the program has no value in many digits
};

class Auditor {
 public:
  Auditor(const mechanics::Mechanics& mechanics, const program::Program& program);

  /// A few states of a motion.
  void see(const std::string& test, const run::Scene& scene, const run::Code& code, const std::vector<Sample>& samples);
  const Audit& audit() const { return audit_; }

 private:
  void look_at_mass(const std::string& test, const run::Scene& scene, const run::Code& code, const Sample& sample);
  void look_at_denominators(const std::string& test, const run::Scene& scene, const Sample& sample,
                            const std::vector<double>& u);
  void look_at_digits(const std::string& test, const run::Scene& scene, const run::Code& code,
                      const std::vector<const Sample*>& samples);

  const program::Function& rhs_;
  program::Function divided_;  // the same code; its one result are the denominators
  Audit audit_;
};

}  // namespace eomgen::stress
