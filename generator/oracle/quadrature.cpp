// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/quadrature.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <cmath>
#include <numbers>

namespace eomgen::verify {
namespace {

class Panels {
 public:
  Panels(const std::function<Real(const Real&)>& f, const std::vector<Real>& node, const std::vector<Real>& weight,
         const Real& small)
      : f_(f), node_(node), weight_(weight), small_(small) {}

  Real over(const Real& a, const Real& b) {
    const auto [whole, size] = panel(a, b);
    tolerance_ = small_ * size;
    return refined(a, b, whole, 0);
  }

 private:
  std::pair<Real, Real> panel(const Real& a, const Real& b) {
    if (++panels_ > most_panels) throw Singular("an integral over time that does not converge");
    const Real half = (b - a) / 2, middle = (a + b) / 2;
    Real sum = 0, size = 0;
    for (std::size_t i = 0; i < node_.size(); ++i) {
      const Real term = weight_[i] * f_(middle + half * node_[i]);
      sum = sum + term;
      size = size + cln::abs(term);
    }
    return {half * sum, cln::abs(half) * size};
  }
  Real refined(const Real& a, const Real& b, const Real& whole, int depth) {
    if (depth > deepest) throw Singular("an integral over time that does not converge");
    const Real middle = (a + b) / 2;
    const Real left = panel(a, middle).first, right = panel(middle, b).first;
    if (cln::abs(left + right - whole) <= tolerance_) return left + right;
    return refined(a, middle, left, depth + 1) + refined(middle, b, right, depth + 1);
  }

  static constexpr int most_panels = 4000, deepest = 1200;  // a kink takes about 4 halvings per digit
  const std::function<Real(const Real&)>& f_;
  const std::vector<Real>& node_;
  const std::vector<Real>& weight_;
  const Real& small_;
  Real tolerance_ = 0;
  int panels_ = 0;
};

}  // namespace

// Nodes: roots of the Legendre polynomial by Newton's method, (n + 1) P_(n+1) = (2 n + 1) x P_n - n P_(n-1). With n
// nodes an analytic integrand has n digits and more on a panel that is short relative to its features.
GaussLegendre::GaussLegendre(int digits, const Precision& precision)
    : precision_(precision), small_(cln::expt(cln::cl_RA(1) / 10, cln::cl_I(digits))) {
  const int n = digits / 2 + 10;
  for (int i = 1; i <= n; ++i) {
    Real x = precision.round(cln::cl_R(std::cos(std::numbers::pi * (i - 0.25) / (n + 0.5))));
    Real slope = 0;
    for (int step = 0; step < 12; ++step) {  // quadratic from 3 digits on: 1000 digits are reached in 9
      Real before = precision.round(Real(1)), now = x;
      for (int k = 1; k < n; ++k) {
        const Real next = ((2 * k + 1) * x * now - k * before) / (k + 1);
        before = now;
        now = next;
      }
      slope = n * (x * now - before) / (x * x - 1);
      const Real change = now / slope;
      x = x - change;
      if (cln::abs(change) < cln::float_epsilon(precision.format)) break;
    }
    node_.push_back(x);
    weight_.push_back(2 / ((1 - x * x) * slope * slope));
  }
}

Real GaussLegendre::operator()(const std::function<Real(const Real&)>& f, const Real& a, const Real& b) const {
  const Real first = precision_.round(a), last = precision_.round(b);
  if (first == last) return 0;
  return Panels(f, node_, weight_, small_).over(first, last);
}

}  // namespace eomgen::verify
