// SPDX-License-Identifier: MIT
// A right-hand side with the Taylor series of its solution (system.hpp), composed of two callables. With modes the
// series is taylor(t, x, mode, order, c).
#pragma once

#include <cstddef>

namespace eom {

/// A right-hand side and the Taylor series of its solution as one callable.
template <class F, class S>
struct WithTaylor : F {
  /// highest: the highest order of the series. states_of: number of components that the series has.
  WithTaylor(F rhs, S series_of, int highest, std::size_t states_of)
      : F(rhs), series(series_of), highest_order(highest), states(states_of) {}
  S series;
  int highest_order;
  std::size_t states;

  /// The coefficients of the series, as in system.hpp. Returns a code of the C ABI.
  template <class... Arguments>
  int taylor(Arguments... arguments) {
    return series(arguments...);
  }
  /// The highest order.
  int taylor_order() const { return highest_order; }
  /// Number of components that the series has.
  std::size_t taylor_states() const { return states; }
};

}  // namespace eom
