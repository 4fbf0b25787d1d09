// SPDX-License-Identifier: GPL-3.0-or-later
// The slope of functions of one variable at a point. In: their values there, and on both sides at the distances h, h/2,
// h/4, h/8. Out: central differences extrapolated to order 8 (Richardson), and whether the values are those of smooth
// functions.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace eomgen::run {

struct Slopes {
  std::vector<double> value;
  bool smooth = true;  // false: the functions bend at the point, or vary too much within h
};

inline constexpr std::size_t difference_distances = 4;

/// Offsets in units of h, and weights of the derivative to order 4, times h.
inline constexpr std::array<std::pair<double, double>, 4> order_four{
    {{2, -1.0 / 12}, {-2, 1.0 / 12}, {1, 8.0 / 12}, {-1, -8.0 / 12}}};

/// The offsets at which values are needed: h, -h, h/2, -h/2, ...
std::vector<double> difference_offsets(double h);

/// middle: values at the point; beside: values at each of the offsets; noise: absolute errors of the values, or empty
/// if they have but their own rounding.
Slopes slopes(const std::vector<double>& middle, const std::vector<std::vector<double>>& beside, double h,
              const std::vector<double>& noise = {});

}  // namespace eomgen::run
