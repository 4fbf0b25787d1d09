// SPDX-License-Identifier: GPL-3.0-or-later
// Intervals of values with intervals of slopes: where a function of one variable can be between two of its values. In:
// operands. Out: bounds of the result and of its derivative, as wide as rounding is small beside them: they serve to
// look closer, not to prove.
#pragma once

#include <limits>

#include "symbolic/dag.hpp"

namespace eomgen::run {

struct Interval {
  double low = 0, high = 0;

  static constexpr Interval all() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  bool has(double value) const { return low <= value && value <= high; }
  bool is(double value) const { return low == value && high == value; }
  double width() const { return high - low; }
};

Interval operator+(Interval a, Interval b);
Interval operator-(Interval a, Interval b);
Interval operator-(Interval a);
Interval operator*(Interval a, Interval b);
Interval operator/(Interval a, Interval b);
Interval hull(Interval a, Interval b);
/// What both allow; a where they allow nothing together, which is rounding.
Interval common(Interval a, Interval b);

/// A value, and its slope along the one variable; slopes of what jumps are unbounded.
struct Sloped {
  Interval value, slope;
};

namespace sloped {

Sloped product(const Sloped& a, const Sloped& b);
Sloped quotient(const Sloped& a, const Sloped& b);
Sloped power(const Sloped& a, int exponent);  // 2 and more
Sloped pow(const Sloped& a, const Sloped& b);
/// A function of one argument, its slope by symbolic/functions.hpp; not abs and sign, whose branch may be known.
Sloped call(symbolic::Op function, const Sloped& a);
Sloped atan2(const Sloped& y, const Sloped& x);

}  // namespace sloped
}  // namespace eomgen::run
