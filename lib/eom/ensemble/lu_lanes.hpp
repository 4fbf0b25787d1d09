// SPDX-License-Identifier: MIT
// Small dense linear systems of members side by side: LU with partial pivoting, each lane with its own pivots and
// bitwise equal to linalg/lu.hpp. In: rows of lanes, entry (i, j) of all lanes in row i + n j. Out: solutions.
// Allocates nothing.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "eom/ensemble/pack.hpp"

namespace eom::ensemble {

template <std::size_t width>
class LuLanes {
 public:
  /// matrix: n * n rows, pivots: n rows, stride apart.
  LuLanes(std::size_t n, std::size_t stride, double* matrix, double* pivots)
      : n_(n), stride_(stride), a_(matrix), pivots_(pivots) {}

  double* entry(std::size_t i, std::size_t j) const { return a_ + (i + n_ * j) * stride_; }

  /// Factors a pack of lanes from l on. Lanes with a singular or not finite matrix get 0 at `regular`.
  void factor(std::size_t l, double* regular) {
    const Pack zero{};
    Pack fine = zero + 1.0;
    for (std::size_t k = 0; k < n_; ++k) {
      choose_pivots(l, k);
      const Pack pivot = load(entry(k, k) + l), size = size_of(pivot);
      fine = size > zero ? fine : zero;
      fine = size - size == zero ? fine : zero;
      for (std::size_t i = k + 1; i < n_; ++i) store(entry(i, k) + l, load(entry(i, k) + l) / pivot);
      for (std::size_t j = k + 1; j < n_; ++j) {
        const Pack factor = load(entry(k, j) + l);
        for (std::size_t i = k + 1; i < n_; ++i) {
          const Pack a = load(entry(i, j) + l);
          store(entry(i, j) + l, factor == zero ? a : a - load(entry(i, k) + l) * factor);
        }
      }
    }
    store(regular + l, fine);
  }

  /// b: n rows; replaced by the solution.
  void solve(std::size_t l, double* b) const {
    for (std::size_t k = 0; k < n_; ++k) {
      for (std::size_t lane = l; lane < l + width; ++lane)
        std::swap(b[k * stride_ + lane], b[pivot(k, lane) * stride_ + lane]);
    }
    const auto subtract = [&](std::size_t i, std::size_t k) {
      double* const at = b + i * stride_ + l;
      store(at, load(at) - load(entry(i, k) + l) * load(b + k * stride_ + l));
    };
    for (std::size_t k = 0; k < n_; ++k)
      for (std::size_t i = k + 1; i < n_; ++i) subtract(i, k);
    for (std::size_t k = n_; k-- > 0;) {
      double* const at = b + k * stride_ + l;
      store(at, load(at) / load(entry(k, k) + l));
      for (std::size_t i = 0; i < k; ++i) subtract(i, k);
    }
  }

 private:
  std::size_t pivot(std::size_t k, std::size_t lane) const {
    return static_cast<std::size_t>(pivots_[k * stride_ + lane]);
  }

  /// Moves the largest remaining entry of column k to row k.
  void choose_pivots(std::size_t l, std::size_t k) {
    Pack place = Pack{} + static_cast<double>(k), largest = size_of(load(entry(k, k) + l));
    for (std::size_t i = k + 1; i < n_; ++i) {
      const Pack size = size_of(load(entry(i, k) + l));
      place = size > largest ? Pack{} + static_cast<double>(i) : place;
      largest = size > largest ? size : largest;
    }
    store(pivots_ + k * stride_ + l, place);
    for (std::size_t lane = l; lane < l + width; ++lane) {
      const std::size_t p = pivot(k, lane);
      if (p == k) continue;
      for (std::size_t j = 0; j < n_; ++j) std::swap(entry(k, j)[lane], entry(p, j)[lane]);
    }
  }

  std::size_t n_, stride_;
  double *a_, *pivots_;
};

}  // namespace eom::ensemble
