// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/factorisation.hpp"

#include <utility>

namespace eomgen::symbolic {

Factorisation::Factorisation(Dag& dag, std::vector<Ref> matrix, std::size_t n, Ties ties)
    : dag_(dag), n_(n), w_(std::move(matrix)) {
  std::vector<bool> done(n, false);
  std::vector<Ref> diagonal(n);
  std::vector<std::size_t> degrees(n);
  for (std::size_t i = 0; i < n; ++i) diagonal[i] = w_[i * n + i];
  for (std::size_t i = 0; i < n; ++i) degrees[i] = degree(done, i);
  for (std::size_t step = 0; step < n; ++step) {
    // Minimum degree: the elimination of this row affects the fewest other rows, which limits fill-in.
    std::size_t k = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (!done[i] && (k == n || degrees[i] < degrees[k] || (degrees[i] == degrees[k] && ties == Ties::descending)))
        k = i;
    }
    done[k] = true;
    order_.push_back(k);
    const Ref pivot = w_[k * n + k];
    d_.push_back(pivot);
    const bool untouched = pivot == diagonal[k];
    pivots_.push_back({pivot, untouched ? dag.zero() : diagonal[k]});
    for (std::size_t i = 0; i < n; ++i) {
      if (done[i] || dag.is_zero(w_[i * n + k])) continue;
      const Ref l = dag.div(w_[i * n + k], pivot);
      for (std::size_t j = 0; j <= i; ++j) {
        if (done[j] || dag.is_zero(w_[j * n + k])) continue;
        w_[i * n + j] = w_[j * n + i] = dag.sub(w_[i * n + j], dag.mul(l, w_[j * n + k]));
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!done[i] && !dag.is_zero(w_[i * n + k])) degrees[i] = degree(done, i);
    }
  }
}

/// The number of remaining rows that are coupled to this row.
std::size_t Factorisation::degree(const std::vector<bool>& done, std::size_t row) const {
  std::size_t count = 0;
  for (std::size_t j = 0; j < n_; ++j) count += !done[j] && j != row && !dag_.is_zero(w_[row * n_ + j]) ? 1 : 0;
  return count;
}

std::vector<Ref> Factorisation::forward(const std::vector<Ref>& r) const {
  std::vector<Ref> z;
  for (std::size_t step = 0; step < n_; ++step) {
    const std::size_t i = order_[step];
    Ref sum = r[i];
    for (std::size_t k = 0; k < step; ++k) {
      const Ref entry = w_[i * n_ + order_[k]];
      if (dag_.is_zero(entry) || dag_.is_zero(z[k])) continue;
      sum = dag_.sub(sum, dag_.mul(dag_.div(entry, d_[k]), z[k]));
    }
    z.push_back(sum);
  }
  return z;
}

std::vector<Ref> Factorisation::backward(const std::vector<Ref>& z) const {
  std::vector<Ref> x(n_, dag_.zero());
  for (std::size_t step = n_; step-- > 0;) {
    Ref sum = z[step];
    for (std::size_t k = step + 1; k < n_; ++k) {
      const Ref entry = w_[order_[k] * n_ + order_[step]];
      sum = dag_.sub(sum, dag_.mul(entry, x[order_[k]]));
    }
    x[order_[step]] = dag_.div(sum, d_[step]);
  }
  return x;
}

Ref Factorisation::inner(const std::vector<Ref>& a, const std::vector<Ref>& b) const {
  Ref sum = dag_.zero();
  for (std::size_t k = 0; k < n_; ++k) sum = dag_.add(sum, dag_.div(dag_.mul(a[k], b[k]), d_[k]));
  return sum;
}

}  // namespace eomgen::symbolic
