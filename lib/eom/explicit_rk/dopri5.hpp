// SPDX-License-Identifier: MIT
// Dormand and Prince 5(4) with dense output of order 4.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table II.5.2; dense output: section II.6,
// weights of the code DOPRI5.
#pragma once

#include "eom/explicit_rk/tableau.hpp"

namespace eom::explicit_rk {

/// The tableau of `dopri5`.
struct Dopri5 {
  static constexpr const char* name = "dopri5";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr std::size_t stages = 6;
  static constexpr std::size_t dense_stages = 0;
  static constexpr StepControl control{0.9, 0.04, 0.2, 10};

  static constexpr std::array<double, 7> c{0, 0.2, 0.3, 0.8, 8.0 / 9, 1, 1};
  static constexpr Weights<7, 7> a{{
      {},
      {0.2},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
  }};
  // the weights of order 5 less those of order 4
  static constexpr Weights<1, 7> error{{
      {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40},
  }};
  static constexpr Weights<1, 7> dense{{
      {-12715105075.0 / 11282082432.0, 0, 87487479700.0 / 32700410799.0, -10690763975.0 / 1880347072.0,
       701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0, 69997945.0 / 29380423.0},
  }};
};

}  // namespace eom::explicit_rk
