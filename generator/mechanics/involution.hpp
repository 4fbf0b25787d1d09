// SPDX-License-Identifier: GPL-3.0-or-later
// Integrability by numbers. In: one-forms at a point, on the active holonomic constraints. Out: whether some of them
// are closed modulo themselves there, and where motions that they allow lead to: the tangent space of their orbit
// (Chow, Sussmann). A value that is not 0 refutes; zeros say what is worth a proof.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/pfaffian.hpp"

namespace eomgen::mechanics {

/// What motions along the forms' kernel reach from a point: all directions of the involutive closure.
class Orbit {
 public:
  using Vector = std::vector<cln::cl_R>;
  Orbit(std::size_t variables, std::vector<Vector> directions)
      : variables_(variables), directions_(std::move(directions)) {}

  /// Forms that stay independent of the way: those of the largest integrable system.
  std::size_t integrable() const { return variables_ - directions_.size(); }
  /// Whether a form, by its values there, is one of them.
  bool keeps(const Vector& form) const;

 private:
  std::size_t variables_;
  std::vector<Vector> directions_;  // orthonormal
};

/// d omega of the last form on the common kernel of all, at a point: true where it is not 0, so that Frobenius'
/// condition fails. Nothing where there are no values.
std::optional<bool> fails_frobenius(FormSpace& space, const std::vector<Form>& forms, std::size_t point);

/// Nothing where there are no values, the forms are dependent, or there are too many.
std::optional<Orbit> orbit(FormSpace& space, const std::vector<Form>& forms, std::size_t point);

}  // namespace eomgen::mechanics
