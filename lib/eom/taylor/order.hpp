// SPDX-License-Identifier: MIT
// Control of order and step length of a Taylor series by the size of its terms. In: coefficients, the state, the
// tolerances. Out: the error of a step, the length of the next one, the change of the order. Source: Jorba, Zou, A
// software package for the numerical integration of ODEs by means of high-order Taylor methods, Experimental
// Mathematics 14 (2005).
//
// term(i, k): the coefficient of order k of component i, of which the first `components` count; weight(i): 1 over the
// tolerance of that component.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace eom::taylor {

/// The last terms of a series.
struct SeriesMeasure {
  int order = 0;                // 0: not computed
  double last = 0, before = 0;  // log2 of the last two terms at h = 1, including their effect on the error
};

inline constexpr double aim = 0.5;  // of the tolerance that a step may use

/// Error of a step h: 1 is just allowed.
inline double error_of(const SeriesMeasure& series, double h) {
  const double log2_h = std::log2(std::abs(h));
  return std::exp2(std::max(series.last + series.order * log2_h, series.before + (series.order - 1) * log2_h));
}

/// log2 of the step at which the last terms reach their share of the tolerance.
inline double log2_length(const SeriesMeasure& series) {
  constexpr double log2_aim = -1;
  return -std::max((series.last - log2_aim) / series.order, (series.before - log2_aim) / (series.order - 1));
}
inline double length(const SeriesMeasure& series) {
  return std::min(std::exp2(log2_length(series)), std::numeric_limits<double>::max());
}
inline double after_rejected(const SeriesMeasure& series, double h, double error) {
  return h * std::clamp(std::pow(aim / error, 1.0 / series.order), 0.1, 0.95);
}
inline double after_failed(double h) { return 0.25 * h; }

class OrderControl {
 public:
  OrderControl(std::size_t components, double rtol, double atol, int highest)
      : components_(components), rtol_(rtol), atol_(atol), highest_(highest) {}

  int highest() const { return highest_; }
  int lowest() const { return std::min(lowest_order, highest_); }
  int after(int order, int trend) const { return std::clamp(order + trend, lowest(), highest_); }

  /// The order at which the terms of a series with ratio e^-1.6 reach the tolerance; x(i): the state.
  template <class State>
  int first(const State& x) const {
    double largest = 0;
    for (std::size_t i = 0; i < components_; ++i) largest = std::max(largest, std::abs(x(i)));
    const double tolerance = std::max(rtol_, std::min(1e-2, atol_ / std::max(largest, 1e-3)));
    const int wanted = static_cast<int>(std::ceil(1 - 0.62 * std::log(std::max(tolerance, 1e-18))));
    return std::clamp(wanted, lowest(), highest_);
  }

  /// Weight for a state that changes by about `move` times its rate.
  double weight(double x, double slope, double move) const {
    return 1 / (atol_ + rtol_ * (std::abs(x) + 0.5 * std::abs(slope * move)));
  }

  /// Measures the last terms of a series.
  template <class Term, class Weight>
  void measure(SeriesMeasure& series, const Term& term, const Weight& weight) const {
    series.last = tail + size_of_term(series.order, term, weight);
    series.before = 2 * tail + size_of_term(series.order - 1, term, weight);
  }
  /// The change of the next order; an order p costs about (p + 6)^2.
  template <class Term, class Weight>
  int trend(const SeriesMeasure& series, const Term& term, const Weight& weight) const {
    const int p = series.order;
    if (p < lowest_order + 2) return 1;
    SeriesMeasure lower{p - 2};
    measure(lower, term, weight);
    const double gain = log2_length(series) - log2_length(lower) - 2 * std::log2((p + overhead) / (p - 2 + overhead));
    return gain > 1e-3 ? 1 : gain < -1e-3 ? -1 : 0;
  }

  /// Whether the derivative of the series after h agrees with f1(i), that of the right-hand side. If the right-hand
  /// side jumps, or changes faster than the series resolves (dry friction in a plane near zero slip), neither the
  /// coefficients nor their size show it.
  template <class Term, class Weight, class Slope>
  bool matches_derivative(int order, double h, const Term& term, const Weight& weight, const Slope& f1) const {
    double off = 0, size = 0;
    for (std::size_t i = 0; i < components_; ++i) {
      double slope = order * term(i, order);
      for (int k = order - 1; k > 0; --k) slope = slope * h + k * term(i, k);
      const double difference = (f1(i) - slope) * weight(i), whole = f1(i) * weight(i);
      off += difference * difference;
      size += whole * whole;
    }
    const double count = static_cast<double>(components_);
    return !(std::sqrt(off / count) * std::abs(h) > jump * order && off > smooth * smooth * size);
  }

 private:
  static constexpr int lowest_order = 4;
  // log2 of the remainder in units of the last terms: later terms are smaller by h/radius
  static constexpr double tail = -2.3;
  // times the order, of the tolerance: allowed error of the derivative at the end, over the step
  static constexpr double jump = 4;
  static constexpr double smooth = 1e-9;  // of the derivative: smaller deviations are rounding
  static constexpr double overhead = 6;   // an order p costs (p + overhead)^2, measured

  /// log2 of the root mean square of the terms of order k at h = 1, in units of the tolerance.
  template <class Term, class Weight>
  double size_of_term(int k, const Term& term, const Weight& weight) const {
    double sum = 0;
    for (std::size_t i = 0; i < components_; ++i) {
      const double of = term(i, k), part = of == 0 ? 0 : of * weight(i);
      sum += part * part;
    }
    if (std::isfinite(sum)) return 0.5 * std::log2(sum / static_cast<double>(components_));
    double largest = 0;  // the squares overflow
    for (std::size_t i = 0; i < components_; ++i)
      if (term(i, k) != 0) largest = std::max(largest, std::log2(std::abs(term(i, k))) + std::log2(weight(i)));
    return largest;
  }

  std::size_t components_;
  double rtol_, atol_;
  int highest_;
};

}  // namespace eom::taylor
