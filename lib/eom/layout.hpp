// SPDX-License-Identifier: MIT
// The layout of a state x = (q, v, z, d): coordinates, their rates, states of first order, discrete values. Only q and
// v are projected onto constraints. Error control covers all of x; the rate of d is 0, and only resets change d.
#pragma once

#include <cstddef>

namespace eom {

/// Lengths of the parts of a state.
struct StateLayout {
  std::size_t coordinates = 0;  // n: length of q and of v
  std::size_t first_order = 0;  // k: length of z
  std::size_t discrete = 0;     // length of d

  /// Places in x.
  constexpr std::size_t rates_begin() const { return coordinates; }
  constexpr std::size_t first_order_begin() const { return 2 * coordinates; }
  constexpr std::size_t discrete_begin() const { return first_order_begin() + first_order; }
  constexpr bool is_rate(std::size_t component) const {
    return component >= rates_begin() && component < first_order_begin();
  }
  /// Length of x.
  constexpr std::size_t size() const { return discrete_begin() + discrete; }
  /// Components that are neither coordinates nor rates.
  constexpr std::size_t others() const { return first_order + discrete; }

  friend bool operator==(const StateLayout&, const StateLayout&) = default;
};

}  // namespace eom
