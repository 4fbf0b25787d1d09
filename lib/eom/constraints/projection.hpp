// SPDX-License-Identifier: MIT
// Projection of a state x = (q, v) onto its constraints psi(q, t) = 0 and A(q, t) v + b(q, t) = 0, in the metric of M.
// In: callbacks for psi, A, b and for M. Out: the projected x, a code, iterations, sizes of the corrections.
//
// Positions by Newton's method: dq minimises dq^T M dq among the least-squares solutions of A dq = -psi. Velocities by
// one linear solve: the same with the defect A v + b. If M is regular and A has full rank, this is
//   dq = -M^-1 A^T (A M^-1 A^T)^-1 psi,
// the solution of the KKT system [M A^T; A 0] (dq, lambda) = (0, -psi). M may be singular if it is positive definite on
// the null space of A. Directions without mass even there do not move. A column-pivoted QR of A^T detects redundant
// rows, which are satisfied in the least-squares sense.
//
// With many rows the matrix of this formula, that of an earlier state, serves for later ones until Newton's method
// becomes slow: the corrections are far smaller than the changes of the state.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace eom {

/// Tolerances of a projection.
struct ProjectionOptions {
  double tolerance = 1e-14;       // of the correction relative to the largest coordinate, of psi to its terms |A||q|
  double rank_tolerance = 1e-11;  // of a pivot relative to the largest, rows of A scaled to length 1
  int max_iterations = 25;
  double rounding = 1e-11;  // a correction that stagnates below this times max(1, |q|) counts as converged
};

/// Outcome of a projection.
struct ProjectionResult {
  static constexpr int not_converged = -1;

  int code = 0;                    // 0, the code of a callback, or not_converged
  int iterations = 0;              // Newton corrections of the positions
  int rank = -1;                   // of A in the last solve; -1: the state was already consistent
  double position_correction = 0;  // largest component of q - q before
  double velocity_correction = 0;  // largest component of v - v before
};

/// The method with its work space for n coordinates and m constraints. With fewer than many_rows it allocates in the
/// constructor only.
class Projection {
 public:
  using Index = Eigen::Index;
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  /// The first `holonomic` of the m rows have a psi. The others constrain velocities only; their psi is ignored.
  Projection(std::size_t n, std::size_t m, std::size_t holonomic, const ProjectionOptions& options = {})
      : options_(options),
        n_(static_cast<Index>(n)),
        m_(static_cast<Index>(m)),
        positions_(n_, static_cast<Index>(holonomic)),
        velocities_(n_, m_),
        psi_(m_),
        b_(m_),
        A_(m_, n_),
        M_(n_, n_),
        h_(n_),
        defect_(m_),
        correction_(n_),
        before_(2 * n_) {}

  /// From this number of constraints on, matrices are kept from one state to the next.
  static constexpr Index many_rows = 6;

  /// The constraints are others now.
  void reset() { positions_.has_inverse = velocities_.has_inverse = false; }

  /// All m rows have a psi.
  Projection(std::size_t n, std::size_t m) : Projection(n, m, m) {}

  /// Projects x (2n components; further ones do not change). constraints(t, x, psi, A, b) -> int, with A m x n
  /// column-major, and mass(t, x, M, h) -> int, with M n x n, as in the C ABI; h is not used. If the code is not 0, x
  /// is unchanged.
  template <class Constraints, class Mass>
  ProjectionResult operator()(double t, double* x, Constraints&& constraints, Mass&& mass) {
    Eigen::Map<Vector> state(x, 2 * n_);
    before_ = state;
    ProjectionResult result;
    if (m_ == 0) return result;
    const auto evaluate_constraints = [&] {
      const int code = constraints(t, x, psi_.data(), A_.data(), b_.data());
      return code != 0 || (A_.allFinite() && b_.allFinite()) ? code : code_not_finite;
    };
    const auto evaluate_mass = [&] {
      const int code = mass(t, x, M_.data(), h_.data());
      return code != 0 || M_.allFinite() ? code : code_not_finite;
    };
    // Nearly dependent rows turn rounding into large corrections, which diverge: the state is moved along fewer
    // directions then.
    for (tolerance_ = options_.rank_tolerance;; tolerance_ *= coarser) {
      result.code = move_positions(x, evaluate_constraints, evaluate_mass, result);
      if (result.code == 0 || result.iterations == 0 || tolerance_ * coarser > coarsest) break;
      state = before_;
      result.iterations = 0;
      positions_.has_inverse = false;
    }
    if (result.code == 0) result.code = move_velocities(x, evaluate_constraints, evaluate_mass, result);
    if (result.code != 0) {
      state = before_;
      return result;
    }
    result.position_correction = (state.head(n_) - before_.head(n_)).lpNorm<Eigen::Infinity>();
    result.velocity_correction = (state.tail(n_) - before_.tail(n_)).lpNorm<Eigen::Infinity>();
    return result;
  }

 private:
  /// The constrained least-squares problem of one shape (n coordinates, m rows) with its work space.
  struct Solver {
    Solver(Index n, Index m)
        : scaled_transpose(n, m), right(m), qr(n, m), rows(m, n), metric(n, n), w(n), metric_qr(n, n), length(m) {}

    Matrix scaled_transpose;  // A^T, rows of A scaled to length 1
    Vector right;             // the right-hand side, scaled and permuted
    Eigen::ColPivHouseholderQR<Matrix> qr;
    Matrix rows;    // R^T, m x rank in its first columns; later its own QR
    Matrix metric;  // Q^T M Q, and the system for the part of the solution in the null space of A
    Vector w;       // the solution in the basis Q
    Eigen::ColPivHouseholderQR<Matrix> metric_qr;
    Vector length;   // of the rows of A
    Matrix inverse;  // with many rows: the correction for each unit defect, in some earlier state
    bool has_inverse = false;
  };

  template <class Constraints, class Mass>
  int move_positions(double* x, const Constraints& evaluate_constraints, const Mass& evaluate_mass,
                     ProjectionResult& result) {
    const Index rows = positions_.right.size();
    Eigen::Map<Vector> q(x, n_);
    double last = std::numeric_limits<double>::infinity();
    while (rows > 0) {
      if (const int code = evaluate_constraints(); code != 0) return code;
      if (!psi_.head(rows).allFinite()) return code_not_finite;
      if (psi_small(q, rows)) break;
      if (result.iterations == options_.max_iterations) return ProjectionResult::not_converged;
      defect_.head(rows) = psi_.head(rows);
      const bool kept = positions_.has_inverse;
      if (result.iterations == 0 && !kept)  // the metric is that of the initial state
        if (const int code = evaluate_mass(); code != 0) return code;
      ++result.iterations;
      const double size = kept ? correct(positions_) : solve_anew(positions_, result);
      if (!std::isfinite(size)) return code_not_finite;
      if (kept && size > slow * last && size > options_.tolerance * q.lpNorm<Eigen::Infinity>()) {
        positions_.has_inverse = false;
        if (const int code = evaluate_mass(); code != 0) return code;
        continue;
      }
      q -= correction_;
      const double scale = q.lpNorm<Eigen::Infinity>();
      if (size <= options_.tolerance * scale) break;
      if (size > 0.5 * last && size <= options_.rounding * std::max(1.0, scale)) break;
      last = size;
    }
    return rows == 0 || met(psi_, rows, q) ? 0 : ProjectionResult::not_converged;
  }

  template <class Constraints, class Mass>
  int move_velocities(double* x, const Constraints& evaluate_constraints, const Mass& evaluate_mass,
                      ProjectionResult& result) {
    Eigen::Map<Vector> v(x + n_, n_);
    if (const int code = evaluate_constraints(); code != 0) return code;
    if (defect_small(v)) return 0;
    if (positions_.has_inverse && !velocities_.has_inverse && positions_.right.size() == m_)
      velocities_.inverse = positions_.inverse, velocities_.has_inverse = true;
    double last = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < options_.max_iterations && velocities_.has_inverse; ++pass) {
      const double size = correct(velocities_);
      if (!(size <= slow * last)) break;
      v -= correction_;
      if (defect_small(v)) return 0;
      last = size;
    }
    if (last <= options_.tolerance * v.lpNorm<Eigen::Infinity>() && met(defect_, m_, v)) return 0;
    if (const int code = evaluate_mass(); code != 0) return code;
    for (int pass = 0; pass < 2; ++pass) {  // the second one removes the rounding of the first
      if (!std::isfinite(solve_anew(velocities_, result))) return code_not_finite;
      v -= correction_;
      if (defect_small(v)) return 0;
    }
    return met(defect_, m_, v) ? 0 : ProjectionResult::not_converged;
  }

  /// Computes defect_ = A v + b. Returns whether it is within the rounding of its terms.
  bool defect_small(const Eigen::Map<Vector>& v) {
    bool small = true;
    for (Index i = 0; i < m_; ++i) {
      double sum = b_(i);
      double terms = std::abs(b_(i));
      for (Index j = 0; j < n_; ++j) {
        const double term = A_(i, j) * v(j);
        sum += term;
        terms += std::abs(term);
      }
      defect_(i) = sum;
      small = small && std::abs(sum) <= 4 * std::numeric_limits<double>::epsilon() * terms;
    }
    return small;
  }

  /// Whether psi_i is within the rounding of its terms, estimated by |A| |q|.
  bool psi_small(const Eigen::Map<Vector>& q, Index rows) const {
    for (Index i = 0; i < rows; ++i) {
      double terms = 0;
      for (Index j = 0; j < n_; ++j) terms += std::abs(A_(i, j) * q(j));
      if (!(std::abs(psi_(i)) <= options_.tolerance * terms)) return psi_.head(rows).isZero(0);
    }
    return true;
  }

  /// Contradictory rows are satisfied in the least-squares sense only, so corrections converge as well. This is an
  /// error.
  bool met(const Vector& residual, Index rows, const Eigen::Map<Vector>& y) const {
    const double scale = std::max(1.0, y.lpNorm<Eigen::Infinity>());
    for (Index i = 0; i < rows; ++i)
      if (!(std::abs(residual(i)) <= 10 * options_.rounding * scale * std::max(1.0, A_.row(i).norm()))) return false;
    return true;
  }

  /// correction_ = the smallest in the metric M_ among the least-squares solutions of A correction = defect, for the
  /// first rows of A_ and defect_, as many as s has. Returns its largest component.
  double solve(Solver& s, ProjectionResult& result) {
    factor_rows(s);
    const Index rank = rank_of(s.qr, tolerance_);
    result.rank = static_cast<int>(rank);
    solve_range_part(s, rank);
    solve_null_part(s, rank);
    correction_ = s.w;  // correction = Q w
    for (Index k = std::min(n_, s.right.size()); k-- > 0;) reflect(s.qr, k, correction_);
    return correction_.lpNorm<Eigen::Infinity>();
  }

  /// As solve(). With many rows the inverse is kept.
  double solve_anew(Solver& s, ProjectionResult& result) {
    if (s.right.size() < many_rows || !find_inverse(s, result)) return solve(s, result);
    return correct(s);
  }
  /// correction_ by the kept inverse. Returns its largest component.
  double correct(const Solver& s) {
    correction_.noalias() = s.inverse * defect_.head(s.right.size());
    return correction_.lpNorm<Eigen::Infinity>();
  }
  /// With M = L L^T and B = A L^-T the correction is L^-T B^+ defect. False: M is not regular.
  bool find_inverse(Solver& s, ProjectionResult& result) const {
    constexpr double regular = 1e-7;  // of the largest pivot
    const Eigen::LLT<Matrix> factors(M_);
    const Vector pivots = factors.matrixLLT().diagonal();
    if (factors.info() != Eigen::Success || !(pivots.minCoeff() > regular * pivots.maxCoeff())) return false;
    Matrix transpose = A_.topRows(s.right.size()).transpose();
    factors.matrixL().solveInPlace(transpose);
    for (Index i = 0; i < transpose.cols(); ++i) {
      const double length = transpose.col(i).norm();
      s.length(i) = length > 0 ? length : 1;
      transpose.col(i) /= s.length(i);
    }
    Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
    decomposition.setThreshold(tolerance_);
    decomposition.compute(transpose.transpose());
    result.rank = static_cast<int>(decomposition.rank());
    s.inverse = decomposition.pseudoInverse();
    factors.matrixU().solveInPlace(s.inverse);
    for (Index i = 0; i < s.inverse.cols(); ++i) s.inverse.col(i) /= s.length(i);
    s.has_inverse = true;
    return true;
  }

  /// A^T P = Q R with rows of A scaled to length 1. A row of zeros does not change and is redundant.
  void factor_rows(Solver& s) const {
    const Index rows = s.right.size();
    for (Index i = 0; i < rows; ++i) {
      const double length = A_.row(i).norm();
      s.length(i) = length > 0 ? length : 1;
      s.scaled_transpose.col(i) = A_.row(i).transpose() / s.length(i);
    }
    s.qr.compute(s.scaled_transpose);
  }

  /// The part w_1..rank of Q^T dq: R^T w = P^T defect, by Householder reflections, in the least-squares sense.
  void solve_range_part(Solver& s, Index rank) const {
    const Index rows = s.right.size();
    const auto& permutation = s.qr.colsPermutation().indices();
    for (Index i = 0; i < rows; ++i) {
      const Index row = permutation(i);
      s.right(i) = defect_(row) / s.length(row);
      for (Index j = 0; j < rank; ++j) s.rows(i, j) = j <= i ? s.qr.matrixQR()(j, i) : 0.0;
    }
    for (Index k = 0; k < rank; ++k) {
      auto column = s.rows.col(k).segment(k, rows - k);
      const double pivot = column(0) > 0 ? -column.norm() : column.norm();
      if (pivot == 0) continue;
      column(0) -= pivot;
      const double scale = 2 / column.squaredNorm();
      for (Index j = k + 1; j < rank; ++j) {
        auto other = s.rows.col(j).segment(k, rows - k);
        other -= scale * column.dot(other) * column;
      }
      auto tail = s.right.segment(k, rows - k);
      tail -= scale * column.dot(tail) * column;
      s.w(k) = pivot;  // the diagonal of the triangle, until w is solved for below
    }
    for (Index k = rank; k-- > 0;) {
      double sum = s.right(k);
      for (Index j = k + 1; j < rank; ++j) sum -= s.rows(k, j) * s.w(j);
      s.w(k) = sum / s.w(k);
    }
  }

  /// The part of w in the null space of A: S22 w2 = -S21 w1 with S = Q^T M Q; zero if S22 is singular.
  void solve_null_part(Solver& s, Index rank) {
    s.metric = M_;
    for (Index k = 0; k < std::min(n_, s.right.size()); ++k) {
      for (Index j = 0; j < n_; ++j) reflect(s.qr, k, s.metric.col(j));
      for (Index j = 0; j < n_; ++j) reflect(s.qr, k, s.metric.row(j));
    }
    const Index free = n_ - rank;
    for (Index i = rank; i < n_; ++i) {
      double sum = 0;
      for (Index j = 0; j < rank; ++j) sum -= s.metric(i, j) * s.w(j);
      s.w(i) = sum;
    }
    const double largest = free > 0 ? s.metric.bottomRightCorner(free, free).lpNorm<Eigen::Infinity>() : 0;
    const double scale = largest > 0 ? 1 / largest : 0;
    s.metric.topRows(rank).setZero();  // the first rows are w1 = w1, so that the size remains n x n
    s.metric.leftCols(rank).setZero();
    s.metric.topLeftCorner(rank, rank).diagonal().setOnes();
    s.metric.bottomRightCorner(free, free) *= scale;
    s.w.tail(free) *= scale;
    s.metric_qr.compute(s.metric);
    solve_by(s.metric_qr, s.w);
  }

  /// Basic solution of (the square matrix of qr) y = right, in place; correction_ is work space.
  void solve_by(const Eigen::ColPivHouseholderQR<Matrix>& qr, Vector& right) {
    const Index rank = rank_of(qr, options_.rank_tolerance);
    for (Index k = 0; k < n_; ++k) reflect(qr, k, right);
    right.tail(n_ - rank).setZero();
    for (Index k = rank; k-- > 0;) {
      double sum = right(k);
      for (Index j = k + 1; j < rank; ++j) sum -= qr.matrixQR()(k, j) * right(j);
      right(k) = sum / qr.matrixQR()(k, k);
    }
    Vector& permuted = correction_;
    for (Index k = 0; k < n_; ++k) permuted(qr.colsPermutation().indices()(k)) = right(k);
    right = permuted;
  }

  static Index rank_of(const Eigen::ColPivHouseholderQR<Matrix>& qr, double tolerance) {
    const Index size = std::min(qr.rows(), qr.cols());
    Index rank = 0;
    while (rank < size && std::abs(qr.matrixQR()(rank, rank)) > tolerance * std::max(qr.maxPivot(), 1e-300)) ++rank;
    return rank;
  }

  /// Applies the k-th Householder reflection of qr (its own inverse) to a vector, without work space.
  template <class Target>
  static void reflect(const Eigen::ColPivHouseholderQR<Matrix>& qr, Index k, Target&& y) {
    const Index n = qr.rows();
    double sum = y(k);
    for (Index i = k + 1; i < n; ++i) sum += qr.matrixQR()(i, k) * y(i);
    sum *= qr.hCoeffs()(k);
    y(k) -= sum;
    for (Index i = k + 1; i < n; ++i) y(i) -= sum * qr.matrixQR()(i, k);
  }

  static constexpr int code_not_finite = 5;                // as in the C ABI
  static constexpr double slow = 0.1;                      // of the correction before: another inverse is needed
  static constexpr double coarser = 1e3, coarsest = 1e-5;  // tolerances of the rank

  ProjectionOptions options_;
  double tolerance_ = options_.rank_tolerance;  // of the rank, in this projection
  Index n_, m_;
  Solver positions_, velocities_;
  Vector psi_, b_;
  Matrix A_, M_;
  Vector h_, defect_, correction_, before_;
};

}  // namespace eom
