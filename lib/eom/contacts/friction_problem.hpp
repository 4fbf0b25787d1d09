// SPDX-License-Identifier: MIT
// Forces, or impulses, of several contacts with friction at the same instant: one complementarity problem. In: the
// responses G of velocities to unit forces, the velocities q without them, the laws. Out: the forces, with the
// complementarity residual, or the report that there are none.
//
// With accelerations in place of velocities the forces decide which contacts stay closed and stick, with velocities the
// impulses of an impact follow. Friction in one direction is exact: with beta in both senses and sigma the speed,
//   G z + q + sigma >= 0, mu N - sum beta >= 0, both complementary (Anitescu and Potra 1997, eq. (9)),
// solved by Lemke's pivoting. In two directions this problem has a polygon in place of the circle; its solution starts
// an iteration on the circle, which ends at 1e-13: Newton's method, or projected Gauss-Seidel where that fails.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "eom/contacts/least_norm.hpp"
#include "eom/contacts/lemke.hpp"

namespace eom::contacts {

/// Friction at zero slip: |force along the tangents| <= coefficient * normal force. Indices are rows.
struct FrictionLaw {
  std::vector<Eigen::Index> tangents;  // one or two
  Eigen::Index normal = -1;            // -1: the normal force is given
  double normal_sign = 1;              // the normal force is normal_sign * force
  double given_normal = 0;             // beside a row: a further normal force, >= 0
  double coefficient = 0;
};

/// A linear complementarity problem with friction: velocities = G force + q, one kind per row, and the laws.
struct FrictionProblem {
  enum class Kind {
    bilateral,
    unilateral,
    friction
  };  // the velocity is 0; it is >= 0 and so is the force; a tangent of a law
  Eigen::MatrixXd G;
  Eigen::VectorXd q;
  std::vector<Kind> kinds;
  std::vector<FrictionLaw> laws;
};

/// A solution of a FrictionProblem.
struct FrictionForces {
  bool found = false;
  Eigen::VectorXd force, velocity;  // per row
  std::vector<double> speed;        // per law: of the slip
  double residual = 0;  // largest violation of the laws, as a share of the forces; see complementarity_residual()
};

/// How far the forces and velocities of all rows are from the laws: the largest change of a force in one step of
/// projection, with the velocities divided by their own responses, as a share of the largest force. It is 0 exactly
/// for solutions, and does not depend on the method that found them.
inline double complementarity_residual(const FrictionProblem& p, const FrictionForces& forces) {
  double largest = 0;
  double size = forces.force.size() > 0 ? forces.force.lpNorm<Eigen::Infinity>() : 0;
  const auto step = [&](Eigen::Index row, double response) {
    size = std::max(size, std::abs(p.q(row)) / response);
    return forces.velocity(row) / response;
  };
  for (Eigen::Index i = 0; i < p.q.size(); ++i) {
    const FrictionProblem::Kind kind = p.kinds[static_cast<std::size_t>(i)];
    const double response = std::abs(p.G(i, i));
    if (kind == FrictionProblem::Kind::friction || !(response > 0)) continue;
    const double change = step(i, response);
    const bool held = kind == FrictionProblem::Kind::bilateral;
    largest = std::max(largest, std::abs(held ? change : std::min(forces.force(i), change)));
  }
  for (const FrictionLaw& law : p.laws) {
    double slowest = 0, square = 0, moved = 0;
    for (const Eigen::Index row : law.tangents) slowest = std::max(slowest, p.G(row, row));
    if (!(slowest > 0)) continue;
    const double normal =
        law.normal < 0 ? std::abs(law.given_normal) : law.normal_sign * forces.force(law.normal) + law.given_normal;
    const double most = law.coefficient * std::max(0.0, normal);
    for (const Eigen::Index row : law.tangents) square += std::pow(forces.force(row) - step(row, slowest), 2);
    const double factor = square > most * most ? most / std::sqrt(square) : 1;
    for (const Eigen::Index row : law.tangents)
      moved = std::max(moved, std::abs(factor * (forces.force(row) - step(row, slowest)) - forces.force(row)));
    largest = std::max(largest, moved);
  }
  return size > 0 ? largest / size : 0;
}

namespace friction {

/// Tries all laws with 2 * `directions` or, for one tangent, 2 senses.
class Solver {
 public:
  using Index = Eigen::Index;
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  explicit Solver(const FrictionProblem& problem) : p_(problem) {
    for (Index i = 0; i < p_.q.size(); ++i)
      (p_.kinds[static_cast<std::size_t>(i)] == FrictionProblem::Kind::bilateral ? held_ : free_).push_back(i);
    eliminate_held();
    for (const FrictionLaw& law : p_.laws) {
      Vector slopes;
      limits_.push_back(limit(law, slopes));
      limit_slopes_.push_back(std::move(slopes));
      std::vector<Index>& places = tangent_places_.emplace_back();
      for (const Index row : law.tangents) places.push_back(place(row));
    }
  }

  /// The pivoting without scaling is least disturbed by dependent rows; with scaling it does not depend on units. The
  /// residual decides between them.
  FrictionForces run() {
    constexpr double accurate = 1e-10;
    const bool planar =
        std::any_of(p_.laws.begin(), p_.laws.end(), [](const FrictionLaw& law) { return law.tangents.size() == 2; });
    FrictionForces best;
    for (const double softness : {1e-13, 1e-10}) {
      for (const bool scaled : {false, true}) {
        FrictionForces result = by_pivoting(softness, scaled);
        if (!result.found) continue;
        if (planar) refine(result);
        result.residual = complementarity_residual(p_, result);
        if (!best.found || result.residual < best.residual) best = std::move(result);
        if (planar || best.residual <= accurate) return best;  // the iteration does not depend on its start
      }
    }
    return best;
  }

 private:
  /// A force per direction of a polygon; `law` -1: a normal.
  struct Column {
    Index row;  // of a normal
    int law = -1;
    std::vector<double> along;  // of the tangents of the law
  };

  // Held rows follow from the others: force_held = h0 + H force_free.
  void eliminate_held() {
    const auto h = static_cast<Index>(held_.size()), f = static_cast<Index>(free_.size());
    G_ = Matrix(f, f), q_ = Vector(f);
    for (Index i = 0; i < f; ++i) {
      q_(i) = p_.q(free_at(i));
      for (Index k = 0; k < f; ++k) G_(i, k) = p_.G(free_at(i), free_at(k));
    }
    H_ = Matrix::Zero(h, f), h0_ = Vector::Zero(h);
    if (h == 0) return;
    Matrix of_held(h, h), cross(h, f), back(f, h);
    Vector right(h);
    for (Index i = 0; i < h; ++i) {
      right(i) = -p_.q(held_at(i));
      for (Index k = 0; k < h; ++k) of_held(i, k) = p_.G(held_at(i), held_at(k));
      for (Index k = 0; k < f; ++k)
        cross(i, k) = p_.G(held_at(i), free_at(k)), back(k, i) = p_.G(free_at(k), held_at(i));
    }
    h0_ = solve_least_norm(of_held, right).x;
    for (Index k = 0; k < f; ++k) H_.col(k) = solve_least_norm(of_held, -cross.col(k)).x;
    q_ += back * h0_;
    G_ += back * H_;
  }

  Index place(Index row) const {
    return static_cast<Index>(std::find(free_.begin(), free_.end(), row) - free_.begin());
  }
  Index held_place(Index row) const {
    const auto found = std::find(held_.begin(), held_.end(), row);
    return found == held_.end() ? -1 : static_cast<Index>(found - held_.begin());
  }

  /// The normal force of a law as an affine function of the forces of free rows.
  double limit(const FrictionLaw& law, Vector& by_force) const {
    by_force = Vector::Zero(q_.size());
    if (law.normal < 0) return law.coefficient * std::abs(law.given_normal);
    const double given = law.coefficient * law.given_normal;
    if (const Index held = held_place(law.normal); held >= 0) {
      by_force = law.coefficient * law.normal_sign * H_.row(held).transpose();
      return law.coefficient * law.normal_sign * h0_(held) + given;
    }
    by_force(place(law.normal)) = law.coefficient * law.normal_sign;
    return given;
  }

  FrictionForces by_pivoting(double softness, bool scaled) const {
    std::vector<Column> columns;
    for (const Index row : free_)
      if (p_.kinds[static_cast<std::size_t>(row)] == FrictionProblem::Kind::unilateral)
        columns.push_back({place(row), -1, {}});
    for (int l = 0; l < static_cast<int>(p_.laws.size()); ++l) {
      const std::size_t senses = p_.laws[static_cast<std::size_t>(l)].tangents.size() == 1 ? 2 : polygon;
      for (std::size_t k = 0; k < senses; ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(senses);
        columns.push_back({-1, l,
                           senses == 2 ? std::vector<double>{k == 0 ? 1.0 : -1.0}
                                       : std::vector<double>{std::cos(angle), std::sin(angle)}});
      }
    }
    const auto n = static_cast<Index>(columns.size()), laws = static_cast<Index>(p_.laws.size());
    // Forces of free rows = B y with the forces y of the columns.
    Matrix B = Matrix::Zero(q_.size(), n);
    for (Index c = 0; c < n; ++c) {
      const Column& column = columns[static_cast<std::size_t>(c)];
      if (column.law < 0) {
        B(column.row, c) = 1;
        continue;
      }
      const FrictionLaw& law = p_.laws[static_cast<std::size_t>(column.law)];
      for (std::size_t a = 0; a < column.along.size(); ++a) B(place(law.tangents[a]), c) = column.along[a];
    }
    Matrix M = Matrix::Zero(n + laws, n + laws);
    Vector q = Vector::Zero(n + laws);
    // Dependent rows with rounding errors may contradict one another. A small share of each row's own response makes
    // the problem solvable, and shares the force among them.
    Matrix G = G_;
    G.diagonal() += softness * G_.diagonal().cwiseAbs();
    M.topLeftCorner(n, n) = B.transpose() * G * B;
    q.head(n) = B.transpose() * q_;
    for (Index l = 0; l < laws; ++l) {
      Vector by_force;
      q(n + l) = limit(p_.laws[static_cast<std::size_t>(l)], by_force);
      M.row(n + l).head(n) = by_force.transpose() * B;
      for (Index c = 0; c < n; ++c) {
        if (columns[static_cast<std::size_t>(c)].law != l) continue;
        M(n + l, c) -= 1;
        M(c, n + l) = 1;
      }
    }
    const ComplementaritySolution solution = solve_complementarity(M, q, scaled);
    FrictionForces result = complete(B * solution.z.head(n));
    result.found = solution.found;
    if (!solution.found) return result;
    // The share leaves velocities of its own size, which would count as slip. A step of the proximal point method from
    // this solution removes them.
    q.head(n) = B.transpose() * (q_ - softness * G_.diagonal().cwiseAbs().cwiseProduct(B * solution.z.head(n)));
    const ComplementaritySolution corrected = solve_complementarity(M, q, scaled);
    if (!corrected.found) return result;
    FrictionForces better = complete(B * corrected.z.head(n));
    return complementarity_residual(p_, better) < complementarity_residual(p_, result) ? better : result;
  }

  /// Forces and velocities of all rows from the forces of the free ones.
  FrictionForces complete(const Vector& free_forces) const {
    FrictionForces result{true, Vector::Zero(p_.q.size()), Vector::Zero(p_.q.size()), {}, 0};
    for (std::size_t i = 0; i < free_.size(); ++i) result.force(free_[i]) = free_forces(static_cast<Index>(i));
    const Vector held = h0_ + H_ * free_forces;
    for (std::size_t i = 0; i < held_.size(); ++i) result.force(held_[i]) = held(static_cast<Index>(i));
    result.velocity = p_.G * result.force + p_.q;
    for (const FrictionLaw& law : p_.laws) {
      double square = 0;
      for (const Index row : law.tangents) square += result.velocity(row) * result.velocity(row);
      result.speed.push_back(std::sqrt(square));
    }
    return result;
  }

  /// Projects onto the half lines of normals and the discs of friction, until nothing changes.
  void refine(FrictionForces& result) const {
    constexpr int few = 20, most = 200000;
    constexpr double enough = 1e-13;
    Vector y(q_.size());
    for (Index i = 0; i < y.size(); ++i) y(i) = result.force(free_at(i));
    if (!sweep(y, few, enough)) {
      Vector better = y;
      if (iterate_newton(better, enough))
        y = better;
      else
        sweep(y, most, enough);
    }
    result = complete(y);
  }

  /// Gauss-Seidel with projections. Returns whether the last round changed no force by more than `enough`.
  bool sweep(Vector& y, int rounds, double enough) const {
    Vector velocity = G_ * y + q_;
    const auto set = [&](Index i, double value) {
      const double change = value - y(i);
      if (change == 0) return 0.0;
      y(i) = value;
      velocity += change * G_.col(i);
      return std::abs(change);
    };
    double size = std::max(1e-300, y.lpNorm<Eigen::Infinity>());
    for (int round = 0; round < rounds; ++round) {
      double moved = 0;
      for (Index i = 0; i < y.size(); ++i) {
        if (p_.kinds[static_cast<std::size_t>(free_at(i))] != FrictionProblem::Kind::unilateral || !(G_(i, i) > 0))
          continue;
        moved = std::max(moved, set(i, std::max(0.0, y(i) - velocity(i) / G_(i, i))));
      }
      for (std::size_t l = 0; l < p_.laws.size(); ++l) moved = std::max(moved, project_friction(l, y, velocity, set));
      size = std::max(size, y.lpNorm<Eigen::Infinity>());
      if (moved <= enough * size) return true;
    }
    return false;
  }

  template <class Set>
  double project_friction(std::size_t l, const Vector& y, const Vector& velocity, const Set& set) const {
    const std::vector<Index>& at = tangent_places_[l];
    const double most = std::max(0.0, limits_[l] + limit_slopes_[l].dot(y));
    std::array<double, 2> wanted{};
    double square = 0, slowest = 0;
    for (const Index i : at) slowest = std::max(slowest, G_(i, i));
    if (!(slowest > 0)) return 0;
    for (std::size_t a = 0; a < at.size(); ++a) {
      wanted[a] = y(at[a]) - velocity(at[a]) / slowest;
      square += wanted[a] * wanted[a];
    }
    const double length = std::sqrt(square), factor = length > most ? most / length : 1;
    double moved = 0;
    for (std::size_t a = 0; a < at.size(); ++a) moved = std::max(moved, set(at[a], factor * wanted[a]));
    return moved;
  }

  Vector projection_defect(const Vector& y, Matrix* J) const;
  bool iterate_newton(Vector& y, double enough) const;

  static constexpr std::size_t polygon = 8;

  const FrictionProblem& p_;
  Index held_at(Index i) const { return held_[static_cast<std::size_t>(i)]; }
  Index free_at(Index i) const { return free_[static_cast<std::size_t>(i)]; }

  std::vector<Index> held_, free_;
  Matrix G_, H_;
  Vector q_, h0_;
  // Per law: its tangents among the free rows, and its normal force as an affine function of their forces.
  std::vector<std::vector<Index>> tangent_places_;
  std::vector<double> limits_;
  std::vector<Vector> limit_slopes_;
};

}  // namespace friction

inline FrictionForces solve_friction_problem(const FrictionProblem& problem) { return friction::Solver(problem).run(); }

}  // namespace eom::contacts

#include "eom/contacts/friction_newton.hpp"  // the member that solves by Newton's method
