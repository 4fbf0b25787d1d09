// SPDX-License-Identifier: MIT
// A right-hand side with the Taylor series of its solution (system.hpp), composed of two callables. With modes the
// series is taylor(t, x, mode, order, c).
#pragma once

#include <cstddef>

namespace eom {

template <class F, class S>
struct WithTaylor : F {
  WithTaylor(F rhs, S series_of, int highest, std::size_t states_of)
      : F(rhs), series(series_of), highest_order(highest), states(states_of) {}
  S series;
  int highest_order;
  std::size_t states;

  template <class... Arguments>
  int taylor(Arguments... arguments) {
    return series(arguments...);
  }
  int taylor_order() const { return highest_order; }
  std::size_t taylor_states() const { return states; }
};

}  // namespace eom
