// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the commands of the program on one random mechanism, as a user does, with limited time and memory.
#pragma once

#include <string>
#include <vector>

#include "random/mechanisms.hpp"
#include "support/sanitized.hpp"

namespace eomgen::random_models {

inline constexpr int processor_seconds = test::sanitized ? 400 : 40, address_megabytes = test::sanitized ? 0 : 1500;

/// Time limit of `check` for models on which it once was many times slower.
inline constexpr int seconds_of_a_check = processor_seconds / 10;

struct Limits {
  int seconds = processor_seconds;    // processor time of each command
  int megabytes = address_megabytes;  // address space; 0: not limited
  bool moved = true;                  // also compile, run and linearise
  bool only_checked = false;
};

struct Finding {
  std::string command;  // "check", "derive", "run", "linearize"
  std::string what;     // the failure, with the first line of the message
};

/// The result for a model: the reason if it was rejected, and the findings.
struct Trial {
  std::vector<Finding> findings;
  std::string refusal;  // the model is not a valid mechanism: the first message of `check` or of the start of `run`
  double slowest = 0;   // seconds of the slowest command
};

/// Checks, derives with every item, verifies, emits, compiles, runs and linearises the model. `folder` has to exist.
Trial try_model(const std::string& program, const std::string& folder, const std::string& text, const Limits& limits);

/// The smallest text, by removal of sections, with the same finding.
std::string shrink(const std::string& program, const std::string& folder, std::string text, Limits limits);

}  // namespace eomgen::random_models
