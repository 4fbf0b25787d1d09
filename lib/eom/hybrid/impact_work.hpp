// SPDX-License-Identifier: MIT
// The work of the impulse of each contact of an impact. In: the energy E as a function of the state, the mass matrix.
// Out: the velocities that the rates of moving coordinates leave out.
//
// E is quadratic in the rates, E = qdot^T M qdot / 2 + m . qdot + ..; m is not 0 where coordinates refer to a moving
// frame. An impulse P along a row J changes M qdot by J^T P, and E by P J (mean qdot + M^-1 m).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "eom/contacts/least_norm.hpp"
#include "eom/hybrid/problem.hpp"

namespace eom::hybrid {

/// The energy of a state in J.
using Energy = std::function<double(double t, std::span<const double> x)>;

/// M^-1 m at a state, n components; nothing where m is 0.
inline std::optional<Eigen::VectorXd> frame_rates(const Problem& problem, const Energy& energy, double t,
                                                  std::span<const double> x) {
  constexpr double rounding = 1e-12;
  const std::size_t n = problem.n();
  std::vector<double> y(x.begin(), x.end());
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(x[n + i]));
  if (size == 0) size = 1;
  // E(rates) - E(-rates), and the sum of their sizes.
  const auto odd_part = [&](auto&& rate) {
    for (std::size_t i = 0; i < n; ++i) y[n + i] = rate(i);
    const double one = energy(t, y);
    for (std::size_t i = 0; i < n; ++i) y[n + i] = -rate(i);
    const double other = energy(t, y);
    return std::pair(one - other, std::abs(one) + std::abs(other));
  };
  // Rates in no special ratio: their product with m is 0 only where m is.
  const auto any =
      odd_part([&](std::size_t i) { return size * (1 + std::fmod(0.61803398875 * static_cast<double>(i + 1), 1.0)); });
  if (!(std::abs(any.first) > rounding * any.second)) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(n);
  Eigen::VectorXd m(count), h(count);
  for (std::size_t k = 0; k < n; ++k)
    m(static_cast<Eigen::Index>(k)) = odd_part([&](std::size_t i) { return i == k ? size : 0.0; }).first / (2 * size);
  Eigen::MatrixXd M(count, count);
  if (problem.code->mass(t, x.data(), problem.parameters.data(), M.data(), h.data()) != 0) return std::nullopt;
  return contacts::solve_least_norm(M, m).x;
}

/// Leaves out contacts whose impulses are rounding errors of the others.
inline void erase_negligible(std::vector<ContactImpulse>& impulses) {
  constexpr double negligible = 1e-12;
  const auto size = [](const ContactImpulse& one) {
    double largest = std::abs(one.normal);
    for (const double f : one.friction) largest = std::max(largest, std::abs(f));
    return largest;
  };
  double largest = 0;
  for (const ContactImpulse& one : impulses) largest = std::max(largest, size(one));
  std::erase_if(impulses, [&](const ContactImpulse& one) { return size(one) <= negligible * largest; });
}

}  // namespace eom::hybrid
