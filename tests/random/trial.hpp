// SPDX-License-Identifier: GPL-3.0-or-later
// One random mechanism through the program as a user calls it, with bounded time and memory.
#pragma once

#include <string>
#include <vector>

#include "random/mechanisms.hpp"
#include "support/sanitized.hpp"

namespace eomgen::random_models {

inline constexpr int processor_seconds = test::sanitized ? 400 : 40, address_megabytes = test::sanitized ? 0 : 1500;

/// Of `check`, for models on which it once took many times as long.
inline constexpr int seconds_of_a_check = processor_seconds / 10;

struct Limits {
  int seconds = processor_seconds;    // of the processor, for each command
  int megabytes = address_megabytes;  // of address space; 0: any
  bool moved = true;                  // compiled, run and linearised too
  bool only_checked = false;
};

struct Finding {
  std::string command;  // "check", "derive", "run", "linearize"
  std::string what;     // what is wrong, with the first line of the message
};

/// What happened to a model: refused, and why; or what broke a promise.
struct Trial {
  std::vector<Finding> findings;
  std::string refusal;  // the model is no mechanism: its first message, told by `check` or by the start of `run`
  double slowest = 0;   // seconds of the slowest command
};

/// Checks, derives with every item, verifies, emits, compiles, runs and linearises the model. `folder` has to be there.
Trial try_model(const std::string& program, const std::string& folder, const std::string& text, const Limits& limits);

/// The smallest text, by leaving out sections, that breaks the same promise.
std::string shrink(const std::string& program, const std::string& folder, std::string text, Limits limits);

}  // namespace eomgen::random_models
