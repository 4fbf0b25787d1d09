// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical integrability tests. In: one-forms at a point on the active holonomic constraints. Out: whether some of
// them are closed modulo themselves there, and the tangent space of the orbit of the motions that they allow (Chow,
// Sussmann). A nonzero value refutes integrability. Zeros are only candidates for a proof.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/pfaffian.hpp"

namespace eomgen::mechanics {

/// The tangent space of the orbit through a point: all directions of the involutive closure of the forms' kernel.
class Orbit {
 public:
  using Vector = std::vector<cln::cl_R>;
  Orbit(std::size_t variables, std::vector<Vector> directions)
      : variables_(variables), directions_(std::move(directions)) {}

  /// The dimension of the largest integrable subsystem.
  std::size_t integrable_count() const { return variables_ - directions_.size(); }
  /// Whether a form, given by its values at the point, belongs to the largest integrable subsystem.
  bool is_integrable(const Vector& form) const;

 private:
  std::size_t variables_;
  std::vector<Vector> directions_;  // orthonormal
};

/// Evaluates d omega of the last form on the common kernel of all forms at a point. True if it is not 0, so that
/// Frobenius' condition fails. Empty if there are no values.
std::optional<bool> fails_frobenius(OneFormSpace& space, const std::vector<OneForm>& forms, std::size_t point);

/// Empty if there are no values, if the forms are dependent, or if there are too many.
std::optional<Orbit> orbit(OneFormSpace& space, const std::vector<OneForm>& forms, std::size_t point);

}  // namespace eomgen::mechanics
