// SPDX-License-Identifier: MIT
// Analysis of functions of time alone, also through inputs. They are cheap to evaluate, and a pulse among them may be
// shorter than the steps of the motion before it. In: such functions, values of their parameters, a time span. Out:
// times at which a kink is crossed, and bounds on steps that resolve the smooth functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "eom/expressions/code.hpp"
#include "eom/hybrid/inputs.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/run_types.hpp"

namespace eom::hybrid {

struct TimeAnalysis {
  std::vector<Breakpoint> breakpoints;         // in the span, ascending; without the jumps of tables
  std::vector<StepBound> bounds;               // empty: no function is narrow compared with the span
  std::optional<double> unresolved_from = {};  // from here on a condition on time changes too often to be resolved
};

class TimeAnalyser {
 public:
  TimeAnalyser(const TimeFunctions& functions, std::span<const double> parameters, const std::vector<Signal>& inputs,
               double t0, double t1)
      : functions_(functions),
        parameters_(parameters),
        inputs_(inputs),
        t0_(t0),
        t1_(t1),
        at_(1 + inputs.size()),
        box_(1 + inputs.size()) {}

  TimeAnalysis run() {
    if (functions_.empty()) return {};
    find_breakpoints();
    for (const expressions::Table& term : functions_.terms) bound_steps(expressions::Code(term, parameters_));
    const auto narrow =
        std::min_element(bounds_.begin(), bounds_.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
    if (narrow == bounds_.end() || narrow->step >= (t1_ - t0_) / 2) bounds_.clear();
    std::erase_if(cuts_, [&](const Breakpoint& b) { return b.before == b.after; });
    return {std::move(cuts_), std::move(bounds_), unresolved_from_};
  }

  /// The time at which the motion begins: t0, or behind a kink there.
  double begin() {
    if (functions_.surfaces.empty() || !(t1_ > t0_)) return t0_;
    find_breakpoints();
    return !cuts_.empty() && cuts_.front().before <= t0_ ? cuts_.front().after : t0_;
  }

 private:
  using Code = expressions::Code;
  using SlopedInterval = expressions::SlopedInterval;
  static constexpr std::size_t most_boxes = 100'000;  // in one root search
  static constexpr std::size_t most_breaks = 20'000;
  static constexpr std::size_t most_cells = 2'000;  // for one smooth function
  static constexpr double resolved = 0.5;           // change of slope times length of a cell, relative to the range
  static constexpr double ripple = 1e-3;            // of the largest value of a term: smaller ranges are ignored
  static constexpr double steps_per_cell = 8;       // bounds a sine to steps of half a period or more
  static constexpr double shortest = 1e-12;         // of the span, in a search

  struct Cell {
    double a, b, unresolved;
    bool operator<(const Cell& other) const { return unresolved < other.unresolved; }
  };

  void find_breakpoints() {
    for (const Signal& input : inputs_) {
      for (const double t : input.times) {
        if (t > t0_ && t < t1_) cuts_.push_back({t, t});
      }
    }
    merge_overlapping(cuts_);
    for (const expressions::Table& surface : functions_.surfaces) find_kinks(surface);
    find_kink_at_start();
    find_kink_at_end();
  }

  static void merge_overlapping(std::vector<Breakpoint>& breakpoints) {
    std::sort(breakpoints.begin(), breakpoints.end(),
              [](const Breakpoint& a, const Breakpoint& b) { return a.before < b.before; });
    std::size_t kept = 0;
    for (const Breakpoint& b : breakpoints) {
      if (kept > 0 && b.before <= breakpoints[kept - 1].after)
        breakpoints[kept - 1].after = std::max(breakpoints[kept - 1].after, b.after);
      else
        breakpoints[kept++] = b;
    }
    breakpoints.resize(kept);
  }

  /// Visits the pieces between the cuts. Branches of nested kinks are those at the middle of the piece.
  template <class Visit>
  void for_each_piece(Visit&& visit) const {
    double from = t0_;
    for (const Breakpoint& cut : cuts_) {
      if (cut.before > from) visit(from, cut.before);
      from = std::max(from, cut.after);
    }
    if (t1_ > from) visit(from, t1_);
  }

  const std::vector<double>& at(double t, double within) {
    at_[0] = t;
    for (std::size_t i = 0; i < inputs_.size(); ++i) at_[1 + i] = table_value(inputs_[i], t, within).value;
    return at_;
  }
  const std::vector<SlopedInterval>& box(double a, double b) {
    const double middle = (a + b) / 2;
    box_[0] = {{a, b}, {1, 1}};
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const auto [left, slope] = table_value(inputs_[i], a, middle);
      const double right = table_value(inputs_[i], b, middle).value;
      box_[1 + i] = {{std::min(left, right), std::max(left, right)}, {slope, slope}};
    }
    return box_;
  }

  void find_kinks(const expressions::Table& surface) {
    Code code(surface, parameters_);
    std::vector<Breakpoint> found;
    std::size_t boxes = 0;
    for_each_piece([&](double a, double b) { find_roots(code, code.roots(), a, b, found, boxes); });
    cuts_.insert(cuts_.end(), found.begin(), found.end());
    merge_overlapping(cuts_);
  }

  void find_roots(Code& code, std::size_t operands, double from, double to, std::vector<Breakpoint>& found,
                  std::size_t& boxes) {
    const double middle = (from + to) / 2;
    code.freeze(at(middle, middle));
    const auto value = [&](double t) {
      code.values(at(t, middle), {});
      const double a = code.value(at(t, middle), 0);
      return operands == 1 ? a : a - code.value(at(t, middle), 1);
    };
    std::vector<std::pair<double, double>> open{{from, to}};
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      if (++boxes > most_boxes || found.size() > most_breaks) {
        record_unresolved(a);
        return;
      }
      SlopedInterval g = code.range(box(a, b), 0);
      if (operands == 2) {
        const SlopedInterval other = code.range(box_, 1);
        g = {g.value - other.value, g.slope - other.slope};
      }
      if (!g.value.has(0)) continue;
      const double m = a + (b - a) / 2;
      const bool last =
          b - a <= std::max(shortest * (t1_ - t0_), 8 * std::numeric_limits<double>::epsilon() * std::abs(b)) ||
          !(m > a && m < b);
      if (last || !g.slope.has(0)) {
        const double left = value(a), right = value(b);
        if (left * right < 0)
          found.push_back(locate_sign_change(value, a, left, b));
        else if (left == 0 && a > from)
          add_border_root(value, a, found);
        continue;
      }
      if (g.value.is(0)) continue;
      open.push_back({m, b});  // the earlier half is processed first
      open.push_back({a, m});
    }
  }

  /// Adds a root on the border of two boxes if the function has different signs on both sides.
  template <class Value>
  void add_border_root(const Value& value, double t, std::vector<Breakpoint>& found) const {
    const Breakpoint b = nonzero_neighbours(value, t);
    if (value(b.before) * value(b.after) < 0) found.push_back(b);
  }

  template <class Value>
  static Breakpoint nonzero_neighbours(const Value& value, double t) {
    Breakpoint b{t, t};
    for (int i = 0; i < 64 && value(b.before) == 0; ++i)
      b.before = std::nextafter(b.before, -std::numeric_limits<double>::infinity());
    for (int i = 0; i < 64 && value(b.after) == 0; ++i)
      b.after = std::nextafter(b.after, std::numeric_limits<double>::infinity());
    return b;
  }

  /// Locates a change of sign to the last digit.
  template <class Value>
  static Breakpoint locate_sign_change(const Value& value, double a, double left, double b) {
    while (true) {
      const double m = a + (b - a) / 2;
      if (!(m > a && m < b)) return {a, b};
      const double v = value(m);
      if (v == 0) return nonzero_neighbours(value, m);
      (v * left > 0 ? a : b) = m;
    }
  }

  /// The distance within which a kink coincides with time t. It is not 0 at t = 0, because powers of small times have
  /// no binary64 value.
  double coincidence(double t) const {
    return std::max(4 * std::numeric_limits<double>::epsilon() * std::abs(t), 1e-30 * (t1_ - t0_));
  }

  /// The sign of a surface at t in the piece that contains `within`.
  int sign_at(Code& code, double t, double within) {
    code.freeze(at(within, within));
    const std::size_t operands = code.roots();
    double g = code.value(at(t, within), 0);
    if (operands == 2) g -= code.value(at(t, within), 1);
    return g > 0 ? 1 : g < 0 ? -1 : 0;
  }

  /// The time between `other` and `inside`, as close to `other` as possible, at which the surface has the sign that it
  /// has at `inside`.
  double nearest_with_sign(Code& code, double other, double inside, int sign) {
    for (double good = inside;;) {
      const double m = good + (other - good) / 2;
      if (m == good || m == other || std::abs(good - other) < 1e-40 * (t1_ - t0_)) return good;
      (sign_at(code, m, inside) == sign ? good : other) = m;
    }
  }

  /// A kink at the start is crossed before the motion begins: the surfaces have the signs of the first piece.
  void find_kink_at_start() {
    const auto later = std::find_if(cuts_.begin(), cuts_.end(),
                                    [&](const Breakpoint& b) { return b.before > t0_ + coincidence(t0_); });
    const double from = later == cuts_.begin() ? t0_ : std::max(t0_, std::prev(later)->after);
    const double inside = from + ((later == cuts_.end() ? t1_ : later->before) - from) / 2;
    double begin = from;
    for (const expressions::Table& surface : functions_.surfaces) {
      Code code(surface, parameters_);
      const int sign = sign_at(code, inside, inside);
      if (sign == 0 || sign_at(code, from, inside) == sign) continue;
      const double behind = nearest_with_sign(code, from, inside, sign);
      if (behind <= from + coincidence(t0_)) begin = std::max(begin, behind);  // else the search for kinks was given up
    }
    cuts_.erase(cuts_.begin(), later);
    if (begin > t0_) cuts_.insert(cuts_.begin(), {t0_, begin});
  }

  /// A kink at the end is part of the run.
  void find_kink_at_end() {
    const auto at_end = std::find_if(cuts_.begin(), cuts_.end(),
                                     [&](const Breakpoint& b) { return b.after >= t1_ - coincidence(t1_); });
    const double from = at_end == cuts_.begin() ? t0_ : std::prev(at_end)->after;
    double before = at_end == cuts_.end() ? t1_ : at_end->before,
           after = at_end == cuts_.end() ? t1_ : std::prev(cuts_.end())->after;
    const double inside = from + (before - from) / 2, beyond = t1_ + coincidence(t1_);
    for (const expressions::Table& surface : functions_.surfaces) {
      Code code(surface, parameters_);
      const int sign = sign_at(code, inside, inside), behind = sign_at(code, beyond, inside);
      if (sign == 0 || behind * sign >= 0) continue;
      const double last = nearest_with_sign(code, beyond, inside, sign);
      if (last < t1_ - 2 * coincidence(t1_)) continue;  // the search for kinks was given up
      before = std::min(before, last);
      after = std::max(after, nearest_with_sign(code, inside, beyond, behind));
    }
    cuts_.erase(at_end, cuts_.end());
    if (after > before) cuts_.push_back({std::min(before, std::nextafter(t1_, t0_)), std::max(after, t1_)});
  }

  void record_unresolved(double t) {
    if (!unresolved_from_) unresolved_from_ = t;
  }

  void bound_steps(expressions::Code code) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto visit = [&](double v) {
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    };
    const auto cell = [&](double a, double b) {
      const double m = a + (b - a) / 2;
      code.freeze(at(m, m));
      for (const double t : {a, m, b}) visit(code.value(at(t, m)));
      const SlopedInterval f = code.range(box(a, b));
      const double bend = f.slope.width() * (b - a), rise = 2 * f.value.width();
      const double unresolved = std::isfinite(bend) ? std::min(bend, rise) : rise;
      return Cell{a, b, std::isnan(unresolved) ? std::numeric_limits<double>::infinity() : unresolved};
    };
    std::priority_queue<Cell> open;
    for_each_piece([&](double a, double b) { open.push(cell(a, b)); });
    std::vector<Cell> done;
    const std::size_t pieces = open.size();
    while (!open.empty()) {
      const Cell top = open.top();
      const double range = std::max(high - low, ripple * std::max(std::abs(low), std::abs(high)));
      const double m = top.a + (top.b - top.a) / 2;
      if (!(top.unresolved > resolved * range) || open.size() + done.size() > pieces + most_cells) break;
      open.pop();
      if (top.b - top.a <= shortest * (t1_ - t0_) || !(m > top.a && m < top.b)) {
        done.push_back(top);
        continue;
      }
      open.push(cell(top.a, m));
      open.push(cell(m, top.b));
    }
    for (; !open.empty(); open.pop()) done.push_back(open.top());
    std::sort(done.begin(), done.end(), [](const Cell& a, const Cell& b) { return a.a < b.a; });
    std::vector<StepBound> own;
    for (const Cell& c : done) {
      const double step = steps_per_cell * (c.b - c.a);
      if (own.empty() || own.back().step != step) own.push_back({c.a, step});
    }
    bounds_ = minimum_of(bounds_, own);
  }

  /// The minimum of two step bounds at every time.
  static std::vector<StepBound> minimum_of(const std::vector<StepBound>& a, const std::vector<StepBound>& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    std::vector<StepBound> result;
    std::size_t i = 0, j = 0;
    double of_a = std::numeric_limits<double>::infinity(), of_b = of_a;
    while (i < a.size() || j < b.size()) {
      const double t = i == a.size() ? b[j].t : j == b.size() ? a[i].t : std::min(a[i].t, b[j].t);
      if (i < a.size() && a[i].t == t) of_a = a[i++].step;
      if (j < b.size() && b[j].t == t) of_b = b[j++].step;
      const double step = std::min(of_a, of_b);
      if (result.empty() || result.back().step != step) result.push_back({t, step});
    }
    return result;
  }

  const TimeFunctions& functions_;
  std::span<const double> parameters_;
  const std::vector<Signal>& inputs_;
  double t0_, t1_;
  std::vector<Breakpoint> cuts_;
  std::vector<StepBound> bounds_;
  std::optional<double> unresolved_from_;
  std::vector<double> at_;
  std::vector<SlopedInterval> box_;
};

/// The time at which a motion from t0 to t1 begins: t0, or behind a kink there.
inline double time_behind_start(const TimeFunctions& functions, std::span<const double> parameters,
                                const std::vector<Signal>& inputs, double t0, double t1) {
  return TimeAnalyser(functions, parameters, inputs, t0, t1).begin();
}

/// Analyses functions of time with these parameters and inputs. Only inputs that are tables are variables; others are
/// part of the functions.
inline TimeAnalysis analyse_time_functions(const TimeFunctions& functions, std::span<const double> parameters,
                                           const std::vector<Signal>& inputs, double t0, double t1) {
  return TimeAnalyser(functions, parameters, inputs, t0, t1).run();
}

}  // namespace eom::hybrid
