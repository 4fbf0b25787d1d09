// SPDX-License-Identifier: GPL-3.0-or-later
// Small dense matrices over any number type.
#pragma once

#include <cstddef>
#include <vector>

#include "numeric/numbers.hpp"

namespace eomgen::numeric {

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

}  // namespace eomgen::numeric
