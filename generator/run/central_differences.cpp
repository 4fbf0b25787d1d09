// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/central_differences.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr double rounding = 1e-14;           // of the values: some units in the last place
constexpr double largest_remainder = 1e-8;   // of a slope: change by the last extrapolation
constexpr double largest_difference = 1e-6;  // of a slope: between the two sides

using Row = std::array<double, difference_distances>;

/// Extrapolates values at h, h/2, .. to h = 0, if they are a series in h of the powers first, first + 2, ..
double extrapolate(Row row, int first, double& change) {
  double factor = std::ldexp(1.0, first);
  for (std::size_t level = 1; level < row.size(); ++level, factor *= 4) {
    for (std::size_t k = row.size() - 1; k >= level; --k) {
      const double by = (row[k] - row[k - 1]) / (factor - 1);
      if (k == row.size() - 1) change = std::abs(by);
      row[k] += by;
    }
  }
  return row.back();
}

}  // namespace

std::vector<double> difference_offsets(double h) {
  std::vector<double> offsets;
  for (std::size_t k = 0; k < difference_distances; ++k, h /= 2) offsets.insert(offsets.end(), {h, -h});
  return offsets;
}

Slopes slopes(const std::vector<double>& middle, const std::vector<std::vector<double>>& beside, double h,
              const std::vector<double>& noise) {
  Slopes result;
  const double nearest = std::ldexp(h, 1 - static_cast<int>(difference_distances));
  for (std::size_t i = 0; i < middle.size(); ++i) {
    Row central{}, sided{};  // sided: the difference of the slopes on both sides, h f'' + ..
    double size = std::abs(middle[i]), distance = h;
    for (std::size_t k = 0; k < difference_distances; ++k, distance /= 2) {
      const double above = beside[2 * k][i], below = beside[2 * k + 1][i];
      size = std::max({size, std::abs(above), std::abs(below)});
      central[k] = (above - below) / (2 * distance);
      sided[k] = ((above - middle[i]) - (middle[i] - below)) / distance;
    }
    double change = 0, unused = 0;
    const double slope = extrapolate(central, 2, change), bend = extrapolate(sided, 1, unused);
    const double error = std::max(rounding * size, noise.empty() ? 0 : noise[i]) / std::abs(nearest);
    result.value.push_back(slope);
    result.smooth = result.smooth && change <= largest_remainder * std::abs(slope) + error &&
                    std::abs(bend) <= largest_difference * std::abs(slope) + 8 * error;
  }
  return result;
}

}  // namespace eomgen::run
