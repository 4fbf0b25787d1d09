// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/qr.hpp"

#include <algorithm>

namespace eomgen::linear {
namespace {

using cln::cl_N;

constexpr int deflation_digits = working_digits - 4;
// For a Jordan block of size m, the error decreases by (m - 1)/m per iteration only.
constexpr int most_rounds_each = 1500;

/// v with v0 = 1, and beta, such that (1 - beta v v^T) x is along the first axis.
struct Reflection {
  std::vector<Precise> v;
  Precise beta = 0;
};

Reflection reflection(const std::vector<Precise>& x) {
  Reflection r{x, Precise(0)};
  Precise rest(0);
  for (std::size_t i = 1; i < x.size(); ++i) rest = rest + x[i] * x[i];
  r.v[0] = Precise(1);
  if (is_zero(rest)) return r;
  const Precise norm = cln::sqrt(x[0] * x[0] + rest);
  const Precise first = cln::plusp(x[0]) ? -rest / (x[0] + norm) : x[0] - norm;
  r.beta = Precise(2) * first * first / (rest + first * first);
  for (std::size_t i = 1; i < x.size(); ++i) r.v[i] = x[i] / first;
  return r;
}

/// Rows k, k + 1, ... of the columns from, ..., to - 1.
void reflect_rows(Matrix<Precise>& A, const Reflection& r, std::size_t k, std::size_t from, std::size_t to) {
  if (is_zero(r.beta)) return;
  for (std::size_t j = from; j < to; ++j) {
    Precise sum(0);
    for (std::size_t i = 0; i < r.v.size(); ++i) sum = sum + r.v[i] * A(k + i, j);
    sum = sum * r.beta;
    for (std::size_t i = 0; i < r.v.size(); ++i) A(k + i, j) = A(k + i, j) - sum * r.v[i];
  }
}

void reflect_columns(Matrix<Precise>& A, const Reflection& r, std::size_t k, std::size_t from, std::size_t to) {
  if (is_zero(r.beta)) return;
  for (std::size_t i = from; i < to; ++i) {
    Precise sum(0);
    for (std::size_t j = 0; j < r.v.size(); ++j) sum = sum + A(i, k + j) * r.v[j];
    sum = sum * r.beta;
    for (std::size_t j = 0; j < r.v.size(); ++j) A(i, k + j) = A(i, k + j) - sum * r.v[j];
  }
}

/// A = Q H Q^T.
struct Hessenberg {
  Matrix<Precise> H;
  std::vector<Reflection> steps;  // the k-th acts on rows from k + 1 on

  explicit Hessenberg(Matrix<Precise> A) : H(std::move(A)) {
    const std::size_t n = H.rows;
    for (std::size_t k = 0; k + 2 < n; ++k) {
      std::vector<Precise> x;
      for (std::size_t i = k + 1; i < n; ++i) x.push_back(H(i, k));
      steps.push_back(reflection(x));
      reflect_rows(H, steps.back(), k + 1, k, n);
      reflect_columns(H, steps.back(), k + 1, 0, n);
      for (std::size_t i = k + 2; i < n; ++i) H(i, k) = Precise(0);
    }
  }
  std::vector<cl_N> back(std::vector<cl_N> x) const {  // Q x
    for (std::size_t k = steps.size(); k-- > 0;) {
      const Reflection& r = steps[k];
      cl_N sum = 0;
      for (std::size_t i = 0; i < r.v.size(); ++i) sum = sum + r.v[i] * x[k + 1 + i];
      sum = sum * r.beta;
      for (std::size_t i = 0; i < r.v.size(); ++i) x[k + 1 + i] = x[k + 1 + i] - sum * r.v[i];
    }
    return x;
  }
};

/// Both roots of a 2 x 2 block.
void add_pair(const Precise& a, const Precise& b, const Precise& c, const Precise& d, std::vector<cl_N>& found) {
  const Precise half = (a - d) / Precise(2), square = half * half + b * c, middle = (a + d) / Precise(2);
  if (cln::minusp(square)) {
    const Precise im = cln::sqrt(-square);
    found.push_back(cln::complex(middle, im));
    found.push_back(cln::complex(middle, -im));
    return;
  }
  // The larger root from the sum, the other one from the product, without cancellation.
  const Precise root = cln::sqrt(square);
  const Precise larger = cln::minusp(middle) ? middle - root : middle + root;
  found.push_back(larger);
  found.push_back(is_zero(larger) ? larger : middle == Precise(0) ? -larger : (a * d - b * c) / larger);
}

class Francis {
 public:
  explicit Francis(Matrix<Precise> H)
      : H_(std::move(H)), negligible_(tiny<Precise>(deflation_digits) * infinity_norm(H_)) {}

  /// False if the iteration does not converge.
  bool run(std::vector<cl_N>& found) {
    std::size_t end = H_.rows;  // rows from `end` on are finished
    int round = 0;
    while (end > 0) {
      const std::size_t begin = block(end);
      if (end - begin <= 2) {
        const std::size_t k = end - 1;
        if (end - begin == 1)
          found.push_back(H_(k, k));
        else
          add_pair(H_(k - 1, k - 1), H_(k - 1, k), H_(k, k - 1), H_(k, k), found);
        end = begin;
        round = 0;
        continue;
      }
      if (++round > most_rounds_each) return false;
      sweep(begin, end, round);
    }
    return true;
  }

 private:
  /// The first row of the block that ends there. Negligible subdiagonal entries, relative to the whole matrix, become
  /// 0; the digits suffice for roots that are many orders smaller.
  std::size_t block(std::size_t end) {
    for (std::size_t k = end - 1; k > 0; --k) {
      if (magnitude(H_(k, k - 1)) > negligible_) continue;
      H_(k, k - 1) = Precise(0);
      return k;
    }
    return 0;
  }

  void sweep(std::size_t begin, std::size_t end, int round) {
    const std::size_t l = end - 1;
    Precise sum = H_(l - 1, l - 1) + H_(l, l), product = H_(l - 1, l - 1) * H_(l, l) - H_(l - 1, l) * H_(l, l - 1);
    if (round == 30 || round % 200 == 0) {  // shifts that break a cycle
      const Precise size = magnitude(H_(l, l - 1)) + magnitude(H_(l - 1, l - 2));
      sum = Precise(3) / Precise(2) * size;
      product = size * size;
    }
    const Precise &a = H_(begin, begin), &b = H_(begin, begin + 1), &c = H_(begin + 1, begin),
                  &d = H_(begin + 1, begin + 1);
    std::vector<Precise> x{a * (a - sum) + product + b * c, c * (a + d - sum), c * H_(begin + 2, begin + 1)};
    for (std::size_t k = begin; k + 1 < end; ++k) {
      if (k > begin) {
        x = {H_(k, k - 1), H_(k + 1, k - 1)};
        if (k + 2 < end) x.push_back(H_(k + 2, k - 1));
      }
      const Reflection r = reflection(x);
      // Rows and columns of the block alone: entries outside do not change its roots.
      reflect_rows(H_, r, k, k > begin ? k - 1 : begin, end);
      reflect_columns(H_, r, k, begin, std::min(end, k + 4));
      for (std::size_t i = 1; k > begin && i < x.size(); ++i) H_(k + i, k - 1) = Precise(0);
    }
  }

  Matrix<Precise> H_;
  Precise negligible_;
};

Precise norm_squared(const cl_N& x) {
  const Precise re = cln::realpart(x), im = cln::imagpart(x);
  return re * re + im * im;
}

Precise length(const std::vector<cl_N>& x) {
  Precise sum(0);
  for (const cl_N& entry : x) sum = sum + norm_squared(entry);
  return cln::sqrt(sum);
}

void normalise(std::vector<cl_N>& x) {
  const Precise size = length(x);
  for (cl_N& entry : x) entry = entry / size;
}

/// H - value = P L U of a Hessenberg matrix; zero pivots are replaced by negligible ones.
class ShiftedFactorisation {
 public:
  ShiftedFactorisation(const Matrix<Precise>& H, const cl_N& value, const Precise& norm)
      : n_(H.rows), U_(n_ * n_, cl_N(0)), factor_(n_, cl_N(0)), swapped_(n_, false) {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = i == 0 ? 0 : i - 1; j < n_; ++j) at(i, j) = H(i, j);
      at(i, i) = at(i, i) - value;
    }
    const Precise least = tiny<Precise>(working_digits) * norm;
    for (std::size_t k = 0; k < n_; ++k) {
      if (k + 1 < n_ && norm_squared(at(k + 1, k)) > norm_squared(at(k, k))) {
        swapped_[k] = true;
        for (std::size_t j = k; j < n_; ++j) std::swap(at(k, j), at(k + 1, j));
      }
      if (norm_squared(at(k, k)) < least * least) at(k, k) = least;
      if (k + 1 == n_ || cln::zerop(at(k + 1, k))) continue;
      factor_[k] = at(k + 1, k) / at(k, k);
      for (std::size_t j = k; j < n_; ++j) at(k + 1, j) = at(k + 1, j) - factor_[k] * at(k, j);
    }
  }

  void solve(std::vector<cl_N>& x) const {
    for (std::size_t k = 0; k + 1 < n_; ++k) {
      if (swapped_[k]) std::swap(x[k], x[k + 1]);
      x[k + 1] = x[k + 1] - factor_[k] * x[k];
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t j = i + 1; j < n_; ++j) x[i] = x[i] - at(i, j) * x[j];
      x[i] = x[i] / at(i, i);
    }
  }
  void solve_transposed(std::vector<cl_N>& x) const {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < i; ++j) x[i] = x[i] - at(j, i) * x[j];
      x[i] = x[i] / at(i, i);
    }
    for (std::size_t k = n_ - 1; k-- > 0;) {
      x[k] = x[k] - factor_[k] * x[k + 1];
      if (swapped_[k]) std::swap(x[k], x[k + 1]);
    }
  }

 private:
  cl_N& at(std::size_t i, std::size_t j) { return U_[i * n_ + j]; }
  const cl_N& at(std::size_t i, std::size_t j) const { return U_[i * n_ + j]; }
  std::size_t n_;
  std::vector<cl_N> U_, factor_;
  std::vector<bool> swapped_;
};

/// The residual is taken on A itself, which also checks the Hessenberg form.
Root assess_root(const Matrix<Precise>& A, const Hessenberg& form, const cl_N& value, const Precise& norm) {
  const std::size_t n = A.rows;
  const ShiftedFactorisation shifted(form.H, value, norm);
  std::vector<cl_N> right(n), left(n);
  for (std::size_t i = 0; i < n; ++i) {  // generic: almost surely not perpendicular to an eigenvector
    right[i] = number<Precise>(Precise(1) + Precise(static_cast<unsigned long>(7 * i % 11)) / 13);
    left[i] = number<Precise>(Precise(1) + Precise(static_cast<unsigned long>(5 * i % 13)) / 17);
  }
  for (int k = 0; k < 2; ++k) {
    shifted.solve(right);
    shifted.solve_transposed(left);
    normalise(right);
    normalise(left);
  }
  cl_N overlap = 0;  // `left` is from the transpose: no conjugate
  for (std::size_t i = 0; i < n; ++i) overlap = overlap + left[i] * right[i];
  const std::vector<cl_N> x = form.back(right);
  std::vector<cl_N> rest(n);
  for (std::size_t i = 0; i < n; ++i) {
    cl_N sum = -value * x[i];
    for (std::size_t j = 0; j < n; ++j) {
      if (!is_zero(A(i, j))) sum = sum + A(i, j) * x[j];
    }
    rest[i] = sum;
  }
  return {value, length(rest), cln::sqrt(norm_squared(overlap))};
}

}  // namespace

Precise infinity_norm(const Matrix<Precise>& A) {
  Precise largest(0);
  for (std::size_t i = 0; i < A.rows; ++i) {
    Precise sum(0);
    for (std::size_t j = 0; j < A.cols; ++j) sum = sum + magnitude(A(i, j));
    largest = std::max(largest, sum);
  }
  return largest;
}

Matrix<Precise> balance(Matrix<Precise> A) {
  constexpr int most_rounds = 40;
  const std::size_t n = A.rows;
  bool changed = true;
  for (int round = 0; changed && round < most_rounds; ++round) {
    changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      Precise row(0), column(0);
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        row = row + magnitude(A(i, j));
        column = column + magnitude(A(j, i));
      }
      if (is_zero(row) || is_zero(column)) continue;
      // Scaling by 2^k makes column and row norms similar.
      const int k = static_cast<int>(std::lround(to_double(cln::ln(row / column)) / (2 * std::log(2.0))));
      if (k == 0) continue;
      const Precise factor = cln::expt(Precise(2), k);
      if (!(column * factor + row / factor < Precise(95) / 100 * (row + column))) continue;
      changed = true;
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i) continue;
        A(j, i) = A(j, i) * factor;
        A(i, j) = A(i, j) / factor;
      }
    }
  }
  return A;
}

Roots roots(const Matrix<Precise>& A) {
  Roots result;
  if (A.rows == 0) return result;
  const Hessenberg form(A);
  std::vector<cl_N> found;
  result.complete = Francis(form.H).run(found);
  const Precise norm = infinity_norm(A);
  for (const cl_N& value : found) {
    const Precise im = cln::imagpart(value);
    if (cln::minusp(im)) {  // the conjugate of the previous one
      result.list.push_back({value, result.list.back().residual, result.list.back().condition});
      continue;
    }
    result.list.push_back(assess_root(A, form, value, norm));
  }
  return result;
}

}  // namespace eomgen::linear
