// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/consistent_start.hpp"

#include <cln/dfloat.h>
#include <cln/real.h>

#include <utility>

#include "error.hpp"
#include "lists.hpp"
#include "numeric/elimination.hpp"
#include "program/interpret.hpp"

namespace eomgen::reference {
namespace {

using Number = cln::cl_F;

constexpr int most_iterations = 8;  // two or three double sixteen digits to the precision needed

struct Rows {
  std::vector<Number> psi, A, b;  // A by columns
};

class Start {
 public:
  Start(const program::Function& constraints, std::size_t n, const std::vector<double>& p, int digits)
      : constraints_(constraints),
        n_(n),
        digits_(digits),
        format_(cln::float_format(static_cast<std::uintptr_t>(digits))) {
    for (const double value : p) at_.p.emplace_back(cln::cl_float(numeric::exact(value), format_));
    zero_ = cln::cl_float(0, format_);
  }

  std::vector<Number> moved(const Number& t, std::vector<Number> x) {
    at_.t = t;
    for (int i = 0; i < most_iterations; ++i) {
      const Rows rows = evaluate(x);
      const Number before = largest(rows.psi);
      if (cln::zerop(before)) break;
      move(rows, rows.psi, x, 0);
      const Number after = largest(evaluate(x).psi);
      if (!(after < before)) break;  // only the last digits change
    }
    for (int i = 0; i < 2; ++i) {  // linear: the second step removes the rounding error of the first
      const Rows rows = evaluate(x);
      std::vector<Number> off = rows.b;
      for (std::size_t k = 0; k < off.size(); ++k) {
        for (std::size_t j = 0; j < n_; ++j) off[k] = off[k] + rows.A[j * off.size() + k] * x[n_ + j];
      }
      move(rows, off, x, n_);
    }
    return x;
  }

 private:
  Rows evaluate(const std::vector<Number>& x) {
    at_.x.assign(x.begin(), x.end());
    const auto values = program::interpret(constraints_, at_, digits_).results;
    const auto rounded = [this](const std::vector<cln::cl_R>& list) {
      return mapped(list, [&](const cln::cl_R& value) { return cln::cl_float(value, format_); });
    };
    return {rounded(values[0]), rounded(values[1]), rounded(values[2])};
  }

  Number largest(const std::vector<Number>& list) const {
    Number result = zero_;
    for (const Number& value : list) {
      if (cln::abs(value) > result) result = cln::abs(value);
    }
    return result;
  }

  /// x -= A^T (A A^T)^-1 off, beginning with entry `first`.
  void move(const Rows& rows, const std::vector<Number>& off, std::vector<Number>& x, std::size_t first) const {
    const std::size_t m = off.size();
    numeric::Matrix<cln::cl_R> G(m, m), side(m, 1);
    for (std::size_t k = 0; k < m; ++k) {
      side(k, 0) = off[k];
      for (std::size_t l = 0; l < m; ++l) {
        for (std::size_t j = 0; j < n_; ++j) G(k, l) = G(k, l) + rows.A[j * m + k] * rows.A[j * m + l];
      }
    }
    // Positive definite if the constraints are independent.
    const numeric::Elimination<cln::cl_R> factors(std::move(G), 0, numeric::Pivoting::diagonal);
    if (factors.rank() < m) {
      throw Error("reference", {}, "the constraints depend on one another at the start", "start elsewhere",
                  ErrorKind::numerical);
    }
    const numeric::Matrix<cln::cl_R> force = factors.solve(side);
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t k = 0; k < m; ++k)
        x[first + j] = x[first + j] - rows.A[j * m + k] * cln::cl_float(force(k, 0), format_);
    }
  }

  const program::Function& constraints_;
  std::size_t n_;
  int digits_;
  cln::float_format_t format_;
  program::Arguments<cln::cl_R> at_;
  Number zero_ = cln::cl_float(0, cln::float_format(17));
};

}  // namespace

std::vector<Number> make_consistent(const program::Function& constraints, std::size_t n, const Number& t,
                                    std::vector<Number> x, const std::vector<double>& p, int digits) {
  return Start(constraints, n, p, digits).moved(t, std::move(x));
}

}  // namespace eomgen::reference
