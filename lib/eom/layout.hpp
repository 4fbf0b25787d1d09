// SPDX-License-Identifier: MIT
// The layout of a state x = (q, v, z): coordinates, their rates, states of first order. Only q and v are projected onto
// constraints; error control covers all of x.
#pragma once

#include <cstddef>

namespace eom {

struct StateLayout {
  std::size_t coordinates = 0;  // n: length of q and of v
  std::size_t first_order = 0;  // k: length of z

  /// Places in x.
  constexpr std::size_t rates_begin() const { return coordinates; }
  constexpr std::size_t first_order_begin() const { return 2 * coordinates; }
  constexpr std::size_t size() const { return 2 * coordinates + first_order; }

  friend bool operator==(const StateLayout&, const StateLayout&) = default;
};

}  // namespace eom
