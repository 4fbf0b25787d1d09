// SPDX-License-Identifier: GPL-3.0-or-later
// The curve that constraints leave to one particle: Frenet triad, curvature, torsion, eqs. (2.130), (2.131). A moving
// curve is that of the moment: time is held.
#pragma once

#include <optional>
#include <string>

#include "reading/reading.hpp"

namespace eomgen::reading {

struct FrenetVector {
  Components fixed;                // along E1..E3
  std::optional<Components> unit;  // along the chart's unit vectors, where it names three that are orthonormal
};

struct Frenet {
  std::string name;                    // of the particle
  std::optional<std::uint32_t> along;  // the free coordinate, where there is one; the triad points to where it grows
  Sum speed;                           // ds/dq of that coordinate
  FrenetVector tangent;
  std::optional<FrenetVector> normal, binormal;  // nothing where the curve is straight
  Sum curvature;
  std::optional<Sum> torsion;
  std::vector<std::uint32_t> unit_names;  // whose coordinate's e_q each is
};

/// Why a model has no such curve; empty where it has.
std::string why_no_curve(const mechanics::Mechanics& mechanics);

/// Throws Error{stage "derive"} where there is no curve, work::OverBudget where its formulas are too long.
Frenet frenet(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
