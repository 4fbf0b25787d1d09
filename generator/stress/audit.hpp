// SPDX-License-Identifier: GPL-3.0-or-later
// The denominator audit: the denominators of the right-hand side, their zeros and how close the motions came to these,
// the condition of the mass matrix, and the digits that binary64 loses relative to the same program in 60 digits.
#pragma once

#include <string>
#include <vector>

#include "program/program.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {

inline constexpr double no_value = -1;

struct Denominator {
  std::string expression, zero;             // "r", "r = 0"
  std::string test = {};                    // the message of the emitted code for a zero of this denominator
  double smallest = no_value, largest = 0;  // |value| over the audited states
  std::string at = {};                      // the case of the smallest value
};

/// A largest value, and the case in which it occurred.
struct Extreme {
  double value = no_value;
  std::string at;
};

struct Audit {
  std::size_t states = 0;
  std::vector<Denominator> denominators;  // factors, each once, in the order of the program
  Extreme mass_condition;                 // of M on the null space of the constraints, in the units of the model
  Extreme scaled_mass_condition;          // with its diagonal scaled to 1, which matters for elimination
  Extreme pivot;                          // largest ratio of a matrix entry to the pivot that elimination leaves of it
  Extreme digits_lost;                    // of accelerations, relative to the last digit of binary64
  std::size_t without_digits = 0;         // states at which the program has no value in many digits
};

class Auditor {
 public:
  Auditor(const mechanics::Mechanics& mechanics, const program::Program& program);

  /// Audits a few states of a motion.
  void add_motion(const std::string& test, const run::Scene& scene, const run::Code& code,
                  const std::vector<Sample>& samples);
  const Audit& audit() const { return audit_; }

 private:
  void audit_mass(const std::string& test, const run::Scene& scene, const run::Code& code, const Sample& sample);
  void audit_denominators(const std::string& test, const run::Scene& scene, const Sample& sample,
                          const std::vector<double>& u);
  void audit_digits(const std::string& test, const run::Scene& scene, const run::Code& code,
                    const std::vector<const Sample*>& samples);

  const program::Function& rhs_;
  program::Function divided_;  // the same code with the denominators as its only result
  Audit audit_;
};

}  // namespace eomgen::stress
