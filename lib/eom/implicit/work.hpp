// SPDX-License-Identifier: MIT
// Work of a method in evaluations of the right-hand side. In: counts of a run, the number of unknowns and of stages.
// Counts are the same in every process, times are not.
#pragma once

#include <cstddef>

#include "eom/run_types.hpp"

namespace eom::implicit {

/// A right-hand side has about this many operations for each component.
inline constexpr double operations_per_component = 60;
/// A compiled df/dx takes about as many operations as this many evaluations.
inline constexpr double evaluations_per_jacobian = 6;

/// unknowns: those of the matrices. stages: of a collocation method; explicit methods have no matrices.
inline double work(const Statistics& done, std::size_t unknowns, std::size_t stages) {
  const double m = static_cast<double>(unknowns), s = static_cast<double>(stages);
  // One real matrix and (s - 1)/2 complex ones, whose operations count four times. An iteration also transforms the
  // increments and the derivatives of the stages.
  const double matrices = 1 + 2 * (s - 1);
  const double of_factorisation = 2.0 / 3 * matrices * m * m / operations_per_component,
               of_iteration = (2 * matrices * m + 4 * s * s) / operations_per_component;
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  return count(done.rhs_evaluations) +
         (done.difference_evaluations > 0 ? 0 : evaluations_per_jacobian * count(done.jacobians)) +
         of_factorisation * count(done.factorisations) + of_iteration * count(done.newton_iterations);
}

}  // namespace eom::implicit
