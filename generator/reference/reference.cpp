// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/reference.hpp"

#include <cln/dfloat.h>
#include <cln/exception.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "error.hpp"
#include "numeric/numbers.hpp"
#include "program/interpret.hpp"
#include "program/taylor.hpp"
#include "reference/consistent_start.hpp"

namespace eomgen::reference {

using program::Operand;
using program::Slot;
using symbolic::Op;

namespace {

// Taylor coefficients of a motion in any precision: the recurrences of the program (program/taylor.hpp) in CLN
// arithmetic.

using Number = cln::cl_F;

class TaylorExpansion {
 public:
  TaylorExpansion(const program::Taylor& taylor, int digits)
      : taylor_(taylor), digits_(digits), format_(cln::float_format(static_cast<std::uintptr_t>(digits))) {
    const program::Function& next = taylor.next;
    states_ = next.results[2].entries.size();
    for (const symbolic::Rational& constant : next.constants) values_.push_back(cln::cl_float(constant, format_));
    values_.push_back(cln::pi(format_));
    at_k_ = values_.size();
    at_x_ = at_k_ + 1;
    at_w_ = at_x_ + states_;
    at_code_ = at_w_ + taylor.workspace_size();
    values_.resize(at_code_ + next.code.size(), cln::cl_float(0, format_));
    for (const program::Instruction& instruction : next.code) {
      if (instruction.op != Op::add && instruction.op != Op::mul && instruction.op != Op::select)
        throw std::logic_error("recurrences are sums, products and branches");
      code_.push_back({instruction.op, {}});
      for (const Operand& operand : instruction.operands) code_.back().operands.push_back(place(operand));
    }
    for (const Operand& entry : next.results[0].entries) a_.push_back(place(entry));
    for (const Operand& entry : next.results[1].entries) b_.push_back(place(entry));
    for (const Operand& entry : next.results[2].entries) dx_.push_back(place(entry));
    for (std::size_t i = 0; i < a_.size(); ++i) {
      const Operand& factor = next.results[0].entries[i];
      if (factor.slot != Slot::constant || next.constants[factor.index] != 0) sums_ = i + 1;
    }
  }

  /// c[k][i], k = 0..order. Throws std::domain_error if a function leaves its domain.
  std::vector<std::vector<Number>> operator()(const Number& t, const std::vector<Number>& x,
                                              const std::vector<double>& p, const std::vector<double>& u, int order) {
    program::Arguments<cln::cl_R> at;
    at.t = t;
    at.x.assign(x.begin(), x.end());
    for (const double value : p) at.p.emplace_back(number(value));
    for (const double value : u) at.u.emplace_back(number(value));
    const auto start = program::interpret(taylor_.start, at, digits_).results;
    const auto rounded = [this](const cln::cl_R& value) { return cln::cl_float(value, format_); };
    std::vector<std::vector<Number>> c{x, {}}, a(1), b(1);
    for (const cln::cl_R& value : start[1]) c[1].push_back(rounded(value));
    for (std::size_t i = 0; i < taylor_.order_zero_count; ++i) values_[at_w_ + i] = rounded(start[0][i]);
    const std::size_t at_sums = at_w_ + taylor_.order_zero_count, last = at_w_ + taylor_.workspace_size() - 1;
    for (int k = 1; k < order; ++k) {
      const auto n = static_cast<std::size_t>(k);
      for (std::size_t i = 0; i < sums_; ++i) {
        Number sum = cln::cl_float(0, format_);
        for (std::size_t j = 1; j < n; ++j) sum = sum + a[j][i] * b[n - j][i];
        values_[at_sums + i] = sum;
      }
      values_[at_k_] = cln::cl_float(k, format_);
      values_[last - 1] = cln::cl_float(k == 1 ? 1 : 0, format_);
      values_[last] = cln::cl_float(cln::cl_RA(1) / k, format_);
      for (std::size_t i = 0; i < states_; ++i) values_[at_x_ + i] = c[n][i];
      run_next();
      a.emplace_back();
      b.emplace_back();
      for (std::size_t i = 0; i < sums_; ++i) {
        a.back().push_back(read(a_[i]));
        b.back().push_back(read(b_[i]));
      }
      c.emplace_back();
      for (std::size_t i = 0; i < states_; ++i) c.back().push_back(read(dx_[i]) / cln::cl_float(k + 1, format_));
    }
    return c;
  }

  Number number(double value) const { return cln::cl_float(numeric::exact(value), format_); }

 private:
  struct Place {
    std::size_t index;
    bool negated;
  };
  struct Step {
    symbolic::Op op;
    std::vector<Place> operands;
  };
  Place place(const Operand& operand) const {
    const auto at = [&](std::size_t first) { return Place{first + operand.index, operand.negated}; };
    switch (operand.slot) {
      case Slot::constant: return at(0);
      case Slot::pi: return {at_k_ - 1, operand.negated};
      case Slot::time: return {at_k_, operand.negated};
      case Slot::state: return at(at_x_);
      case Slot::prepared: return at(at_w_);
      case Slot::value: return at(at_code_);
      default: throw std::logic_error("recurrences read no parameters");
    }
  }

  Number read(const Place& place) const { return place.negated ? -values_[place.index] : values_[place.index]; }
  void run_next() {
    for (std::size_t i = 0; i < code_.size(); ++i) {
      const std::vector<Place>& o = code_[i].operands;
      Number& result = values_[at_code_ + i];
      if (code_[i].op == Op::select) {
        result = read(o[0]) < read(o[1]) ? read(o[2]) : read(o[3]);
        continue;
      }
      result = read(o[0]);
      for (std::size_t k = 1; k < o.size(); ++k) {
        const Number& size = values_[o[k].index];
        if (code_[i].op == Op::mul) {
          result = o[k].negated ? -(result * size) : result * size;
        } else {
          result = o[k].negated ? result - size : result + size;
        }
      }
    }
  }

  const program::Taylor& taylor_;
  int digits_;
  cln::float_format_t format_;
  std::size_t states_ = 0, at_k_ = 0, at_x_ = 0, at_w_ = 0, at_code_ = 0;
  std::size_t sums_ = 0;  // without padding
  std::vector<Step> code_;
  std::vector<Place> a_, b_, dx_;
  std::vector<Number> values_;
};

using States = std::vector<std::vector<Number>>;

constexpr int guard = 4;  // digits between the last terms and the rounding error of the arithmetic
constexpr std::size_t most_steps = 1000000;
constexpr double event_tolerance = 1e-8;  // of the span: between an event of the run and that in all digits
constexpr int most_secants = 40;

[[noreturn]] void fail(const Number& t, const std::string& why) {
  throw Error("reference", {}, fmt::format("the reference ends at t = {:.6g}: {}", cln::double_approx(t), why),
              "shorten the run (--t-end), or start elsewhere", ErrorKind::numerical);
}

/// log2 |x|, also beyond the range of double.
double log2_of(const Number& x) {
  if (cln::zerop(x)) return -std::numeric_limits<double>::infinity();
  const auto exponent = cln::float_exponent(x);
  return std::log2(std::abs(cln::double_approx(cln::scale_float(x, -exponent)))) + static_cast<double>(exponent);
}
double log2_of(const std::vector<Number>& list) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const Number& x : list) largest = std::max(largest, log2_of(x));
  return largest;
}

class Run {
 public:
  Run(const Problem& problem, const program::Taylor& taylor, Settings settings, bool continues_in_gaps)
      : problem_(problem),
        settings_(settings),
        continues_in_gaps_(continues_in_gaps),
        expand_(taylor, settings.digits),
        t_(expand_.number(problem.t0)) {
    for (const double x : problem.x) x_.push_back(expand_.number(x));
    if (problem.constraints != nullptr) {
      x_ = make_consistent(*problem.constraints, problem.coordinates, t_, std::move(x_), problem.p, settings.digits);
    }
  }

  States run() {
    if (problem_.change) problem_.change(0, t_, x_, settings_.digits);
    for (std::size_t k = 0; k < problem_.segments.size(); ++k) {
      const InputSegment& segment = problem_.segments[k];
      // The last segment ends with the run, unless a kink at the end of the run is to be crossed.
      const bool last = &segment == &problem_.segments.back() && segment.next == segment.until;
      const double until = last ? problem_.times.back() : segment.until;
      const Number end = expand_.number(until);
      while (t_ != end) step(segment, end);
      if (segment.event) move_to_event(k);
      if (segment.next != segment.until) cross_gap(segment);
      if (!last && problem_.change) problem_.change(k + 1, t_, x_, settings_.digits);
      if (!last) last_.clear();
    }
    while (wanted_.size() < problem_.times.size()) wanted_.push_back(x_);
    return std::move(wanted_);
  }
  std::size_t steps() const { return steps_; }

 private:
  void cross_gap(const InputSegment& segment) {
    const Number next = expand_.number(segment.next);
    if (continues_in_gaps_ && !last_.empty()) x_ = at(last_, next - last_t_);
    t_ = next;
  }

  /// Moves to the zero of the event function by the secant method on the series of the last step.
  void move_to_event(std::size_t segment) {
    const auto value = [&](const Number& t) {
      return problem_.event_value(segment, t, at(last_, t - last_t_), settings_.digits);
    };
    const auto lost = [&] { fail(t_, "an event that follows has no zero near the time at which the run has it"); };
    if (last_.empty()) lost();
    const Number from = t_, span = cln::abs(expand_.number(problem_.times.back()) - expand_.number(problem_.t0)),
                 width = expand_.number(event_tolerance) * span,
                 rounding = cln::scale_float(cln::max(cln::abs(t_), span), -settings_.bits());
    Number a = t_, b = t_ - width;
    Number at_a = value(a), at_b = value(b);
    for (int i = 0; i < most_secants && !cln::zerop(at_a) && at_a != at_b; ++i) {
      const Number next = a - at_a * (a - b) / (at_a - at_b);
      if (next == a) break;
      if (cln::abs(next - from) > width) lost();
      b = a;
      at_b = at_a;
      a = next;
      at_a = value(a);
      if (cln::abs(a - b) <= rounding) break;
      if (i + 1 == most_secants) lost();
    }
    x_ = at(last_, a - last_t_);
    t_ = a;
  }

  void step(const InputSegment& segment, const Number& end) {
    if (problem_.interrupt != nullptr && *problem_.interrupt) fail(t_, "interrupted");
    if (++steps_ > most_steps) fail(t_, fmt::format("more than {} steps", most_steps));
    States c;
    try {
      c = expand_(t_, x_, problem_.p, segment.u, settings_.order);
    } catch (const std::domain_error& error) {
      fail(t_, error.what());
    } catch (const cln::runtime_exception& error) {
      fail(t_, error.what());
    }
    const double span = cln::double_approx(end - t_);
    const double h = std::min(length(c), std::abs(span));
    if (!(h > 1e-14 * std::abs(span)) && h < std::abs(span)) fail(t_, "steps become too short");
    const bool last = h >= std::abs(span);
    const Number next = last ? end : t_ + expand_.number(std::copysign(h, span));
    while (wanted_.size() < problem_.times.size()) {
      const Number time = expand_.number(problem_.times[wanted_.size()]);
      if (span > 0 ? time > next : time < next) break;
      wanted_.push_back(at(c, time - t_));
    }
    x_ = at(c, next - t_);
    last_t_ = std::exchange(t_, next);
    last_ = std::move(c);
    if (problem_.progress)
      problem_.progress((cln::double_approx(t_) - problem_.t0) / (problem_.times.back() - problem_.t0));
  }

  /// The step at which the last two terms are 10^-(digits - guard) of the largest value.
  double length(const States& c) const {
    const double scale = std::max(log2_of(c[0]), -1000.0) - (settings_.digits - guard) * std::log2(10.0);
    double h = std::numeric_limits<double>::infinity();
    for (const int k : {settings_.order - 1, settings_.order}) {
      h = std::min(h, std::exp2((scale - log2_of(c[static_cast<std::size_t>(k)])) / k));
    }
    return h;
  }

  static std::vector<Number> at(const States& c, const Number& d) {
    std::vector<Number> x = c.back();
    for (std::size_t k = c.size() - 1; k-- > 0;) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = x[i] * d + c[k][i];
    }
    return x;
  }

  const Problem& problem_;
  Settings settings_;
  bool continues_in_gaps_;
  TaylorExpansion expand_;
  Number t_, last_t_ = t_;
  States last_;  // coefficients of the last step, about last_t_
  std::vector<Number> x_;
  States wanted_;
  std::size_t steps_ = 0;
};

/// Number of digits in which a and b agree, relative to `scale` of each component.
int agreement(const std::vector<Number>& a, const std::vector<Number>& b, const std::vector<double>& scale) {
  double worst = -1000;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Number difference = a[i] - b[i];
    if (!cln::zerop(difference)) worst = std::max(worst, (log2_of(difference) - scale[i]) * std::log10(2.0));
  }
  return static_cast<int>(std::floor(-worst));
}

}  // namespace

Solution solve(const Problem& problem, Settings first, Settings second) {
  const program::Taylor taylor = program::recurrences(problem.rhs);
  Problem quiet = problem;  // the first run is cheaper: it counts as the first third of the progress
  if (problem.progress) quiet.progress = [&](double fraction) { problem.progress(fraction / 3); };
  Run rough(quiet, taylor, first, false);
  const States a = rough.run();
  if (problem.progress) quiet.progress = [&](double fraction) { problem.progress((1 + 2 * fraction) / 3); };
  Run sharp(quiet, taylor, second, true);
  const States b = sharp.run();

  Solution solution;
  std::vector<double> scale(problem.x.size(), -std::numeric_limits<double>::infinity());
  double largest = -1000;
  for (const std::vector<Number>& state : b) {
    solution.x.emplace_back();
    for (std::size_t i = 0; i < state.size(); ++i) {
      solution.x.back().push_back(cln::double_approx(state[i]));
      scale[i] = std::max(scale[i], log2_of(state[i]));
      largest = std::max(largest, scale[i]);
    }
  }
  constexpr double nothing = -66;  // log2: components below 1e-20 of the largest are rounding error
  for (double& s : scale) s = std::max(s, largest + nothing);
  solution.end = b.back();
  solution.digits = std::min(first.digits, second.digits);
  for (std::size_t j = 0; j < b.size(); ++j) solution.digits = std::min(solution.digits, agreement(a[j], b[j], scale));
  solution.digits_at_end = std::min({first.digits, second.digits, agreement(a.back(), b.back(), scale)});
  solution.steps = sharp.steps();
  solution.method = fmt::format("Taylor series of orders {} and {} in {} and {} digits", first.order, second.order,
                                first.digits, second.digits);
  return solution;
}

}  // namespace eomgen::reference
