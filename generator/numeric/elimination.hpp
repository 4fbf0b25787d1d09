// SPDX-License-Identifier: GPL-3.0-or-later
// Gaussian elimination for any number type: binary64 for trials at many points, many digits for decisions, and exact
// rationals. The oracle has its own (oracle/linear_solve.hpp). symbolic/factorisation.hpp and program/elimination.hpp
// eliminate expressions; their order of operations becomes code.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "numeric/numbers.hpp"

namespace eomgen::numeric {

// Small dense matrices over any number type.

/// A rows x cols matrix, row-major.
template <class T>
struct Matrix {
  std::size_t rows = 0, cols = 0;
  std::vector<T> a;

  Matrix() = default;
  Matrix(std::size_t r, std::size_t c) : rows(r), cols(c), a(r * c, T(0)) {}
  T& operator()(std::size_t i, std::size_t j) { return a[i * cols + j]; }
  const T& operator()(std::size_t i, std::size_t j) const { return a[i * cols + j]; }
};

template <class T>
Matrix<T> operator*(const Matrix<T>& A, const Matrix<T>& B) {
  Matrix<T> C(A.rows, B.cols);
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t k = 0; k < A.cols; ++k) {
      if (is_zero(A(i, k))) continue;
      for (std::size_t j = 0; j < B.cols; ++j) C(i, j) = C(i, j) + A(i, k) * B(k, j);
    }
  }
  return C;
}

template <class T>
Matrix<T> transposed(const Matrix<T>& A) {
  Matrix<T> B(A.cols, A.rows);
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.cols; ++j) B(j, i) = A(i, j);
  }
  return B;
}

template <class T>
Matrix<T> rows_of(const Matrix<T>& A, const std::vector<std::size_t>& which) {
  Matrix<T> B(which.size(), A.cols);
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t j = 0; j < A.cols; ++j) B(i, j) = A(which[i], j);
  }
  return B;
}

template <class T>
Matrix<T> columns_of(const Matrix<T>& A, const std::vector<std::size_t>& which) {
  Matrix<T> B(A.rows, which.size());
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < which.size(); ++j) B(i, j) = A(i, which[j]);
  }
  return B;
}

/// A with the rows of B appended.
template <class T>
Matrix<T> stacked(Matrix<T> A, const Matrix<T>& B) {
  if (A.cols == 0) A.cols = B.cols;
  A.a.insert(A.a.end(), B.a.begin(), B.a.end());
  A.rows += B.rows;
  return A;
}

/// The pivot search: over all remaining entries, or on the diagonal (for positive semidefinite matrices).
enum class Pivoting { complete, diagonal };

/// A = L U of a matrix of any shape, up to its rank. Zero entries are skipped.
template <class T>
class Elimination {
 public:
  /// With complete pivoting, after scaling first the rows and then the columns to a largest entry of 1. Values up to
  /// `cutoff` are not accepted as pivots. Rows up to `floor` times the largest row count as 0, and so do columns up to
  /// `floor` after the rows are scaled.
  Elimination(Matrix<T> A, const T& cutoff, const T& floor = T(0)) : Elimination(std::move(A), Pivoting::complete) {
    scale(floor);
    reduce(cutoff);
  }
  /// Without scaling. Diagonal pivoting requires a square matrix.
  Elimination(Matrix<T> A, const T& cutoff, Pivoting pivots) : Elimination(std::move(A), pivots) { reduce(cutoff); }

  std::size_t rank() const { return rank_; }
  /// The last accepted pivot, relative to a first one of about 1; 1 if there is none.
  T smallest_pivot() const { return rank_ == 0 ? T(1) : magnitude(at(rank_ - 1, rank_ - 1)); }
  /// Columns of the accepted pivots, in the order of elimination.
  std::vector<std::size_t> pivot_columns() const {
    return {col_.begin(), col_.begin() + static_cast<std::ptrdiff_t>(rank_)};
  }

  /// Solves the pivot rows of A X = B; unknowns without a pivot are 0. The other rows hold if the system is consistent.
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

  /// A matrix whose columns span {x: A x = 0}.
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
  Elimination(Matrix<T> A, Pivoting pivots)
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
    for (std::size_t i = 0; pivots_ == Pivoting::complete && i < a_.rows; ++i) largest_[row_[i]] = largest_in(i, 0);
    while (rank_ < std::min(a_.rows, a_.cols) && eliminate(cutoff)) ++rank_;
  }

  bool eliminate(const T& cutoff) {
    const std::size_t k = rank_;
    const bool complete = pivots_ == Pivoting::complete;
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

  /// The largest magnitude in row i from column `from` on.
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
  std::vector<T> largest_;  // per row: largest remaining magnitude; only elimination in this row changes it
  Pivoting pivots_;
  std::size_t rank_ = 0;
};

extern template class Elimination<double>;
extern template class Elimination<cln::cl_R>;
extern template class Elimination<cln::cl_RA>;

}  // namespace eomgen::numeric
