// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/degenerate.hpp"

#include <cln/float.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "numeric/numbers.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::mechanics {

using symbolic::Ref;
using symbolic::Symbol;

namespace {

enum class Convergence { none, regular, multiple };

// At a root of multiplicity k, a Newton step reduces psi by the factor (1 - 1/k)^k: 1/4 for a square, 1/e at most.
// Convergence to a simple root is quadratic.
constexpr double least_left = 0.2, most_left = 0.4;
constexpr int in_a_row = 12, most_steps = 40;

/// Newton's method in many digits, along the gradient.
class NewtonPath {
 public:
  NewtonPath(const symbolic::Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& of,
             const std::map<Symbol, double>& from, std::uint64_t point)
      : dag_(dag), roots_(roots), of_(of), point_(point) {
    for (const auto& [symbol, value] : from) q_.emplace(symbol, cln::cl_float(numeric::exact(value), format_));
  }

  /// Whether the path ends at a root of which both psi and the gradient vanish. At a root of multiplicity k the steps
  /// shrink by the factor 1 - 1/k, and k times the step converges quadratically. Values that shrink with steps of one
  /// length, as those of exp far from a root, indicate none.
  bool ends_at_multiple_root() {
    evaluate();
    const cln::cl_F least = scaled(size_, tiny), least_gradient = scaled(gradient_, small);
    for (int trial = 0; trial < most_trials; ++trial) {
      if (size_ <= least && gradient_ <= least_gradient) return true;
      if (cln::zerop(size_) || cln::zerop(gradient_)) return cln::zerop(size_) && gradient_ <= least_gradient;
      const std::map<Symbol, cln::cl_F> before = q_;
      const cln::cl_F step = move(cln::cl_float(1, format_));
      evaluate();
      if (cln::zerop(size_) || cln::zerop(gradient_)) return cln::zerop(size_) && gradient_ <= least_gradient;
      const cln::cl_F shrinks = size_ / gradient_ / step;
      if (!(shrinks < most_shrinking)) return false;
      q_ = before;
      evaluate();
      move(cln::recip(cln::cl_float(1, format_) - shrinks));
      evaluate();
    }
    return false;
  }

 private:
  static constexpr int digits = 60, most_trials = 12;
  static constexpr double tiny = 1e-40, small = 1e-10;
  static constexpr double most_shrinking = 0.995;  // multiplicity 200

  cln::cl_F scaled(const cln::cl_F& x, double factor) const {
    return x * cln::cl_float(numeric::exact(factor), format_);
  }

  /// |psi|, and the length of its gradient.
  void evaluate() {
    values_.clear();
    const auto at = [&](const Symbol& symbol) -> cln::cl_R {
      const auto found = q_.find(symbol);
      return found == q_.end() ? cln::cl_R(symbolic::sample(symbol, point_)) : cln::cl_R(found->second);
    };
    for (const cln::cl_R& value : symbolic::evaluate(dag_, roots_, at, digits))
      values_.push_back(cln::cl_float(value, format_));
    cln::cl_F square = cln::cl_float(0, format_);
    for (std::size_t i = 1; i < values_.size(); ++i) square = square + values_[i] * values_[i];
    size_ = cln::abs(values_[0]);
    gradient_ = cln::sqrt(square);
  }

  /// Moves by a multiple of Newton's step; returns the length of the step itself.
  cln::cl_F move(const cln::cl_F& factor) {
    const cln::cl_F scale = values_[0] / (gradient_ * gradient_);
    for (std::size_t i = 0; i < of_.size(); ++i) {
      cln::cl_F& q = q_.at(of_[i]);
      q = q - factor * scale * values_[i + 1];
    }
    return size_ / gradient_;
  }

  const symbolic::Dag& dag_;
  const std::vector<Ref>& roots_;  // psi and its gradient
  const std::vector<Symbol>& of_;
  std::uint64_t point_;
  cln::float_format_t format_ = cln::float_format(digits);
  std::map<Symbol, cln::cl_F> q_;
  std::vector<cln::cl_F> values_;
  cln::cl_F size_ = cln::cl_float(0, format_), gradient_ = size_;
};

Convergence convergence(const symbolic::Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& of,
                        std::uint64_t point) try {
  std::map<Symbol, double> q;
  for (const Symbol& symbol : of) q[symbol] = symbolic::sample_double(symbol, point);
  const std::function<double(const Symbol&)> at = [&](const Symbol& symbol) {
    const auto found = q.find(symbol);
    return found == q.end() ? symbolic::sample_double(symbol, point) : found->second;
  };
  double before = 0, first = 0;
  int row = 0;
  for (int step = 0; step < most_steps; ++step) {
    const std::vector<double> value = symbolic::evaluate(dag, roots, at);
    double square = 0;
    for (std::size_t i = 0; i < of.size(); ++i) square += value[i + 1] * value[i + 1];
    const double size = std::fabs(value[0]);
    if (!std::isfinite(size) || !std::isfinite(square)) return Convergence::none;
    if (step == 0) first = size;
    const double left = size / before;
    row = step > 0 && left > least_left && left < most_left ? row + 1 : 0;
    if (row >= in_a_row) {
      const bool multiple = NewtonPath(dag, roots, of, q, point).ends_at_multiple_root();
      return multiple ? Convergence::multiple : Convergence::none;
    }
    if (size <= 1e-12 * first) return Convergence::regular;
    if (square == 0) return Convergence::none;
    for (std::size_t i = 0; i < of.size(); ++i) q[of[i]] -= value[0] * value[i + 1] / square;
    before = size;
  }
  return Convergence::none;
} catch (const std::domain_error&) {  // a function has no value on the way
  return Convergence::none;
}

}  // namespace

bool is_degenerate(const symbolic::Dag& dag, Ref psi, const std::vector<Symbol>& of, const std::vector<Ref>& gradient) {
  std::vector<Ref> roots{psi};
  roots.insert(roots.end(), gradient.begin(), gradient.end());
  bool multiple = false;
  for (std::uint64_t point = 1; point <= 4; ++point) {
    const Convergence found = convergence(dag, roots, of, point);
    if (found == Convergence::regular) return false;
    multiple = multiple || found == Convergence::multiple;
  }
  return multiple;
}

}  // namespace eomgen::mechanics
