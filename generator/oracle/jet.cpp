// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/jet.hpp"

#include <cln/dfloat.h>
#include <cln/integer.h>
#include <cln/integer_ring.h>
#include <cln/rational.h>
#include <cln/rational_ring.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace eomgen::verify {

struct Jet::Dual {
  Jet value;
  Slopes slopes;
};

namespace {

constexpr long most_bits_of_angle = 1 << 16;  // before its point
// Of an exponential, far above those of binary64 (709): exponentials of exponentials would take all memory and time.
constexpr long most_exponent = 10000;

const Jet& zero_jet() {
  static const Jet zero;
  return zero;
}

bool is_integer(const Real& x) { return cln:: instanceof (x, cln::cl_I_ring); }

void require(bool ok, const char* why) {
  if (!ok) throw Singular(why);
}

}  // namespace

Real exact(double value) {
  if (value == 0) return 0;
  if (std::abs(value) >= std::numeric_limits<double>::min()) return cln::rational(cln::cl_DF(value));
  constexpr int shift = 200;
  return cln::rational(cln::cl_DF(std::ldexp(value, shift))) / cln::expt(cln::cl_RA(2), cln::cl_I(shift));
}

Jet Jet::with(unsigned level, Jet value, Slopes slopes) {
  if (slopes.empty()) return value;
  Jet jet;
  jet.level_ = level;
  jet.dual_ = std::make_shared<const Dual>(Dual{std::move(value), std::move(slopes)});
  return jet;
}

Jet Jet::on_level(unsigned level, Jet value, std::vector<Jet> slopes) {
  Slopes kept;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (!slopes[i].is_exactly_zero()) kept.emplace_back(static_cast<std::uint32_t>(i), std::move(slopes[i]));
  }
  return with(level, std::move(value), std::move(kept));
}

Jet Jet::variable(unsigned level, Jet value, std::size_t direction) {
  return with(level, std::move(value), {{static_cast<std::uint32_t>(direction), Jet(1)}});
}

const Jet& Jet::value(unsigned level) const { return level_ == level && dual_ ? dual_->value : *this; }

const Jet::Slopes& Jet::slopes(unsigned level) const {
  static const Slopes none;
  return level_ == level && dual_ ? dual_->slopes : none;
}

const Jet& Jet::slope(unsigned level, std::size_t direction) const {
  const Slopes& all = slopes(level);
  const auto found = std::lower_bound(all.begin(), all.end(), direction,
                                      [](const auto& slope, std::size_t wanted) { return slope.first < wanted; });
  return found == all.end() || found->first != direction ? zero_jet() : found->second;
}

std::vector<std::size_t> Jet::directions(unsigned level) const {
  std::vector<std::size_t> result;
  for (const auto& slope : slopes(level)) result.push_back(slope.first);
  return result;
}

const Real& Jet::real() const {
  const Jet* jet = this;
  while (jet->dual_) jet = &jet->dual_->value;
  return jet->real_;
}

bool Jet::is_exactly_zero() const { return !dual_ && cln::zerop(real_) && cln:: instanceof (real_, cln::cl_RA_ring); }

Jet::Slopes Jet::combine(const Jet& a, const Jet* ka, const Jet& b, const Jet* kb, unsigned level) {
  const Slopes &left = a.slopes(level), &right = b.slopes(level);
  Slopes result;
  result.reserve(left.size() + right.size());
  const auto keep = [&](std::uint32_t direction, Jet slope) {
    if (!slope.is_exactly_zero()) result.emplace_back(direction, std::move(slope));
  };
  const auto scaled = [](const Jet& slope, const Jet* by) { return by == nullptr ? slope : slope * *by; };
  auto i = left.begin();
  auto j = right.begin();
  while (i != left.end() || j != right.end()) {
    if (j == right.end() || (i != left.end() && i->first < j->first)) {
      keep(i->first, scaled(i->second, ka));
      ++i;
    } else if (i == left.end() || j->first < i->first) {
      keep(j->first, scaled(j->second, kb));
      ++j;
    } else {
      keep(i->first, scaled(i->second, ka) + scaled(j->second, kb));
      ++i, ++j;
    }
  }
  return result;
}

Jet operator+(const Jet& a, const Jet& b) {
  if (a.is_exactly_zero()) return b;
  if (b.is_exactly_zero()) return a;
  if (!a.dual_ && !b.dual_) return a.real_ + b.real_;
  const unsigned level = std::max(a.level_, b.level_);
  return Jet::with(level, a.value(level) + b.value(level), Jet::combine(a, nullptr, b, nullptr, level));
}

Jet operator-(const Jet& a, const Jet& b) {
  if (b.is_exactly_zero()) return a;
  if (!a.dual_ && !b.dual_) return a.real_ - b.real_;
  const unsigned level = std::max(a.level_, b.level_);
  const Jet minus(-1);
  return Jet::with(level, a.value(level) - b.value(level), Jet::combine(a, nullptr, b, &minus, level));
}

Jet operator*(const Jet& a, const Jet& b) {
  if (a.is_exactly_zero() || b.is_exactly_zero()) return Jet();
  if (!a.dual_ && !b.dual_) return a.real_ * b.real_;
  const unsigned level = std::max(a.level_, b.level_);
  const Jet& a0 = a.value(level);
  const Jet& b0 = b.value(level);
  return Jet::with(level, a0 * b0, Jet::combine(a, &b0, b, &a0, level));
}

Jet operator/(const Jet& a, const Jet& b) {
  if (!b.dual_) {
    require(!cln::zerop(b.real_), "division by zero");
    if (a.is_exactly_zero()) return Jet();
    if (!a.dual_) return a.real_ / b.real_;
    return a * Jet(1 / b.real_);
  }
  const unsigned level = std::max(a.level_, b.level_);
  const Jet& b0 = b.value(level);
  const Jet quotient = a.value(level) / b0;
  const Jet minus = -quotient;
  Jet::Slopes slopes = Jet::combine(a, nullptr, b, &minus, level);
  for (auto& slope : slopes) slope.second = slope.second / b0;
  return Jet::with(level, quotient, std::move(slopes));
}

Jet apply_chain_rule(const Jet& x, Jet value, const Jet& derivative) {
  Jet::Slopes slopes;
  for (const auto& [direction, slope] : x.dual_->slopes) {
    Jet moved = slope * derivative;
    if (!moved.is_exactly_zero()) slopes.emplace_back(direction, std::move(moved));
  }
  return Jet::with(x.level_, std::move(value), std::move(slopes));
}

std::pair<Jet, Jet> sin_cos(const Jet& x, const Precision& p) {
  if (x.level() == 0) {
    if (x.is_exactly_zero()) return {Jet(0), Jet(1)};
    const cln::cl_F angle = p.round(x.real());
    // CLN subtracts a multiple of pi that has the digits of the whole part, which may take all memory.
    require(cln::float_exponent(angle) <= most_bits_of_angle, "an angle is beyond all bounds");
    const cln::cos_sin_t both = cln::cos_sin(angle);
    return {Jet(both.sin), Jet(both.cos)};
  }
  const auto [s, c] = sin_cos(x.value(x.level()), p);
  return {apply_chain_rule(x, s, c), apply_chain_rule(x, c, -s)};
}

std::pair<Jet, Jet> sinh_cosh(const Jet& x, const Precision& p) {
  if (x.level() == 0) {
    require(cln::abs(x.real()) <= most_exponent, "an exponential is beyond all bounds");
    const cln::cosh_sinh_t both = cln::cosh_sinh(p.round(x.real()));
    return {Jet(both.sinh), Jet(both.cosh)};
  }
  const auto [s, c] = sinh_cosh(x.value(x.level()), p);
  return {apply_chain_rule(x, s, c), apply_chain_rule(x, c, s)};
}

Jet tan(const Jet& x, const Precision& p) {
  const auto [s, c] = sin_cos(x, p);
  return s / c;
}

Jet asin(const Jet& x, const Precision& p) {
  // the angle at which the cosine is the positive root
  return atan2(x, sqrt((1 - x) * (1 + x), p), p);
}

Jet acos(const Jet& x, const Precision& p) { return atan2(sqrt((1 - x) * (1 + x), p), x, p); }

Jet atan(const Jet& x, const Precision& p) {
  if (x.level() == 0) return Jet(cln::atan(p.round(x.real())));
  const Jet& x0 = x.value(x.level());
  return apply_chain_rule(x, atan(x0, p), 1 / (1 + x0 * x0));
}

Jet atan2(const Jet& y, const Jet& x, const Precision& p) {
  const unsigned level = std::max(x.level(), y.level());
  if (level == 0) {
    require(!cln::zerop(x.real()) || !cln::zerop(y.real()), "atan2(0, 0)");
    return Jet(cln::atan(p.round(x.real()), p.round(y.real())));  // CLN: the angle of x + i y
  }
  // d(angle) = (x dy - y dx)/(x^2 + y^2); the linear combination is formed on the level of both
  const Jet& x0 = x.value(level);
  const Jet& y0 = y.value(level);
  const Jet square = x0 * x0 + y0 * y0;
  const Jet moment = (x0 / square) * y - (y0 / square) * x;  // its slopes are those of the angle; its value is 0
  return atan2(y0, x0, p) + (moment - moment.value(level));
}

Jet tanh(const Jet& x, const Precision& p) {
  if (cln::abs(x.real()) > most_exponent) return cln::minusp(x.real()) ? Jet(-1) : Jet(1);  // its slope counts as 0
  const auto [s, c] = sinh_cosh(x, p);
  return s / c;
}

Jet exp(const Jet& x, const Precision& p) {
  if (x.level() == 0) {
    require(x.real() <= most_exponent, "an exponential is beyond all bounds");
    // Below the exponent range of CLN's floats it counts as 0.
    static const cln::cl_I faintest = -cln::expt_pos(cln::cl_I(10), 18);
    return x.real() < faintest ? Jet() : Jet(cln::exp(p.round(x.real())));
  }
  const Jet e = exp(x.value(x.level()), p);
  return apply_chain_rule(x, e, e);
}

Jet log(const Jet& x, const Precision& p) {
  require(cln::plusp(x.real()), "log of a number that is not positive");
  if (x.level() == 0) return Jet(cln::ln(p.round(x.real())));
  const Jet& x0 = x.value(x.level());
  return apply_chain_rule(x, log(x0, p), 1 / x0);
}

Jet sqrt(const Jet& x, const Precision& p) {
  if (x.level() == 0) {
    require(!cln::minusp(x.real()), "sqrt of a negative number");
    return x.is_exactly_zero() ? Jet() : Jet(cln::sqrt(p.round(x.real())));
  }
  require(cln::plusp(x.real()), "sqrt at zero, where it has no derivative");
  const Jet root = sqrt(x.value(x.level()), p);
  return apply_chain_rule(x, root, 1 / (2 * root));
}

namespace {

/// base^n by squaring, n >= 0.
Jet integer_power(Jet base, cln::cl_I n) {
  Jet result(1);
  while (!cln::zerop(n)) {
    if (cln::oddp(n)) result = result * base;
    n = n >> 1;
    if (!cln::zerop(n)) base = base * base;
  }
  return result;
}

}  // namespace

Jet power(const Jet& base, const Jet& exponent, const Precision& p) {
  if (exponent.level() == 0 && is_integer(exponent.real())) {
    const cln::cl_I n = cln::the<cln::cl_I>(exponent.real());
    const bool small = cln::abs(n) <= 1000;  // larger powers of exact numbers would not stay small
    const Jet start = base.level() == 0 && !small ? Jet(p.round(base.real())) : base;
    const Jet whole = integer_power(start, cln::abs(n));
    return cln::minusp(n) ? 1 / whole : whole;
  }
  require(cln::plusp(base.real()), "real power of a number that is not positive");
  return exp(exponent * log(base, p), p);
}

}  // namespace eomgen::verify
