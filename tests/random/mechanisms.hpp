// SPDX-License-Identifier: GPL-3.0-or-later
// Random mechanisms: each seed gives the text of a model that is valid by construction, with all features of the
// format.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace eomgen::random_models {

struct Mechanism {
  std::string text;
  std::set<std::string> features;  // of the text: "euler_parameters", "joint pin", "velocity constraint", ..
  bool constrained = false;        // by more than unit lengths: its start may have no solution
};

/// The text of a seed. It depends on the compiler, which chooses the order of random numbers within an expression.
Mechanism mechanism(std::uint64_t seed);

}  // namespace eomgen::random_models
