// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/motion.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include "oracle/linear_solve.hpp"

namespace eomgen::verify {

Motion solve_motion(const Oracle& oracle, const State& at) {
  Motion motion{at, {}, {}, {}};
  State& s = motion.state;
  std::vector<std::size_t> bound;  // constraints that are closed and not implied by others
  for (std::size_t k = 0; k < oracle.constraints().size(); ++k) {
    if (!oracle.is_implied(k) && !at.open.contains(k)) bound.push_back(k);
  }
  const std::size_t n = s.q.size(), m = bound.size(), size = n + m;
  const std::vector<Real> no_forces(oracle.constraints().size(), Real(0));
  s.qddot.assign(n, Real(0));
  const std::vector<Residual> rest = oracle.dalembert_residuals(s, no_forces);
  const ConstraintValues c = oracle.constraint_values(s);
  std::vector<Real> matrix(size * size, Real(0)), right(size, Real(0));
  // The matrix entries are the changes for a test acceleration. It is as large as the forces, so that no digits are
  // lost; a power of two is exact.
  Real forces = 1;
  for (const Residual& row : rest) forces = cln::max(forces, row.scale);
  const Real acceleration = power_of_two_near(forces, 1);
  for (std::size_t j = 0; j < n; ++j) {
    s.qddot[j] = acceleration;
    const std::vector<Residual> column = oracle.dalembert_residuals(s, no_forces);
    s.qddot[j] = 0;
    for (std::size_t i = 0; i < n; ++i) matrix[i * size + j] = (column[i].value - rest[i].value) / acceleration;
    right[j] = -rest[j].value;
  }
  for (std::size_t k = 0; k < m; ++k) {
    right[n + k] = -c.psi_ddot[bound[k]];
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * size + n + k] = -c.gradient[bound[k]][i];
      matrix[(n + k) * size + i] = c.gradient[bound[k]][i];
    }
  }
  std::vector<Real> row_scale;
  for (std::size_t i = 0; i < n; ++i) row_scale.push_back(rest[i].scale);
  for (std::size_t k = 0; k < m; ++k) row_scale.push_back(cln::abs(right[n + k]));
  const Solution solution = solve(matrix, std::move(right), true);
  if (!solution.exists()) throw Singular("the mass matrix is nearly singular");
  for (std::size_t i = 0; i < size; ++i)  // terms of the solution may cancel
    for (std::size_t k = 0; k < size; ++k)
      row_scale[i] = row_scale[i] + cln::abs(matrix[i * size + k] * solution.x()[k]);
  for (std::size_t i = 0; i < n; ++i) s.qddot[i] = solution.x()[i];
  // The check of power needs digits in proportion.
  constexpr int most_bits = 8192;
  for (const Real& a : s.qddot) {
    if (!cln::zerop(a) && cln::float_exponent(cln::cl_float(a, cln::float_format(20))) > most_bits)
      throw Singular("an acceleration is above 10^2466");
  }
  motion.lambda = motion.lambda_scale = no_forces;
  for (std::size_t k = 0; k < m; ++k) motion.lambda[bound[k]] = solution.x()[n + k];
  for (std::size_t i = 0; i < size; ++i) {
    Real scale = 0;
    for (std::size_t k = 0; k < size; ++k) scale = scale + solution.inverse[k][i] * row_scale[k];
    if (i >= n) {
      motion.lambda_scale[bound[i - n]] = scale;
      continue;
    }
    // For an acceleration that a constraint makes 0, the terms of its own equation cancel.
    const Real inertia = cln::abs(matrix[i * size + i]);
    if (!cln::zerop(inertia)) scale = scale + row_scale[i] / inertia;
    motion.scale.push_back(scale);
  }
  if (m > 0) {  // as in system_values.cpp
    const Real share = minimum_relative_scale(oracle.model());
    Real largest = 0;
    for (const Real& scale : motion.scale) largest = cln::max(largest, scale);
    for (Real& scale : motion.scale) scale = cln::max(scale, largest * share);
    // A multiplier may be 0 but for rounding, such as that of a coordinate without inertia: its scale is one of forces.
    Real largest_force = 0;
    for (std::size_t i = 0; i < n; ++i) largest_force = cln::max(largest_force, row_scale[i]);
    for (const std::size_t k : bound) motion.lambda_scale[k] = cln::max(motion.lambda_scale[k], largest_force * share);
  }
  return motion;
}

// Below the compared digits and far above rounding. Joints have forces and moments, whose sizes differ.
Real minimum_relative_scale(const model::Model& model) {
  return cln::expt(cln::cl_RA(1) / 10, cln::cl_I(model.joints.empty() ? 20 : 4));
}

}  // namespace eomgen::verify
