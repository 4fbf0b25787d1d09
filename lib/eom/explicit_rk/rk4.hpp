// SPDX-License-Identifier: MIT
// The classical method of Runge and Kutta: order 4, fixed step, the Hermite cubic as dense output.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table II.1.2.
#pragma once

#include "eom/explicit_rk/tableau.hpp"

namespace eom::explicit_rk {

/// The tableau of `rk4`.
struct Rk4 {
  static constexpr const char* name = "rk4";
  static constexpr int order = 4;
  static constexpr int dense_order = 3;
  static constexpr std::size_t stages = 4;
  static constexpr std::size_t dense_stages = 0;
  static constexpr StepControl control{0.9, 0, 0.2, 5};  // not used: no estimator

  static constexpr std::array<double, 5> c{0, 0.5, 0.5, 1, 1};
  static constexpr Weights<5, 5> a{{{}, {0.5}, {0, 0.5}, {0, 0, 1}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}}};
  static constexpr Weights<0, 5> error{};
  static constexpr Weights<0, 5> dense{};
};

}  // namespace eom::explicit_rk
