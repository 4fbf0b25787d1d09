// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic of the independent oracle: numbers with infinitesimals, over CLN reals of any precision.
//
// A jet is value + sum_i slope_i eps_i with eps_i eps_k = 0. Value and slopes are jets of a lower level, so that jets
// nest: with time on level 1 and again on level 2 a position carries r, v and a (a Taylor series to second order);
// with the coordinates on the level above it also carries d(.)/dq_i, all directions in one pass. A derivative is a
// coefficient; no formula is ever differentiated. Levels are tags: a jet of a lower level is constant for the higher
// ones, so nested derivatives cannot be confused with one another.
//
// Exact rationals stay exact. Exact zeros cost nothing: slopes are stored by direction, and exact zeros are omitted.
#pragma once

#include <cln/float.h>
#include <cln/real.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace eomgen::verify {

using Real = cln::cl_R;

/// The float format of one verification; functions of exact arguments are rounded to it.
struct Precision {
  explicit Precision(int digits) : format(cln::float_format(static_cast<std::uintptr_t>(digits))) {}
  cln::cl_F round(const Real& x) const { return cln::cl_float(x, format); }
  cln::float_format_t format;
};

/// The exact value of a binary64, also of subnormal ones, which CLN does not convert.
Real exact(double value);

/// No (differentiable) value exists at this point: a division by zero, the root of a negative number, a kink.
struct Singular : std::domain_error {
  using std::domain_error::domain_error;
};

class Jet {
 public:
  Jet() = default;  // exact 0
  Jet(Real number) : real_(std::move(number)) {}
  Jet(int number) : real_(number) {}
  /// value + sum slope_i eps_i on `level` (>= 1, above the levels of value and slopes); the value alone if all slopes
  /// are exactly 0.
  static Jet on_level(unsigned level, Jet value, std::vector<Jet> slopes);
  /// value + eps_direction
  static Jet variable(unsigned level, Jet value, std::size_t direction);

  unsigned level() const { return level_; }
  const Jet& value(unsigned level) const;  // without the eps of `level`
  const Jet& slope(unsigned level, std::size_t direction) const;
  const Real& real() const;  // without any eps
  /// The directions of `level` along which the slope is not exactly 0, ascending.
  std::vector<std::size_t> directions(unsigned level) const;
  bool is_exactly_zero() const;

 private:
  struct Dual;
  friend Jet operator+(const Jet& a, const Jet& b);
  friend Jet operator-(const Jet& a, const Jet& b);
  friend Jet operator*(const Jet& a, const Jet& b);
  friend Jet operator/(const Jet& a, const Jet& b);
  friend Jet apply_chain_rule(const Jet& x, Jet value, const Jet& derivative);
  using Slopes = std::vector<std::pair<std::uint32_t, Jet>>;  // ascending by direction, none exactly 0
  static Jet with(unsigned level, Jet value, Slopes slopes);
  const Slopes& slopes(unsigned level) const;
  /// a.slope * ka + b.slope * kb along every direction of either; a null factor counts as 1.
  static Slopes combine(const Jet& a, const Jet* ka, const Jet& b, const Jet* kb, unsigned level);

  unsigned level_ = 0;
  Real real_ = 0;
  std::shared_ptr<const Dual> dual_;
};

Jet operator+(const Jet& a, const Jet& b);
Jet operator-(const Jet& a, const Jet& b);
Jet operator*(const Jet& a, const Jet& b);
Jet operator/(const Jet& a, const Jet& b);  // throws Singular
inline Jet operator-(const Jet& a) { return Jet(0) - a; }

/// f(x) from f and f' at x.value: one step of the chain rule on the level of x.
Jet apply_chain_rule(const Jet& x, Jet value, const Jet& derivative);

// Elementary functions; all throw Singular outside the open domain in which they are differentiable.
std::pair<Jet, Jet> sin_cos(const Jet& x, const Precision& p);
std::pair<Jet, Jet> sinh_cosh(const Jet& x, const Precision& p);
Jet tan(const Jet& x, const Precision& p);
Jet asin(const Jet& x, const Precision& p);
Jet acos(const Jet& x, const Precision& p);
Jet atan(const Jet& x, const Precision& p);
Jet atan2(const Jet& y, const Jet& x, const Precision& p);
Jet tanh(const Jet& x, const Precision& p);
Jet exp(const Jet& x, const Precision& p);
Jet log(const Jet& x, const Precision& p);
Jet sqrt(const Jet& x, const Precision& p);
Jet power(const Jet& base, const Jet& exponent, const Precision& p);

}  // namespace eomgen::verify
