// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss' elimination of numbers of any kind: in binary64, where many points are tried, in many digits, where something
// is decided, and exactly. The judge has one of its own (verify/linear_solve.hpp); expressions are eliminated by
// symbolic/factorisation.hpp and program/elimination.hpp, whose order of operations becomes code.
#pragma once

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "numeric/matrix.hpp"

namespace eomgen::numeric {

/// Where pivots are looked for: among all entries that are left, or on the diagonal (of matrices that are positive
/// semidefinite).
enum class Pivots { complete, diagonal };

/// A = L U of a matrix of any shape, as far as its rank; zeros cost nothing.
template <class T>
class Elimination {
 public:
  /// Rows and then columns are scaled to a largest entry of 1, pivots are complete. Pivots up to `cutoff` count as 0;
  /// so do rows up to `floor` of the largest row, and columns of scaled rows up to `floor`.
  Elimination(Matrix<T> A, const T& cutoff, const T& floor = T(0)) : Elimination(std::move(A), Pivots::complete) {
    scale(floor);
    reduce(cutoff);
  }
  /// Of the matrix as it is. Diagonal pivots need a square matrix.
  Elimination(Matrix<T> A, const T& cutoff, Pivots pivots) : Elimination(std::move(A), pivots) { reduce(cutoff); }

  std::size_t rank() const { return rank_; }
  /// The last pivot that counts, the first being 1 or so; 1 where there is none.
  T smallest_pivot() const { return rank_ == 0 ? T(1) : magnitude(at(rank_ - 1, rank_ - 1)); }
  /// Columns whose pivots count, in the order of their choice.
  std::vector<std::size_t> pivot_columns() const {
    return {col_.begin(), col_.begin() + static_cast<std::ptrdiff_t>(rank_)};
  }

  /// A X = B with the rows of the pivots; unknowns without a pivot are 0. Other rows hold if the system has a solution.
  Matrix<T> solve(const Matrix<T>& B) const {
    Matrix<T> X(a_.cols, B.cols);
    for (std::size_t c = 0; c < B.cols; ++c) {
      std::vector<T> y(rank_);
      for (std::size_t i = 0; i < rank_; ++i) y[i] = B(row_[i], c) * row_scale_[row_[i]];
      for (std::size_t k = 0; k < rank_; ++k) {
        if (is_zero(y[k])) continue;
        for (std::size_t i = k + 1; i < rank_; ++i) subtract(y[i], at(i, k), y[k]);
      }
      back(y);
      for (std::size_t i = 0; i < rank_; ++i) X(col_[i], c) = y[i] * column_scale_[col_[i]];
    }
    return X;
  }

  /// Columns that span {x: A x = 0}.
  Matrix<T> null_space() const {
    Matrix<T> N(a_.cols, a_.cols - rank_);
    for (std::size_t c = rank_; c < a_.cols; ++c) {
      std::vector<T> y(rank_);
      for (std::size_t i = 0; i < rank_; ++i) y[i] = -at(i, c);
      back(y);
      for (std::size_t i = 0; i < rank_; ++i) N(col_[i], c - rank_) = y[i] * column_scale_[col_[i]];
      N(col_[c], c - rank_) = column_scale_[col_[c]];
    }
    return N;
  }

 private:
  Elimination(Matrix<T> A, Pivots pivots)
      : a_(std::move(A)),
        row_(a_.rows),
        col_(a_.cols),
        row_scale_(a_.rows, T(1)),
        column_scale_(a_.cols, T(1)),
        pivots_(pivots) {
    std::iota(row_.begin(), row_.end(), std::size_t{0});
    std::iota(col_.begin(), col_.end(), std::size_t{0});
  }

  T& at(std::size_t i, std::size_t j) { return a_(row_[i], col_[j]); }
  const T& at(std::size_t i, std::size_t j) const { return a_(row_[i], col_[j]); }

  void scale(const T& floor) {
    std::vector<T> size(a_.rows, T(0));
    T whole(0);
    for (std::size_t i = 0; i < a_.rows; ++i) {
      for (std::size_t j = 0; j < a_.cols; ++j) size[i] = std::max(size[i], magnitude(a_(i, j)));
      whole = std::max(whole, size[i]);
    }
    for (std::size_t i = 0; i < a_.rows; ++i) {
      const bool nothing = !(size[i] > floor * whole);
      row_scale_[i] = nothing ? T(0) : T(1) / size[i];
      for (std::size_t j = 0; j < a_.cols; ++j) a_(i, j) = a_(i, j) * row_scale_[i];
    }
    for (std::size_t j = 0; j < a_.cols; ++j) {
      T largest(0);
      for (std::size_t i = 0; i < a_.rows; ++i) largest = std::max(largest, magnitude(a_(i, j)));
      if (is_zero(largest)) continue;
      const T factor = largest > floor ? T(1) / largest : T(0);
      for (std::size_t i = 0; i < a_.rows; ++i) a_(i, j) = a_(i, j) * factor;
      if (!is_zero(factor)) column_scale_[j] = factor;
    }
  }

  void reduce(const T& cutoff) {
    largest_.assign(a_.rows, T(0));
    for (std::size_t i = 0; pivots_ == Pivots::complete && i < a_.rows; ++i) largest_[row_[i]] = largest_in(i, 0);
    while (rank_ < std::min(a_.rows, a_.cols) && eliminate(cutoff)) ++rank_;
  }

  bool eliminate(const T& cutoff) {
    const std::size_t k = rank_;
    const bool complete = pivots_ == Pivots::complete;
    std::size_t pi = k;
    T largest(0);
    for (std::size_t i = k; i < a_.rows; ++i) {
      const T size = complete ? largest_[row_[i]] : magnitude(at(i, i));
      if (!(size > largest)) continue;
      largest = size;
      pi = i;
    }
    if (!(largest > cutoff)) return false;
    std::size_t pj = complete ? k : pi;
    while (complete && magnitude(at(pi, pj)) < largest) ++pj;
    std::swap(row_[k], row_[pi]);
    std::swap(col_[k], col_[pj]);
    std::vector<std::size_t> filled;
    for (std::size_t j = k + 1; j < a_.cols; ++j) {
      if (!is_zero(at(k, j))) filled.push_back(j);
    }
    for (std::size_t i = k + 1; i < a_.rows; ++i) {
      if (is_zero(at(i, k))) continue;
      const T factor = at(i, k) / at(k, k);
      at(i, k) = factor;
      for (const std::size_t j : filled) at(i, j) = at(i, j) - factor * at(k, j);
      if (complete) largest_[row_[i]] = largest_in(i, k + 1);
    }
    return true;
  }

  /// Of a row, from a column on.
  T largest_in(std::size_t i, std::size_t from) const {
    T largest(0);
    for (std::size_t j = from; j < a_.cols; ++j) {
      if (const T& x = at(i, j); !is_zero(x)) largest = std::max(largest, magnitude(x));
    }
    return largest;
  }

  static void subtract(T& sum, const T& a, const T& b) {
    if (!is_zero(a)) sum = sum - a * b;
  }

  void back(std::vector<T>& y) const {
    for (std::size_t i = rank_; i-- > 0;) {
      if (is_zero(y[i])) continue;
      y[i] = y[i] / at(i, i);
      for (std::size_t k = 0; k < i; ++k) subtract(y[k], at(k, i), y[i]);
    }
  }

  Matrix<T> a_;
  std::vector<std::size_t> row_, col_;
  std::vector<T> row_scale_, column_scale_;
  std::vector<T> largest_;  // of what is left of each row: it changes with the row alone
  Pivots pivots_;
  std::size_t rank_ = 0;
};

extern template class Elimination<double>;
extern template class Elimination<cln::cl_R>;
extern template class Elimination<cln::cl_RA>;

}  // namespace eomgen::numeric
