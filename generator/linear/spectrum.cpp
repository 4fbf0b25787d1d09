// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/spectrum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <complex>

#include "linear/qr.hpp"
#include "numeric/dense.hpp"

namespace eomgen::linear {
namespace {

// Pivots of scaled rows below these are 0: far above rounding, far below values in models.
constexpr int most_rank_digits = 60, rank_margin = 5;
constexpr int root_digits = 18;               // smaller parts of a root are 0
constexpr double printed = 1e-12;             // accuracy of a printed eigenvalue
constexpr double separable_condition = 1e-6;  // condition above which binary64 separates eigenvalues
constexpr double rounding_factor = 100;       // of binary64's QR, on n eps |A|

Precise smaller(const Precise& x, const Precise& y) { return x < y ? x : y; }
double re(const Root& r) { return to_double(cln::realpart(r.value)); }
double im(const Root& r) { return to_double(cln::imagpart(r.value)); }
Precise size_of(const cln::cl_N& x) { return cln::abs(x); }

/// A float 2: the root of an exact 2 would have few digits.
Matrix<Precise> as_floats(Matrix<Precise> A) {
  for (Precise& x : A.a) {
    if (!is_zero(x)) x = number<Precise>(x);
  }
  return A;
}

/// With columns N of the null space and the unit vectors of the pivots as a basis, A is [0, *; 0, what this returns].
Matrix<Precise> without_null_space(const Matrix<Precise>& A, const Elimination<Precise>& e) {
  std::vector<std::size_t> pivots = e.pivot_columns(), open;
  std::sort(pivots.begin(), pivots.end());
  for (std::size_t j = 0; j < A.cols; ++j) {
    if (!std::binary_search(pivots.begin(), pivots.end(), j)) open.push_back(j);
  }
  const Matrix<Precise> N = e.null_space(), across = Elimination<Precise>(rows_of(N, open), Precise(0))
                                                         .solve(rows_of(columns_of(A, pivots), open));
  Matrix<Precise> rest = columns_of(rows_of(A, pivots), pivots);
  const Matrix<Precise> taken = rows_of(N, pivots) * across;
  for (std::size_t i = 0; i < rest.a.size(); ++i) rest.a[i] = rest.a[i] - taken.a[i];
  return rest;
}

/// Splits off zeros by ranks; the rest has none.
std::size_t split_zeros(Matrix<Precise>& A, int known) {
  const int rank_digits = std::min(most_rank_digits, known - rank_margin),
            floor_digits = std::min(100, known - rank_margin);
  std::size_t zeros = 0;
  while (A.rows > 0) {
    const Precise nothing = tiny<Precise>(known) * infinity_norm(A);
    for (Precise& x : A.a) {
      if (magnitude(x) <= nothing) x = Precise(0);
    }
    const Elimination<Precise> e(A, tiny<Precise>(rank_digits), tiny<Precise>(floor_digits));
    if (e.rank() == A.rows) break;
    zeros += A.rows - e.rank();
    A = without_null_space(A, e);
  }
  return zeros;
}

// Merges roots that a Jordan block spreads into, and equal roots: those closer than their errors. The mean is far more
// accurate than each.
void merge(std::vector<Root>& list, std::vector<Precise>& error, const Precise& norm) {
  const std::size_t n = list.size();
  std::vector<std::size_t> leader(n);
  for (std::size_t i = 0; i < n; ++i) leader[i] = i;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Precise reach = Precise(1000) * std::max(error[i], error[j]);
      if (size_of(list[i].value - list[j].value) > smaller(reach, Precise(1) / 1000 * size_of(list[i].value))) continue;
      const std::size_t from = leader[j], to = leader[i];
      for (std::size_t& l : leader) {
        if (l == from) l = to;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (leader[i] != i) continue;
    cln::cl_N sum = 0;
    int count = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (leader[j] != i) continue;
      sum = sum + list[j].value;
      ++count;
    }
    if (count == 1) continue;
    const cln::cl_N mean = sum / cln::cl_N(count);
    Precise spread(0);
    for (std::size_t j = 0; j < n; ++j) {
      if (leader[j] == i) spread = std::max(spread, size_of(list[j].value - mean));
    }
    for (std::size_t j = 0; j < n; ++j) {
      if (leader[j] != i) continue;
      list[j].value = mean;
      list[j].condition = Precise(0);
      // The error of the mean is of second order in that of each, and at least a rounding.
      const bool wide = spread > tiny<Precise>(10) * size_of(mean);  // then these may be several roots
      error[j] = wide ? spread : spread * spread / norm + tiny<Precise>(known_digits) * norm;
    }
  }
}

using Complex = std::complex<double>;

/// The eigenvalues of the same matrix in binary64, scaled to norm 1.
class Binary64 {
 public:
  Binary64(const Matrix<Precise>& A, const Precise& norm)
      : M_(static_cast<Eigen::Index>(A.rows), static_cast<Eigen::Index>(A.cols)), norm_(norm) {
    for (Eigen::Index i = 0; i < M_.rows(); ++i) {
      for (Eigen::Index j = 0; j < M_.cols(); ++j)
        M_(i, j) = to_double(A(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) / norm);
    }
    const Eigen::VectorXcd found = numeric::eigenvalues(M_);
    free_.assign(found.data(), found.data() + found.size());
    rounding_ = rounding_factor * static_cast<double>(A.rows) * 2.3e-16;
  }

  /// Assigns one of its eigenvalues that no other root has, if it is as close as rounding allows. If rounding allows
  /// any distance, the matrix is singular there to rounding.
  bool confirms(const Root& r) {
    const Complex at = {to_double(cln::realpart(r.value) / norm_), to_double(cln::imagpart(r.value) / norm_)};
    const double condition = to_double(r.condition);
    if (condition < separable_condition) {
      const Eigen::Index n = M_.rows();
      Eigen::MatrixXd shifted(2 * n, 2 * n);  // M - at, as real numbers
      shifted << M_, Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n), M_;
      for (Eigen::Index i = 0; i < n; ++i) {
        shifted(i, i) -= at.real();
        shifted(n + i, n + i) -= at.real();
        shifted(i, n + i) = at.imag();
        shifted(n + i, i) = -at.imag();
      }
      return !(rounding_ * numeric::inverse(shifted).norm() < 1);
    }
    const auto nearest = std::min_element(free_.begin(), free_.end(), [&at](const Complex& a, const Complex& b) {
      return std::abs(a - at) < std::abs(b - at);
    });
    if (nearest == free_.end() || std::abs(*nearest - at) > rounding_ / condition) return false;
    free_.erase(nearest);
    return true;
  }

 private:
  Eigen::MatrixXd M_;
  Precise norm_;
  std::vector<Complex> free_;
  double rounding_ = 0;
};

Eigenvalue rounded(const Root& r, const Precise& error) {
  Eigenvalue value{re(r), im(r), to_double(error), true};
  const double size = to_double(size_of(r.value)),
               nothing = std::max(size * std::pow(10.0, -root_digits), std::min(value.error, size * printed));
  if (std::abs(value.re) <= nothing) value.re = 0;
  if (std::abs(value.im) <= nothing) value.im = 0;
  return value;
}

}  // namespace

bool Eigenvalue::is_reliable() const { return is_in_binary64 && error <= printed * std::hypot(re, im); }
bool Spectrum::is_reliable() const {
  return std::all_of(values.begin(), values.end(), [](const Eigenvalue& e) { return e.is_reliable(); });
}

std::size_t zero_eigenvalues(const Matrix<Precise>& A, int known) {
  Matrix<Precise> rest = as_floats(A);
  return split_zeros(rest, known);
}

Spectrum spectrum(const Matrix<Precise>& A, int known) {
  Spectrum result;
  Matrix<Precise> rest = as_floats(A);
  result.zeros = split_zeros(rest, known);
  rest = balance(std::move(rest));
  const Precise norm = infinity_norm(rest);
  Roots found = roots(rest);
  require_domain(found.complete, "the iteration for its eigenvalues does not end");
  std::vector<Precise> error;
  for (const Root& r : found.list) {
    const Precise backward = r.residual + tiny<Precise>(known) * norm;
    error.push_back(is_zero(r.condition) ? norm : smaller(norm, backward / r.condition));
  }
  if (!found.list.empty()) {
    Binary64 other(rest, norm);
    merge(found.list, error, norm);
    for (std::size_t i = 0; i < found.list.size(); ++i) {
      result.values.push_back(rounded(found.list[i], error[i]));
      result.values.back().is_in_binary64 = other.confirms(found.list[i]);
    }
  }
  result.values.resize(result.values.size() + result.zeros);
  std::stable_sort(result.values.begin(), result.values.end(),
                   [](const Eigenvalue& a, const Eigenvalue& b) { return a.re != b.re ? a.re > b.re : a.im > b.im; });
  return result;
}

}  // namespace eomgen::linear
