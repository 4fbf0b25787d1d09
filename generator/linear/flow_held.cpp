// SPDX-License-Identifier: GPL-3.0-or-later
// The vector field with contacts held in their modes.
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "linear/flow.hpp"
#include "linear/flow_numbers.hpp"

namespace eomgen::linear {

/// The held equations at a point. Normal forces on curves are found by Newton's method from those without friction: |N|
/// is convex, so that it converges wherever there is a solution.
template <class T>
ValueAndJacobian<T> Flow::held_values(const State<T>& z, const Setting<T>& setting) const {
  constexpr int rounds = 100, digits = std::is_same_v<T, double> ? 13 : 130;
  Setting<T> at = setting;
  at.curves.assign(3 * curves_.size(), T(0));
  ValueAndJacobian<T> s = value_and_jacobian(*tape_, z, at);
  bool found = curves_.empty();
  for (int round = 0; round < rounds && !found; ++round) {
    const std::vector<T> before = std::exchange(at.curves, tangents(s));
    found = true;
    for (std::size_t i = 0; i < before.size(); ++i)
      found = found && magnitude(at.curves[i] - before[i]) <= tiny<T>(digits) * magnitude(at.curves[i / 3 * 3 + 2]);
    s = value_and_jacobian(*tape_, z, at);
  }
  require_domain(found, "the law of friction on a curve has no solution there");
  return s;
}

/// u = r/|N| and |N| of each curve, for the forces that solve the equations.
template <class T>
std::vector<T> Flow::tangents(const ValueAndJacobian<T>& s) const {
  const std::size_t size = n_ + forces_.size();
  Matrix<T> right(size, 1);
  const Matrix<T> y = eliminate_held(s, right).solve(right);
  std::vector<T> result;
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const std::size_t first = curve_roots_ + c * (2 * (size + 1) + 4);
    std::array<T, 2> r{T(0), T(0)};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t row = first + k * (size + 1);
      r[k] = s.value[row + size];
      for (std::size_t i = 0; i < size; ++i) r[k] = r[k] + s.value[row + i] * y(i, 0);
    }
    T square(0);
    for (std::size_t k = 0; k < 4; ++k) square = square + s.value[first + 2 * (size + 1) + k] * r[k / 2] * r[k % 2];
    if (!(square > T(0))) throw std::domain_error("'" + curves_[c] + "', which slides on a curve, carries no force");
    const T length = root(square);
    result.insert(result.end(), {r[0] / length, r[1] / length, length});
  }
  return result;
}

// P y + c = 0.
template <class T>
Elimination<T> Flow::eliminate_held(const ValueAndJacobian<T>& s, Matrix<T>& right) const {
  const std::size_t size = n_ + forces_.size(), c0 = size * size;
  Matrix<T> P(size, size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) P(i, j) = s.value[i * size + j];
    right(i, 0) = -s.value[c0 + i];
  }
  return Elimination<T>(P, singular<T>());
}

// Along every direction d P y' = -c' - P' y.
template <class T>
void Flow::differentiate_held(const ValueAndJacobian<T>& s, const State<T>& z, Field<T>& field) const {
  const std::size_t size = n_ + forces_.size(), c0 = size * size, count = directions_.size();
  Matrix<T> right(size, 1), rates(size, count);
  const Elimination<T> solver = eliminate_held(s, right);
  const Matrix<T> open = solver.null_space();
  field.undetermined = Matrix<T>(forces_.size(), open.cols);
  for (std::size_t k = 0; k < open.cols; ++k) {
    for (std::size_t i = 0; i < n_; ++i)
      require_domain(magnitude(open(i, k)) <= singular<T>(), "the accelerations are not determined");
    for (std::size_t i = 0; i < forces_.size(); ++i) field.undetermined(i, k) = open(n_ + i, k);
  }
  const Matrix<T> y = solver.solve(right);
  for (std::size_t d = 0; d < count; ++d) {
    for (std::size_t i = 0; i < size; ++i) {
      T sum = -s.jacobian(c0 + i, d);
      for (std::size_t j = 0; j < size; ++j) subtract(sum, s.jacobian(i * size + j, d), y(j, 0));
      rates(i, d) = sum;
    }
  }
  const Matrix<T> jacobian = solver.solve(rates);
  fill(y, jacobian, z, field);
  fill_first_order(s, c0 + size, field);
  if constexpr (std::is_same_v<T, double>) {  // the accelerations vanish where the forces of inertia do
    field.inertia_force = Matrix<T>(n_, 1);
    field.inertia_force_jacobian = Matrix<T>(n_, entries() + 1);
    for (std::size_t i = 0; i < n_; ++i) {
      field.inertia_force(i, 0) = y(i, 0);
      for (std::size_t d = 0; d < entries() + 1; ++d) field.inertia_force_jacobian(i, d) = jacobian(i, d);
    }
  }
}

template <class T>
void Flow::constrain_held(const State<T>& z, const Setting<T>& setting, Field<T>& field) const {
  const ValueAndJacobian<T> s = value_and_jacobian(*constraint_tape_, z, setting);
  const std::size_t rows = phi_expressions_.size(), leaf0 = position_constraints_ - leaf_.size();
  field.phi = Matrix<T>(rows, 1);
  field.phi_jacobian = Matrix<T>(rows, entries() + 1);
  for (std::size_t k = 0; k < rows; ++k) {
    field.phi(k, 0) = s.value[k];
    for (std::size_t d = 0; d < entries() + 1; ++d) field.phi_jacobian(k, d) = s.jacobian(k, d);
  }
  for (std::size_t k = 0; k < leaf_.size(); ++k) field.phi(leaf0 + k, 0) = s.value[leaf0 + k] - setting.leaf.at(k);
}

template ValueAndJacobian<double> Flow::held_values(const State<double>&, const Setting<double>&) const;
template void Flow::differentiate_held(const ValueAndJacobian<double>&, const State<double>&, Field<double>&) const;
template void Flow::constrain_held(const State<double>&, const Setting<double>&, Field<double>&) const;
template ValueAndJacobian<Precise> Flow::held_values(const State<Precise>&, const Setting<Precise>&) const;
template void Flow::differentiate_held(const ValueAndJacobian<Precise>&, const State<Precise>&, Field<Precise>&) const;
template void Flow::constrain_held(const State<Precise>&, const Setting<Precise>&, Field<Precise>&) const;

}  // namespace eomgen::linear
