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

/// Finds forces x + Z y within the limits.
class AdmissibleForces {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// x: a solution; Z: a basis of the directions without effect; `limits` must outlive this object.
  AdmissibleForces(Vector x, Matrix Z, const std::vector<ForceLimit>& limits)
      : x_(std::move(x)), Z_(std::move(Z)), limits_(limits) {
    size_ = 0;
    for (const ForceLimit& limit : limits_) size_ = std::max(size_, limit.size);
  }

  /// The forces. They are x if it obeys all limits by a margin.
  Vector find() const {
    if (Z_.cols() == 0 || !(size_ > 0) || least_margin(limits_, x_) >= wanted_margin) return x_;
    const Vector best = x_ + Z_ * largest_margin();
    const double reached = least_margin(limits_, best);
    if (!(reached > 0)) return best;
    const double margin = std::min(wanted_margin, reached / 2);
    double outside = 0, inside = 1;  // of the way from x to the best forces: the margin is a concave function
    for (int k = 0; k < bisections; ++k) {
      const double middle = (outside + inside) / 2;
      (least_margin(limits_, x_ + middle * (best - x_)) >= margin ? inside : outside) = middle;
    }
    return x_ + std::min(1.0, 2 * inside) * (best - x_);
  }

 private:
  static constexpr double pull = 1e-7;  // towards small y: margins may grow without bound
  static constexpr double last_weight = 1e-9, weight_ratio = 0.1;
  static constexpr int bisections = 40, most_newton_steps = 30;

  /// Minimises -s + pull |y|^2 / 2 + weight B(y, s), B: logarithmic barriers of all margins minus s, and of 1 - s, for
  /// ever smaller weights (Boyd and Vandenberghe, Convex Optimization, section 11.3). y has the unit size_.
  Vector largest_margin() const {
    const Index d = Z_.cols();
    Vector v = Vector::Zero(d + 1);  // y, s
    v(d) = least_margin(limits_, x_) - 1;
    for (double weight = 1; weight >= last_weight; weight *= weight_ratio) {
      for (int step = 0; step < most_newton_steps; ++step) {
        Vector gradient(d + 1);
        Matrix hessian(d + 1, d + 1);
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
    const double s = v(d), infinite = std::numeric_limits<double>::infinity();
    const Vector x = x_ + size_ * (Z_ * v.head(d));
    double value = -s + pull / 2 * v.head(d).squaredNorm();
    if (gradient != nullptr) {
      *gradient = Vector::Zero(d + 1);
      gradient->head(d) = pull * v.head(d);
      (*gradient)(d) = -1;
      *hessian = Matrix::Zero(d + 1, d + 1);
      hessian->topLeftCorner(d, d).diagonal().setConstant(pull);
    }
    const auto row = [&](Index force, double factor) {  // d(factor x(force))/dv
      Vector result = Vector::Zero(d + 1);
      result.head(d) = factor * size_ * Z_.row(force).transpose();
      return result;
    };
    const auto add_linear = [&](double margin, const Vector& slope) {
      if (!(margin > 0)) return false;
      value -= weight * std::log(margin);
      if (gradient == nullptr) return true;
      *gradient -= weight / margin * slope;
      *hessian += weight / (margin * margin) * slope * slope.transpose();
      return true;
    };
    Vector last = Vector::Zero(d + 1);
    last(d) = -1;
    if (!add_linear(1 - s, last)) return infinite;
    for (const ForceLimit& limit : limits_) {
      const double normal = limit.normal < 0 ? limit.given : limit.scale * x(limit.normal);
      Vector slope = limit.normal < 0 ? Vector(Vector::Zero(d + 1)) : row(limit.normal, limit.scale / limit.size);
      if (limit.normal >= 0 && !add_linear(normal / limit.size - s, slope + last)) return infinite;
      if (!limit.holds) continue;
      // -log(a^2 - |b|^2) with a = coefficient N / size - s and b = T / size.
      const double a = limit.coefficient * normal / limit.size - s;
      const Vector slope_a = limit.coefficient * slope + last;
      double inside = a * a;
      Vector slope_of_inside = 2 * a * slope_a;
      Matrix curvature = 2 * slope_a * slope_a.transpose();
      for (std::size_t k = 0; k < limit.tangents; ++k) {
        const Index tangent = limit.tangent + static_cast<Index>(k);
        const double b = x(tangent) / limit.size;
        const Vector slope_b = row(tangent, 1 / limit.size);
        inside -= b * b;
        slope_of_inside -= 2 * b * slope_b;
        curvature -= 2 * slope_b * slope_b.transpose();
      }
      if (!(a > 0 && inside > 0)) return infinite;
      value -= weight * std::log(inside);
      if (gradient == nullptr) continue;
      *gradient -= weight / inside * slope_of_inside;
      *hessian +=
          weight / (inside * inside) * slope_of_inside * slope_of_inside.transpose() - weight / inside * curvature;
    }
    return value;
  }

  Vector x_;
  Matrix Z_;
  const std::vector<ForceLimit>& limits_;
  double size_ = 0;
};

/// A basis of the forces without effect: columns Z with R Z = 0. R: accelerations for unit forces, n x k. Columns of R
/// are scaled before, so that forces of different units count alike.
inline Eigen::MatrixXd forces_without_effect(Eigen::MatrixXd R) {
  constexpr double rank_tolerance = 1e-10;
  const Eigen::Index k = R.cols();
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const double size = R.col(i).norm();
    if (size > 0) columns(i) = 1 / size, R.col(i) /= size;
  }
  const Eigen::MatrixXd square = R.transpose() * R;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> decomposition(square);
  Eigen::Index count = 0;  // eigenvalues ascend
  while (count < k && decomposition.eigenvalues()(count) < rank_tolerance) ++count;
  Eigen::MatrixXd Z = columns.asDiagonal() * decomposition.eigenvectors().leftCols(count);
  for (Eigen::Index i = 0; i < count; ++i) Z.col(i) /= Z.col(i).lpNorm<Eigen::Infinity>();
  return Z;
}

}  // namespace eom::contacts
