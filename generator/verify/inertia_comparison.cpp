// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/inertia_comparison.hpp"

#include <algorithm>

#include "verify/applied_forces.hpp"
#include "verify/inertia_values.hpp"

namespace eomgen::verify {
namespace {

/// `v`: accelerations of the free coordinates. `state` has those of the others.
double regressor_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<std::uint32_t>& free,
                            const Oracle& oracle, State state, const std::vector<Real>& v) {
  for (std::size_t i = 0; i < free.size(); ++i) state.qddot[free[i]] = v[i];
  double largest = 0;
  std::size_t column = 0;
  for (const InertialWork& expected : inertial_works(oracle, state)) {
    largest = std::max(largest, relative_difference(values[1].at(column) - expected.parameter,
                                                    sizes[1].at(column) + cln::abs(expected.parameter)));
    for (std::size_t i = 0; i < free.size(); ++i) {
      const std::size_t at = i + free.size() * column;
      largest = std::max(largest, relative_difference(values[0].at(at) - expected.work[free[i]],
                                                      sizes[0].at(at) + expected.scale[free[i]]));
    }
    ++column;
  }
  return largest;
}

double momentum_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<std::uint32_t>& free,
                           const Oracle& oracle, const State& state) {
  if (values[2].empty()) return 0;
  const Momentum expected = momentum(oracle, state);
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest =
        std::max(largest, relative_difference(values[2].at(c) - expected.centre[c], sizes[2].at(c) + expected.length));
  for (std::size_t c = 0; c < 6; ++c) {
    largest = std::max(
        largest, relative_difference(values[1].at(c) - expected.whole[c], sizes[1].at(c) + expected.whole_scale[c]));
    for (std::size_t i = 0; i < free.size(); ++i)
      largest = std::max(largest, relative_difference(values[0].at(c + 6 * i) - expected.tangents[free[i]][c],
                                                      sizes[0].at(c + 6 * i) + expected.scale[free[i]][c]));
  }
  return largest;
}

}  // namespace

std::optional<double> inertia_difference(const std::string& function, const AbiResults& values, const AbiResults& sizes,
                                         const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                         const State& state, const std::vector<Real>& v) {
  if (function == "regressor") return regressor_difference(values, sizes, free, oracle, state, v);
  if (function == "momentum") return momentum_difference(values, sizes, free, oracle, state);
  return std::nullopt;
}

}  // namespace eomgen::verify
