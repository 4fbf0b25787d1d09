// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives as limits. Along a ray from z the formula is smooth, in whatever form it is written. If the derivatives
// converge to the same values along every ray, the function has these derivatives at z.
#include <algorithm>

#include "linear/chart.hpp"

namespace eomgen::linear {
namespace {

constexpr double min_slope_difference = 1e-5;  // least relative difference of derivatives across a kink
constexpr int rays = 2;                        // and their opposites

template <class T>
State<T> moved(const State<T>& z, const T& step, std::uint64_t ray) {
  State<T> result = z;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {  // t is fixed
    const T direction = number<T>(Precise(0.3 + 0.7 * random_number(40 + ray, i)));
    result[i] = result[i] + step * direction * (T(1) + magnitude(z[i]));
  }
  return result;
}

/// The largest difference of values and derivatives, relative to 1 and their magnitude: a step has equal derivatives on
/// both sides.
template <class T>
T difference(const ValueAndJacobian<T>& a, const ValueAndJacobian<T>& b) {
  T largest(0);
  const auto compare = [&largest](const std::vector<T>& x, const std::vector<T>& y) {
    for (std::size_t i = 0; i < x.size(); ++i)
      largest = std::max(largest, magnitude(x[i] - y[i]) / (T(1) + magnitude(x[i]) + magnitude(y[i])));
  };
  compare(a.value, b.value);
  compare(a.jacobian.a, b.jacobian.a);
  return largest;
}

template <class T>
void accumulate(ValueAndJacobian<T>& sum, const ValueAndJacobian<T>& x, const T& factor) {
  if (sum.value.empty()) sum = {std::vector<T>(x.value.size(), T(0)), Matrix<T>(x.jacobian.rows, x.jacobian.cols)};
  for (std::size_t i = 0; i < x.value.size(); ++i) sum.value[i] = sum.value[i] + factor * x.value[i];
  for (std::size_t i = 0; i < x.jacobian.a.size(); ++i)
    sum.jacobian.a[i] = sum.jacobian.a[i] + factor * x.jacobian.a[i];
}

using Steps = std::vector<std::pair<double, double>>;  // multiples of a step and their weights

template <class T>
using At = std::function<ValueAndJacobian<T>(const State<T>&)>;

/// The mean over all rays, and their deviation. `step` must be small enough not to cross a kink that does not contain
/// z.
template <class T>
std::pair<ValueAndJacobian<T>, T> over_rays(const At<T>& at, const State<T>& z, const T& step, const Steps& steps) {
  std::vector<ValueAndJacobian<T>> ends;
  for (std::uint64_t ray = 0; ray < rays; ++ray) {
    for (const int sign : {1, -1}) {
      ValueAndJacobian<T> end;
      for (const auto& [multiple, weight] : steps) {
        accumulate(end, at(moved<T>(z, step * number<T>(Precise(sign * multiple)), ray)), number<T>(Precise(weight)));
      }
      ends.push_back(std::move(end));
    }
  }
  T largest(0);
  ValueAndJacobian<T> mean;
  for (const ValueAndJacobian<T>& end : ends) {
    largest = std::max(largest, difference(end, ends.front()));
    accumulate(mean, end, T(1) / T(2 * rays));
  }
  return {std::move(mean), largest};
}

ValueAndJacobian<double> limit(const At<double>& at, const State<double>& z) {
  auto [mean, largest] = over_rays<double>(at, z, 1e-9, {{1, 1}});
  require_domain(largest < min_slope_difference, "");
  return mean;
}

ValueAndJacobian<Precise> limit(const At<Precise>& at, const State<Precise>& z) {
  constexpr int exact = 20;
  require_domain(to_double(over_rays<Precise>(at, z, tiny<Precise>(12), {{1, 1}}).second) < min_slope_difference, "");
  // Extrapolates along each ray from three points: linear and quadratic terms in the step cancel.
  const Precise third = Precise(1) / Precise(3);
  auto [sum, largest] = over_rays<Precise>(at, z, tiny<Precise>(50), {{1, 8}, {2, -6}, {4, 1}});
  require_domain(largest < tiny<Precise>(exact), "");
  for (Precise& x : sum.value) x = x * third;
  for (Precise& x : sum.jacobian.a) {
    x = x * third;
    if (magnitude(x) <= Precise(10) * largest + tiny<Precise>(80)) x = Precise(0);
  }
  return sum;
}

}  // namespace

template <class T>
ValueAndJacobian<T> Flow::value_and_jacobian(const Tape& tape, const State<T>& z, const Setting<T>& setting) const {
  constexpr int sharp = std::is_same_v<T, double> ? 15 : 130;
  std::string why;
  try {
    return tape.at<T>(lookup(z, setting));
  } catch (const std::domain_error& error) {
    why = error.what();
  }
  try {
    ValueAndJacobian<T> found =
        limit([&](const State<T>& beside) { return tape.at<T>(lookup(beside, setting), sharp); }, z);
    try {
      found.value = tape.values<T>(lookup(z, setting));
    } catch (const std::domain_error&) {  // 0/0: the limit
      return found;
    }
    return found;
  } catch (const std::domain_error&) {
    throw std::domain_error(why);
  }
}

template ValueAndJacobian<double> Flow::value_and_jacobian(const Tape&, const State<double>&,
                                                           const Setting<double>&) const;
template ValueAndJacobian<Precise> Flow::value_and_jacobian(const Tape&, const State<Precise>&,
                                                            const Setting<Precise>&) const;

}  // namespace eomgen::linear
