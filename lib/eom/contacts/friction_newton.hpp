// SPDX-License-Identifier: MIT
// The member of friction::Solver that solves for forces on circles of friction by Newton's method. In: an estimate of
// the forces. Out: forces that change no more by a step of projection, if the method finds them.
//
// Forces are a solution if no step of projection changes them: y - P(y - r v) = 0, with P the projections onto N >= 0
// and |T| <= mu N (Alart and Curnier 1991). The function has kinks; Newton's method with the derivatives of one side
// converges quadratically near a solution. Dependent rows make its matrix singular: the step of least norm is taken.
#pragma once

#include "eom/contacts/friction_problem.hpp"

namespace eom::contacts::friction {

/// y - P(y - r v), and its derivatives if J is given.
inline Eigen::VectorXd Solver::projection_defect(const Vector& y, Matrix* J) const {
  const Index f = q_.size();
  const Vector velocity = G_ * y + q_;
  Vector F = Vector::Zero(f);
  if (J != nullptr) J->setZero(f, f);
  for (Index i = 0; i < f; ++i) {
    if (p_.kinds[static_cast<std::size_t>(free_at(i))] != FrictionProblem::Kind::unilateral || !(G_(i, i) > 0))
      continue;
    const bool presses = y(i) - velocity(i) / G_(i, i) > 0;
    F(i) = presses ? velocity(i) / G_(i, i) : y(i);
    if (J == nullptr) continue;
    if (presses)
      J->row(i) = G_.row(i) / G_(i, i);
    else
      (*J)(i, i) = 1;
  }
  for (std::size_t l = 0; l < p_.laws.size(); ++l) {
    const std::vector<Index>& at = tangent_places_[l];
    double slowest = 0, square = 0;
    for (const Index i : at) slowest = std::max(slowest, G_(i, i));
    if (!(slowest > 0)) continue;
    const double most = limits_[l] + limit_slopes_[l].dot(y);
    std::vector<double> wanted;
    for (const Index i : at) {
      wanted.push_back(y(i) - velocity(i) / slowest);
      square += wanted.back() * wanted.back();
    }
    const double length = std::sqrt(square), radius = std::max(0.0, most);
    if (length <= radius) {
      for (const Index i : at) {
        F(i) = velocity(i) / slowest;
        if (J != nullptr) J->row(i) = G_.row(i) / slowest;
      }
      continue;
    }
    for (std::size_t a = 0; a < at.size(); ++a) {
      const double along = wanted[a] / length;
      F(at[a]) = y(at[a]) - radius * along;
      if (J == nullptr) continue;
      if (most > 0) J->row(at[a]) -= along * limit_slopes_[l].transpose();
      for (std::size_t b = 0; b < at.size(); ++b) {
        const double turn = radius / length * ((a == b ? 1.0 : 0.0) - along * wanted[b] / length);
        J->row(at[a]) += turn / slowest * G_.row(at[b]);
        (*J)(at[a], at[b]) -= turn;
      }
      (*J)(at[a], at[a]) += 1;
    }
  }
  return F;
}

/// Improves y. Returns whether a step of projection changes it by no more than `enough` of its size.
inline bool Solver::iterate_newton(Vector& y, double enough) const {
  constexpr int most = 30, halvings = 12;
  Matrix J;
  Vector F = projection_defect(y, &J);
  for (int round = 0; round < most; ++round) {
    const double size = std::max(1e-300, y.lpNorm<Eigen::Infinity>());
    if (F.lpNorm<Eigen::Infinity>() <= enough * size) return true;
    Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
    decomposition.setThreshold(1e-12);
    const Vector step = decomposition.compute(J).solve(F);
    if (!step.allFinite()) return false;
    double share = 1;
    Vector next = y - step;
    for (int k = 0; k < halvings && !(projection_defect(next, nullptr).norm() < F.norm()); ++k) {
      share /= 2;
      next = y - share * step;
    }
    const Vector defect = projection_defect(next, &J);
    if (!(defect.norm() < F.norm())) return F.lpNorm<Eigen::Infinity>() <= 10 * enough * size;
    y = next;
    F = defect;
  }
  return false;
}

}  // namespace eom::contacts::friction
