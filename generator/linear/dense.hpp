// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense matrices over binary64 or many digits, and their elimination with a rank.
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "linear/numbers.hpp"

namespace eomgen::linear {

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

/// B below A.
template <class T>
Matrix<T> stacked(Matrix<T> A, const Matrix<T>& B) {
  if (A.cols == 0) A.cols = B.cols;
  A.a.insert(A.a.end(), B.a.begin(), B.a.end());
  A.rows += B.rows;
  return A;
}

/// Gaussian elimination with complete pivoting, rows and then columns scaled to a largest entry of 1.
template <class T>
class Elimination {
 public:
  /// Pivots up to `cutoff` count as 0; so do rows up to `floor` of the largest row, and columns of scaled rows up to
  /// `floor`.
  Elimination(Matrix<T> A, const T& cutoff, const T& floor = T(0))
      : a_(std::move(A)), row_(a_.rows), col_(a_.cols), floor_(floor) {
    std::iota(row_.begin(), row_.end(), std::size_t{0});
    std::iota(col_.begin(), col_.end(), std::size_t{0});
    scale();
    reduce(cutoff);
  }
  /// The same of a matrix that is scaled already.
  struct AsItIs {};
  Elimination(Matrix<T> A, const T& cutoff, AsItIs) : a_(std::move(A)), row_(a_.rows), col_(a_.cols), floor_(0) {
    std::iota(row_.begin(), row_.end(), std::size_t{0});
    std::iota(col_.begin(), col_.end(), std::size_t{0});
    row_scale_.assign(a_.rows, T(1));
    column_scale_.assign(a_.cols, T(1));
    reduce(cutoff);
  }

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
      for (std::size_t i = 0; i < rank_; ++i) {
        y[i] = B(row_[i], c) * row_scale_[row_[i]];
        for (std::size_t k = 0; k < i; ++k) y[i] = y[i] - at(i, k) * y[k];
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
  T& at(std::size_t i, std::size_t j) { return a_(row_[i], col_[j]); }
  const T& at(std::size_t i, std::size_t j) const { return a_(row_[i], col_[j]); }

  void scale() {
    row_scale_.assign(a_.rows, T(1));
    column_scale_.assign(a_.cols, T(1));
    std::vector<T> size(a_.rows, T(0));
    T whole(0);
    for (std::size_t i = 0; i < a_.rows; ++i) {
      for (std::size_t j = 0; j < a_.cols; ++j) size[i] = std::max(size[i], magnitude(a_(i, j)));
      whole = std::max(whole, size[i]);
    }
    for (std::size_t i = 0; i < a_.rows; ++i) {
      const bool nothing = !(size[i] > floor_ * whole);
      row_scale_[i] = nothing ? T(0) : T(1) / size[i];
      for (std::size_t j = 0; j < a_.cols; ++j) a_(i, j) = a_(i, j) * row_scale_[i];
    }
    for (std::size_t j = 0; j < a_.cols; ++j) {
      T largest(0);
      for (std::size_t i = 0; i < a_.rows; ++i) largest = std::max(largest, magnitude(a_(i, j)));
      if (is_zero(largest)) continue;
      const T factor = largest > floor_ ? T(1) / largest : T(0);
      for (std::size_t i = 0; i < a_.rows; ++i) a_(i, j) = a_(i, j) * factor;
      if (!is_zero(factor)) column_scale_[j] = factor;
    }
  }

  void reduce(const T& cutoff) {
    while (rank_ < std::min(a_.rows, a_.cols) && eliminate(cutoff)) ++rank_;
  }

  bool eliminate(const T& cutoff) {
    const std::size_t k = rank_;
    std::size_t pi = k, pj = k;
    T largest(0);
    for (std::size_t i = k; i < a_.rows; ++i) {
      for (std::size_t j = k; j < a_.cols; ++j) {
        if (!(magnitude(at(i, j)) > largest)) continue;
        largest = magnitude(at(i, j));
        pi = i, pj = j;
      }
    }
    if (!(largest > cutoff)) return false;
    std::swap(row_[k], row_[pi]);
    std::swap(col_[k], col_[pj]);
    for (std::size_t i = k + 1; i < a_.rows; ++i) {
      if (is_zero(at(i, k))) continue;
      const T factor = at(i, k) / at(k, k);
      at(i, k) = factor;
      for (std::size_t j = k + 1; j < a_.cols; ++j) at(i, j) = at(i, j) - factor * at(k, j);
    }
    return true;
  }

  void back(std::vector<T>& y) const {
    for (std::size_t i = rank_; i-- > 0;) {
      for (std::size_t k = i + 1; k < rank_; ++k) y[i] = y[i] - at(i, k) * y[k];
      y[i] = y[i] / at(i, i);
    }
  }

  Matrix<T> a_;
  std::vector<std::size_t> row_, col_;
  std::vector<T> row_scale_, column_scale_;
  T floor_;
  std::size_t rank_ = 0;
};

}  // namespace eomgen::linear
