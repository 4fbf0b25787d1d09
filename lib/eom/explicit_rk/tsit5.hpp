// SPDX-License-Identifier: MIT
// Tsitouras 5(4) with dense output of order 4.
// Source: Ch. Tsitouras, Runge-Kutta pairs of order 5(4) satisfying only the first column simplifying assumption,
// Computers and Mathematics with Applications 62 (2011) 770-775. The dense row is the coefficients of s^4 in its
// interpolant.
#pragma once

#include "eom/explicit_rk/tableau.hpp"

namespace eom::explicit_rk {

/// The tableau of `tsit5`.
struct Tsit5 {
  static constexpr const char* name = "tsit5";
  static constexpr int order = 5;
  static constexpr int dense_order = 4;
  static constexpr std::size_t stages = 6;
  static constexpr std::size_t dense_stages = 0;
  static constexpr StepControl control{0.9, 0.04, 0.2, 10};

  static constexpr std::array<double, 7> c{0, 0.161, 0.327, 0.9, 0.9800255409045097, 1, 1};
  static constexpr Weights<7, 7> a{{
      {},
      {0.161},
      {-0.008480655492356989, 0.335480655492357},
      {2.8971530571054935, -6.359448489975075, 4.3622954328695815},
      {5.325864828439257, -11.748883564062828, 7.4955393428898365, -0.09249506636175525},
      {5.86145544294642, -12.92096931784711, 8.159367898576159, -0.071584973281401, -0.028269050394068383},
      // The published 16 digits sum to 1 - 2.6e-16, which would cause a drift of that size; one weight is corrected.
      {0.09646076681806523, 0.01 + 2.585e-16, 0.4798896504144996, 1.379008574103742, -3.290069515436081,
       2.324710524099774},
  }};
  static constexpr Weights<1, 7> error{{
      {-0.00178001105222577714, -0.0008164344596567469, 0.007880878010261995, -0.1447110071732629, 0.5823571654525552,
       -0.45808210592918697, 1.0 / 66},
  }};
  static constexpr Weights<1, 7> dense{{
      {-1.0530884977290216, 0.1017, 2.490627285651253, -16.548102889244902, 47.37952196281928, -34.87065786149661, 2.5},
  }};
};

}  // namespace eom::explicit_rk
