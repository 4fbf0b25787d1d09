// SPDX-License-Identifier: GPL-3.0-or-later
// The curve on which constraints leave one particle free: Frenet triad, curvature, torsion, eqs. (2.130), (2.131). A
// moving curve is taken at fixed time.
#pragma once

#include <optional>
#include <string>

#include "reading/reading.hpp"

namespace eomgen::reading {

struct FrenetVector {
  Components fixed;                // along E1..E3
  std::optional<Components> unit;  // along the chart's unit vectors, if it has three orthonormal ones
};

struct Frenet {
  std::string name;                    // of the particle
  std::optional<std::uint32_t> along;  // the free coordinate, if any; the tangent points to its increase
  Sum speed;                           // ds/dq of that coordinate
  FrenetVector tangent;
  std::optional<FrenetVector> normal, binormal;  // empty if the curve is straight
  Sum curvature;
  std::optional<Sum> torsion;
  std::vector<std::uint32_t> unit_names;  // whose coordinate's e_q each is
};

/// The reason why a model has no such curve; empty if it has one.
std::string curve_obstacle(const mechanics::Mechanics& mechanics);

/// Throws Error{stage "derive"} if there is no curve, work::BudgetExceeded if its formulas are too long.
Frenet frenet(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
