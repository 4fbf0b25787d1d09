// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/energy_comparison.hpp"

#include <algorithm>

#include "verify/applied_forces.hpp"

namespace eomgen::verify {

double energy_difference(const AbiResults& values, const AbiResults& sizes, const EnergyValues& expected) {
  return std::max(relative_difference(values[0].at(0) - expected.kinetic, sizes[0].at(0) + expected.scale),
                  relative_difference(values[0].at(1) - expected.potential, sizes[0].at(1) + expected.scale));
}

double gradient_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<Real>& direction,
                           const CentralDifference& slope, const Real& lost) {
  double largest = 0;
  for (std::size_t energy = 0; energy < 2; ++energy) {
    const std::vector<Real>&gradient = values[1 + energy], &size_of = sizes[1 + energy];
    Real sum = 0, size = sizes[0].at(energy) * lost + slope.errors[0].at(energy);
    for (std::size_t j = 0; j < gradient.size(); ++j) {
      sum = sum + gradient[j] * direction[j];
      size = size + size_of[j] * cln::abs(direction[j]);
    }
    largest = std::max(largest, relative_difference(sum - slope.values[0].at(energy), size));
  }
  return largest;
}

}  // namespace eomgen::verify
