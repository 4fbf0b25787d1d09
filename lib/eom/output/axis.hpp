// SPDX-License-Identifier: MIT
// One axis of a plot. In: the range of values, linear or logarithmic. Out: a range with a margin, and ticks at round
// numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace eom::plot {

/// A tick: its position, its label (a number, a power of ten, or their product), and whether it is a minor one.
struct Tick {
  double value;
  std::string label;     // "2.5"; empty for a bare power or a minor tick
  std::string exponent;  // "-6" for 10 to the -6; empty: none
  bool minor = false;
};

/// Whether a value can be drawn. Beyond 1e300 differences of values would overflow.
inline bool is_showable(double value, bool logarithmic) {
  return std::abs(value) <= 1e300 && (!logarithmic || value > 0);
}

/// The range of an axis and its ticks.
struct Axis {
  double low = 0, high = 1;
  bool logarithmic = false;
  double offset = 0;  // omitted from the labels of a linear axis: value = offset + label times 10 to the power
  int power = 0;
  std::string offset_label;
  std::vector<Tick> ticks;

  /// Position of a value: 0 at low, 1 at high.
  double fraction(double value) const {
    if (logarithmic) return std::log(value / low) / std::log(high / low);
    return (value - low) / (high - low);
  }
  /// Whether a value can be drawn on this axis.
  bool shows(double value) const { return is_showable(value, logarithmic); }
};

namespace detail {

inline std::string fixed(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 17);
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", value == 0 ? 0 : decimals, value);
  return text;
}

/// The smallest number 1, 2 or 5 times a power of ten above size.
inline double round_step(double size) {
  const double power = std::pow(10, std::floor(std::log10(size)));
  for (const double multiple : {1.0, 2.0, 5.0})
    if (size <= multiple * power * (1 + 1e-9)) return multiple * power;
  return 10 * power;
}

/// Common parts of all labels are factored out: an offset if the labels differ only in late digits, a power of ten if
/// the labels would be long.
inline void linear_ticks(Axis& axis, int about) {
  const double step = round_step((axis.high - axis.low) / about);
  const double first = std::ceil(axis.low / step - 1e-9);
  const double size = std::max(std::abs(axis.low), std::abs(axis.high));
  if (size > 0.99e5 * step) {
    axis.offset = first * step;
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", static_cast<int>(std::log10(size / step)) + 2, axis.offset);
    axis.offset_label = text;
  }
  const double largest = axis.offset != 0 ? axis.high - axis.offset : size;
  if (largest >= 0.99e5 || step < 0.99e-4) axis.power = static_cast<int>(std::floor(std::log10(largest) + 1e-9));
  const double unit = std::pow(10, axis.power);
  for (double k = 0; (first + k) * step <= axis.high + 1e-9 * step; ++k) {
    const double shown = axis.offset != 0 ? k : first + k;
    axis.ticks.push_back({(first + k) * step, fixed((shown + 0.0) * (step / unit), step / unit), "", false});
  }
}

inline void logarithmic_ticks(Axis& axis, int about) {
  const int first = static_cast<int>(std::floor(std::log10(axis.low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(axis.high) - 1e-9));
  const int every = std::max(1, (last - first + about - 1) / about);
  const bool plain = axis.low > 0.5e-3 && axis.high < 2e4;
  const auto add = [&](double value, Tick tick) {
    if (value >= axis.low * (1 - 1e-9) && value <= axis.high * (1 + 1e-9)) axis.ticks.push_back(std::move(tick));
  };
  for (int k = first; k <= last; ++k) {
    const double power = std::pow(10, k);
    const bool labelled = (k - first) % every == 0;
    Tick tick = plain ? Tick{power, fixed(power, power), "", false} : Tick{power, "", std::to_string(k), false};
    if (!labelled) tick = {power, "", "", true};
    add(power, tick);
    if (every > 1) continue;
    for (int multiple = 2; multiple <= 9; ++multiple) {
      const double value = multiple * power;
      const bool few = last - first <= 1 && (multiple == 2 || multiple == 5);
      Tick between = plain ? Tick{value, fixed(value, power), "", false}
                           : Tick{value, std::to_string(multiple), std::to_string(k), false};
      if (!few) between = {value, "", "", true};
      add(value, between);
    }
  }
}

}  // namespace detail

/// The axis for values from low to high (both showable), with a margin and about `about` labelled ticks. An empty or
/// missing range (low > high) is replaced by some range about the values.
inline Axis make_axis(double low, double high, bool logarithmic, int about) {
  Axis axis;
  axis.logarithmic = logarithmic;
  if (!(low <= high)) low = high = logarithmic ? 1 : 0;
  if (logarithmic) {
    const double margin = high > low * 1.01 ? std::pow(high / low, 0.03) : 3;
    axis.low = std::max(low / margin, std::numeric_limits<double>::min());
    axis.high = std::min(high * margin, std::numeric_limits<double>::max());
    detail::logarithmic_ticks(axis, about);
    return axis;
  }
  const double size = std::max(std::abs(low), std::abs(high));
  const double extent = high - low;
  const double margin = extent > 1e-12 * size ? 0.03 * extent : (size > 0 ? 0.1 * size : 1);
  axis.low = low - margin;
  axis.high = high + margin;
  detail::linear_ticks(axis, about);
  return axis;
}

}  // namespace eom::plot
