// SPDX-License-Identifier: GPL-3.0-or-later
// Random mechanisms: a seed gives the text of a model that is valid by construction, from all that the format has.
#pragma once

#include <cstdint>
#include <set>
#include <string>

namespace eomgen::random_models {

struct Mechanism {
  std::string text;
  std::set<std::string> features;  // what went into it: "euler_parameters", "joint pin", "velocity constraint", ..
  bool constrained = false;        // by anything but unit lengths: its start may have no solution
};

/// The same text for the same seed (of one compiler: it chooses the order in which parts of an expression are drawn).
Mechanism mechanism(std::uint64_t seed);

}  // namespace eomgen::random_models
