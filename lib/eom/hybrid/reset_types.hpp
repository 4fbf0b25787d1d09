// SPDX-License-Identifier: MIT
// Changes of the state by the model itself, as data: resets at events, samples at given times. Indices refer to the
// state x and to the array r of Code::resets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eom/expressions/code.hpp"

namespace eom::hybrid {

/// Simultaneous changes of the state, by values of Code::resets.
struct Reset {
  /// One component that is set.
  struct Entry {
    std::size_t component = 0, value = 0;  // indices in x and in the array r
  };
  std::vector<Entry> set = {};
  std::optional<std::size_t> condition = {};  // index in r: 1 where the reset is made, else 0
};

/// A discrete value that is random at every sample.
struct Noise {
  std::size_t component = 0;  // of x
  bool normal = true;         // else uniform
  std::uint32_t seed = 0;
};

/// Changes at the times offset + k every, for all integers k. One at the end of a run belongs to its continuation.
struct Sample {
  std::string name;
  double every = 0, offset = 0;  // s
  std::vector<Noise> noise = {};
  Reset reset = {};
  expressions::Table times = {};  // period and offset, without variables; empty: the given ones
};

}  // namespace eom::hybrid
