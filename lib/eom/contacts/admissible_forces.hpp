// SPDX-License-Identifier: MIT
// Forces of contacts that the motion does not determine, within the limits of their laws: a ladder stands on a rough
// floor at a rough wall if any forces that hold it obey Coulomb's law at both ends. In: one solution, the directions in
// which forces cause no motion, the limits. Out: a solution within the limits, if there is one.
//
// The solution of least norm is taken as long as it obeys the laws by a margin. Else it moves towards the forces whose
// least margin is largest. Both depend continuously on the state, and contacts slip or open where no forces hold them.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace eom::contacts {

/// The limits of one contact: N >= 0 and |T| <= coefficient N, with N = scale x(normal), or a given N.
struct ForceLimit {
  Eigen::Index normal = -1;   // index of lambda; -1: the normal force is given
  double scale = 1;           // N / lambda
  double given = 0;           // N, where it is given
  bool holds = false;         // T is limited: the contact sticks
  double coefficient = 0;     // of static friction
  std::size_t tangents = 0;   // 0 to 2
  Eigen::Index tangent = -1;  // index of the first component of T; the second one follows
  double size = 1;            // of the forces, which makes margins comparable
};

/// Forces that obey their limits by this margin are taken as they are.
inline constexpr double wanted_margin = 1e-3;

/// The least margin of all limits, as a share of the sizes of their forces; 1 at most.
inline double least_margin(const std::vector<ForceLimit>& limits, const Eigen::VectorXd& x) {
  double least = 1;
  for (const ForceLimit& limit : limits) {
    const double normal = limit.normal < 0 ? limit.given : limit.scale * x(limit.normal);
    if (limit.normal >= 0) least = std::min(least, normal / limit.size);
    if (!limit.holds) continue;
    double square = 0;
    for (std::size_t a = 0; a < limit.tangents; ++a)
      square += std::pow(x(limit.tangent + static_cast<Eigen::Index>(a)), 2);
    least = std::min(least, (limit.coefficient * normal - std::sqrt(square)) / limit.size);
  }
  return least;
}

inline constexpr double last_barrier_weight = 1e-12;

/// The error of the largest margin that AdmissibleForces finds: a share of the forces for each term of the barrier.
/// Where the limits leave one set of forces alone, its margin is 0 but for this.
inline double margin_error(const std::vector<ForceLimit>& limits) {
  double terms = 1;
  for (const ForceLimit& limit : limits) terms += (limit.normal >= 0 ? 1 : 0) + (limit.holds ? 1 : 0);
  return last_barrier_weight * terms;
}

/// Finds forces x + Z y within the limits.
class AdmissibleForces {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// x: a solution; Z: a basis of the directions without effect; `limits` must outlive this object.
  AdmissibleForces(Vector x, Matrix Z, const std::vector<ForceLimit>& limits)
      : x_(std::move(x)), Z_(std::move(Z)), limits_(limits), best_(x_) {
    for (const ForceLimit& limit : limits_) size_ = std::max(size_, limit.size);
  }

  /// The forces. They are x if it obeys all limits by a margin.
  Vector find() {
    if (Z_.cols() == 0 || !(size_ > 0) || least_margin(limits_, x_) >= wanted_margin) return x_;
    write_margins();
    best_ = x_ + Z_ * largest_margin();
    const double reached = least_margin(limits_, best_);
    if (!(reached > 0)) return best_;
    const double margin = std::min(wanted_margin, reached / 2);
    double outside = 0, inside = 1;  // of the way from x to the best forces: the margin is a concave function
    for (int k = 0; k < bisections; ++k) {
      const double middle = (outside + inside) / 2;
      (least_margin(limits_, x_ + middle * (best_ - x_)) >= margin ? inside : outside) = middle;
    }
    return x_ + std::min(1.0, 2 * inside) * (best_ - x_);
  }
  /// After find(): the forces whose least margin is largest, or x.
  const Vector& best() const { return best_; }

 private:
  static constexpr double pull = 1e-7;  // towards small y: margins may grow without bound
  static constexpr double last_weight = last_barrier_weight, weight_ratio = 0.1;
  static constexpr int bisections = 40, most_newton_steps = 30;

  /// Affine functions of v = (y, s): at + slopes v, one per row.
  struct Affine {
    Vector at;
    Matrix slopes;
    void resize(Index rows, Index columns) { at.setZero(rows), slopes.setZero(rows, columns); }
    Vector operator()(const Vector& v) const { return at + slopes * v; }
  };

  /// All margins minus s, and the components of the friction forces; y has the unit size_.
  void write_margins() {
    const Index d = Z_.cols();
    Index normals = 1, laws = 0, tangents = 0;
    for (const ForceLimit& limit : limits_) {
      normals += limit.normal >= 0 ? 1 : 0;
      laws += limit.holds ? 1 : 0;
      tangents += limit.holds ? static_cast<Index>(limit.tangents) : 0;
    }
    linear_.resize(normals, d + 1), bounds_.resize(laws, d + 1), friction_.resize(tangents, d + 1);
    linear_.at(0) = 1, linear_.slopes(0, d) = -1;  // 1 - s
    normals = 1, laws = tangents = 0;
    const auto write = [&](Affine& rows, Index row, Index force, double factor) {
      rows.at(row) += factor * x_(force);
      rows.slopes.row(row).head(d) += factor * size_ * Z_.row(force);
    };
    for (const ForceLimit& limit : limits_) {
      if (limit.normal >= 0) {
        write(linear_, normals, limit.normal, limit.scale / limit.size);
        linear_.slopes(normals++, d) = -1;
      }
      if (!limit.holds) continue;
      if (limit.normal >= 0)
        write(bounds_, laws, limit.normal, limit.coefficient * limit.scale / limit.size);
      else
        bounds_.at(laws) = limit.coefficient * limit.given / limit.size;
      bounds_.slopes(laws++, d) = -1;
      for (std::size_t k = 0; k < limit.tangents; ++k)
        write(friction_, tangents++, limit.tangent + static_cast<Index>(k), 1 / limit.size);
    }
  }

  /// Minimises -s + pull |y|^2 / 2 + weight B(y, s), B: logarithmic barriers of all margins minus s, and of 1 - s, for
  /// ever smaller weights (Boyd and Vandenberghe, Convex Optimization, section 11.3). y has the unit size_.
  Vector largest_margin() const {
    const Index d = Z_.cols();
    Vector v = Vector::Zero(d + 1);  // y, s
    v(d) = least_margin(limits_, x_) - 1;
    Vector gradient(d + 1);
    Matrix hessian(d + 1, d + 1);
    for (double weight = 1; weight >= last_weight; weight *= weight_ratio) {
      for (int step = 0; step < most_newton_steps; ++step) {
        const double now = evaluate(v, weight, &gradient, &hessian);
        const Vector direction = -hessian.ldlt().solve(gradient);
        const double fall = gradient.dot(direction);
        if (!direction.allFinite() || !(fall < -1e-10 * weight)) break;
        double length = 1;
        while (length > 1e-10 &&
               !(evaluate(v + length * direction, weight, nullptr, nullptr) <= now + 0.1 * length * fall))
          length /= 2;
        if (!(length > 1e-10)) break;
        v += length * direction;
      }
    }
    return size_ * v.head(d);
  }

  /// The function that largest_margin() minimises, with its derivatives; infinite outside the limits.
  double evaluate(const Vector& v, double weight, Vector* gradient, Matrix* hessian) const {
    const Index d = Z_.cols();
    const double infinite = std::numeric_limits<double>::infinity();
    const Vector margins = linear_(v), a = bounds_(v), b = friction_(v);
    if (!(margins.minCoeff() > 0)) return infinite;
    double value = -v(d) + pull / 2 * v.head(d).squaredNorm() - weight * margins.array().log().sum();
    if (gradient != nullptr) {
      const Vector inverse = margins.cwiseInverse();
      gradient->noalias() = -weight * (linear_.slopes.transpose() * inverse);
      gradient->head(d) += pull * v.head(d);
      (*gradient)(d) -= 1;
      hessian->noalias() =
          linear_.slopes.transpose() * (weight * inverse.array().square()).matrix().asDiagonal() * linear_.slopes;
      hessian->topLeftCorner(d, d).diagonal().array() += pull;
    }
    // -log(a^2 - |b|^2) with a = coefficient N / size - s and b = T / size.
    Index law = 0, tangent = 0;
    for (const ForceLimit& limit : limits_) {
      if (!limit.holds) continue;
      const auto count = static_cast<Index>(limit.tangents);
      const double inside = a(law) * a(law) - b.segment(tangent, count).squaredNorm();
      if (!(a(law) > 0 && inside > 0)) return infinite;
      value -= weight * std::log(inside);
      if (gradient != nullptr) {
        const auto of_a = bounds_.slopes.row(law).transpose();
        const auto of_b = friction_.slopes.middleRows(tangent, count);
        const Vector slope = 2 * (a(law) * of_a - of_b.transpose() * b.segment(tangent, count));
        *gradient -= weight / inside * slope;
        *hessian += weight / (inside * inside) * slope * slope.transpose();
        *hessian -= 2 * weight / inside * (of_a * of_a.transpose() - of_b.transpose() * of_b);
      }
      ++law, tangent += count;
    }
    return value;
  }

  Vector x_;
  Matrix Z_;
  const std::vector<ForceLimit>& limits_;
  double size_ = 0;
  Vector best_;
  Affine linear_, bounds_, friction_;  // normal forces and 1; limits of friction; friction
};

/// Smaller effects, of unit forces with an effect of 1, are rounding.
inline constexpr double effect_tolerance = 1e-5;

/// A basis of the forces without effect: columns Z with R Z = 0. R: accelerations for unit forces, n x k. Columns of R
/// are scaled before, so that forces of different units count alike.
inline Eigen::MatrixXd forces_without_effect(Eigen::MatrixXd R) {
  const Eigen::Index k = R.cols();
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const double size = R.col(i).norm();
    if (size > 0) columns(i) = 1 / size, R.col(i) /= size;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(effect_tolerance);
  decomposition.compute(R);
  // R P = Q [T 0; 0 0] Z: the last rows of Z span the directions without effect.
  const Eigen::Index rank = decomposition.rank(), count = k - rank;
  if (count == 0) return Eigen::MatrixXd(k, 0);
  const Eigen::MatrixXd basis = decomposition.matrixZ().transpose().rightCols(count);
  Eigen::MatrixXd Z = columns.asDiagonal() * (decomposition.colsPermutation() * basis);
  for (Eigen::Index i = 0; i < count; ++i) Z.col(i) /= Z.col(i).lpNorm<Eigen::Infinity>();
  return Z;
}

}  // namespace eom::contacts
