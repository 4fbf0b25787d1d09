// SPDX-License-Identifier: MIT
// Event functions and their crossings: how a function is monitored, and where it changed its sign.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace eom {

/// Direction of the value as a function of time, independent of the direction of integration.
enum class Direction { any, up, down };

enum class Watch {
  off,
  passing,   // reported, and the integration continues unchanged
  breaking,  // the step ends at the crossing, and the handler decides how to continue
};

struct EventFunction {
  Direction direction = Direction::any;
  Watch watch = Watch::breaking;
  bool guard =
      false;  // for a direction up or down: starting beyond the surface, or leaving it on that side, is a crossing too
  bool resets = false;  // a handler may turn it back at its crossing: it then has to return to the side it came from
};

struct Crossing {
  std::size_t function = 0;
  double t = 0;
  bool up = false;                                         // the value rises with t
  double value = std::numeric_limits<double>::infinity();  // at the crossing, before a handler changed anything;
                                                           // infinite: not known
};

/// What an integration knows of its event functions at its end, for one that continues there.
struct EventMemory {
  std::vector<int> sides = {};       // 0: unknown
  std::vector<double> largest = {};  // largest values
};

}  // namespace eom
