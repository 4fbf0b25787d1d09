// SPDX-License-Identifier: MIT
// Symmetric compositions of a symmetric step of order 2: the substeps, in units of the step. Source: Hairer, Lubich,
// Wanner, Geometric Numerical Integration, section V.3.2: order 4 after Suzuki (five substeps, eq. (II.4.5)), order 6
// after Yoshida (seven). The tests check the order conditions and measure the orders.
#pragma once

#include <array>
#include <cmath>

namespace eom::variational {

/// One step.
struct Order2 {
  static constexpr const char* name = "variational2";
  static constexpr int order = 2;
  static constexpr std::array<double, 1> substeps{1};
};

/// Three steps of order 2.
struct Order4 {
  static constexpr const char* name = "variational4";
  static constexpr int order = 4;
  static constexpr double outer = 0.41449077179437573714;  // 1/(4 - 4^(1/3))
  static constexpr std::array<double, 5> substeps{outer, outer, 1 - 4 * outer, outer, outer};
};

/// Steps of order 2 in a symmetric composition of order 6.
struct Order6 {
  static constexpr const char* name = "variational6";
  static constexpr int order = 6;
  static constexpr double a = 0.78451361047755726382, b = 0.23557321335935813368, c = -1.17767998417887100695;
  static constexpr std::array<double, 7> substeps{a, b, c, 1 - 2 * (a + b + c), c, b, a};
};

}  // namespace eom::variational
