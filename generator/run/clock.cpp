// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <set>

#include "run/range_code.hpp"
#include "system/expressions.hpp"

namespace eomgen::run {
namespace {

using symbolic::Dag;
using symbolic::Node;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr std::size_t most_boxes = 100'000;  // of one search for roots
constexpr std::size_t most_breaks = 20'000;
constexpr std::size_t most_cells = 2'000;  // of one smooth function
constexpr double resolved = 0.5;           // change of the slope times the length of a cell, of the function's range
constexpr double ripple = 1e-3;            // of the largest value of a term: a smaller range is none
constexpr double steps_per_cell = 8;       // a sine is bounded to steps of half a period at least
constexpr double shortest = 1e-12;         // of the span, in a search

/// What each node depends on: 0: on parameters and tables, 1: on t too, 2: on more.
class Dependence {
 public:
  Dependence(const Dag& dag, const std::vector<ClockInput>& inputs)
      : dag_(dag), inputs_(inputs), of_(dag.size(), unseen) {}

  void see(const std::vector<Ref>& roots) {
    for (const Ref r : dag_.reachable(roots)) {
      if (of_[r.id] != unseen) continue;
      seen_.push_back(r);
      const Node& node = dag_[r];
      if (node.op == symbolic::Op::symbol) {
        of_[r.id] = of_symbol(dag_.symbol_of(r));
        continue;
      }
      of_[r.id] = 0;
      for (std::size_t k = 0; k < node.arity; ++k) of_[r.id] = std::max(of_[r.id], of_[node.args[k].id]);
    }
  }
  int operator()(Ref r) const { return of_[r.id]; }
  /// All nodes seen, operands before their users.
  const std::vector<Ref>& seen() const { return seen_; }

 private:
  static constexpr signed char unseen = -1;

  signed char of_symbol(const Symbol& s) const {
    if (s.kind == SymbolKind::time) return 1;
    if (s.kind == SymbolKind::parameter) return 0;
    if (s.kind != SymbolKind::input) return 2;
    return inputs_[s.index].expression ? of_[inputs_[s.index].expression->id] : static_cast<signed char>(0);
  }

  const Dag& dag_;
  const std::vector<ClockInput>& inputs_;
  std::vector<signed char> of_;
  std::vector<Ref> seen_;
};

class Search {
 public:
  Search(const system::EquationSystem& system, const std::vector<double>& parameters,
         const std::vector<ClockInput>& inputs, double t0, double t1)
      : system_(system),
        dag_(*system.dag),
        parameters_(parameters),
        inputs_(inputs),
        t0_(t0),
        t1_(t1),
        depends_(dag_, inputs),
        at_(1 + inputs.size()),
        box_(1 + inputs.size()) {}

  Clock run() {
    std::vector<Ref> roots;
    for (const ClockInput& input : inputs_) {
      if (input.expression) roots.push_back(*input.expression);
    }
    depends_.see(roots);
    roots.clear();
    system::for_each_expression(system_, [&](Ref r, system::Part part) {
      if (part != system::Part::shown) roots.push_back(r);
    });
    const std::size_t moving = roots.size();
    for (const Ref r : {system_.kinetic, system_.potential}) roots.push_back(r);
    for (const system::Output& output : system_.outputs) {  // what jumps there
      if (output.kind == system::OutputKind::position || output.kind == system::OutputKind::velocity)
        roots.push_back(output.value);
    }
    depends_.see(roots);
    if (std::none_of(depends_.seen().begin(), depends_.seen().end(), [&](Ref r) { return depends_(r) == 1; }))
      return {};
    for (const ClockInput& input : inputs_) {
      if (input.expression) continue;
      for (const double t : input.signal->jumps()) {
        if (t > t0_ && t < t1_) cuts_.push_back({t, t});
      }
    }
    tidy(cuts_);
    for (const Ref r : depends_.seen()) {
      if (symbolic::is_kink(dag_[r].op)) find_kink(r);
    }
    roots.resize(moving);
    find_bounds(roots);
    std::erase_if(cuts_, [&](const Break& b) { return b.before == b.after; });
    return {std::move(cuts_), std::move(bounds_), unfollowed_from_};
  }

 private:
  struct Cell {
    double a, b, unresolved;
    bool operator<(const Cell& other) const { return unresolved < other.unresolved; }
  };

  static void tidy(std::vector<Break>& breaks) {
    std::sort(breaks.begin(), breaks.end(), [](const Break& a, const Break& b) { return a.before < b.before; });
    std::size_t kept = 0;
    for (const Break& b : breaks) {
      if (kept > 0 && b.before <= breaks[kept - 1].after)
        breaks[kept - 1].after = std::max(breaks[kept - 1].after, b.after);
      else
        breaks[kept++] = b;
    }
    breaks.resize(kept);
  }

  RangeCode code_of(const std::vector<Ref>& roots) const {
    return RangeCode(dag_, roots, [&](const Symbol& s) {
      if (s.kind == SymbolKind::time) return RangeCode::Leaf::of_variable(0);
      if (s.kind == SymbolKind::parameter) return RangeCode::Leaf::of(parameters_[s.index]);
      if (s.kind != SymbolKind::input) return RangeCode::Leaf{};
      const ClockInput& input = inputs_[s.index];
      return input.expression ? RangeCode::Leaf::of_expression(*input.expression)
                              : RangeCode::Leaf::of_variable(1 + s.index);
    });
  }

  /// The pieces between the cuts; branches of inner kinks are those in their middle.
  template <class See>
  void for_each_piece(See&& see) const {
    double from = t0_;
    for (const Break& cut : cuts_) {
      if (cut.before > from) see(from, cut.before);
      from = std::max(from, cut.after);
    }
    if (t1_ > from) see(from, t1_);
  }

  const std::vector<double>& at(double t, double within) {
    at_[0] = t;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      at_[1 + i] = inputs_[i].expression ? 0 : (*inputs_[i].signal)(within, within);
    return at_;
  }
  const std::vector<Sloped>& box(double a, double b) {
    at(a, (a + b) / 2);
    box_[0] = {{a, b}, {1, 1}};
    for (std::size_t i = 1; i < at_.size(); ++i) box_[i] = {{at_[i], at_[i]}, {0, 0}};
    return box_;
  }

  void find_kink(Ref r) {
    const Node& node = dag_[r];
    const bool one = node.op == symbolic::Op::abs || node.op == symbolic::Op::sign;
    std::vector<Ref> surface{node.args[0]};
    if (!one) surface.push_back(node.args[1]);
    int depends = 0;
    for (const Ref operand : surface) depends = std::max(depends, depends_(operand));
    if (depends != 1 || std::find(surfaces_.begin(), surfaces_.end(), surface) != surfaces_.end()) return;
    surfaces_.push_back(surface);
    RangeCode code = code_of(surface);
    if (!code.complete()) return;
    std::vector<Break> found;
    std::size_t boxes = 0;
    for_each_piece([&](double a, double b) { find_roots(code, surface.size(), a, b, found, boxes); });
    cuts_.insert(cuts_.end(), found.begin(), found.end());
    tidy(cuts_);
  }

  void find_roots(RangeCode& code, std::size_t operands, double from, double to, std::vector<Break>& found,
                  std::size_t& boxes) {
    const double middle = (from + to) / 2;
    code.hold(at(middle, middle));
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
        tell(a);
        return;
      }
      Sloped g = code.range(box(a, b), 0);
      if (operands == 2) {
        const Sloped other = code.range(box_, 1);
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
          found.push_back(between(value, a, left, b));
        else if (left == 0 && a > from)
          around(value, a, found);
        continue;
      }
      if (g.value.is(0)) continue;
      open.push_back({m, b});  // the earlier half is looked at first
      open.push_back({a, m});
    }
  }

  /// A root on the border of two boxes: where the function has a sign on both sides, and another one.
  template <class Value>
  void around(const Value& value, double t, std::vector<Break>& found) const {
    const Break b = clear_of(value, t);
    if (value(b.before) * value(b.after) < 0) found.push_back(b);
  }

  template <class Value>
  static Break clear_of(const Value& value, double t) {
    Break b{t, t};
    for (int i = 0; i < 64 && value(b.before) == 0; ++i)
      b.before = std::nextafter(b.before, -std::numeric_limits<double>::infinity());
    for (int i = 0; i < 64 && value(b.after) == 0; ++i)
      b.after = std::nextafter(b.after, std::numeric_limits<double>::infinity());
    return b;
  }

  /// Where a sign changes, to the last digit.
  template <class Value>
  static Break between(const Value& value, double a, double left, double b) {
    while (true) {
      const double m = a + (b - a) / 2;
      if (!(m > a && m < b)) return {a, b};
      const double v = value(m);
      if (v == 0) return clear_of(value, m);
      (v * left > 0 ? a : b) = m;
    }
  }

  void tell(double t) {
    if (!unfollowed_from_) unfollowed_from_ = t;
  }

  /// The largest expressions of time alone that something else uses, or that are part of the equations themselves.
  void find_bounds(const std::vector<Ref>& roots) {
    std::vector<bool> wanted(dag_.size(), false);
    for (const Ref r : roots) wanted[r.id] = wanted[r.id] || depends_(r) == 1;
    for (const Ref r : dag_.reachable(roots)) {
      if (depends_(r) != 2) continue;
      const Node& node = dag_[r];
      for (std::size_t k = 0; k < node.arity; ++k)
        wanted[node.args[k].id] = wanted[node.args[k].id] || depends_(node.args[k]) == 1;
    }
    std::vector<Ref> functions;
    for (const Ref r : depends_.seen()) {
      if (!wanted[r.id]) continue;
      const bool input = dag_[r].op == symbolic::Op::symbol && dag_.symbol_of(r).kind == SymbolKind::input;
      functions.push_back(input ? *inputs_[dag_.symbol_of(r).index].expression : r);
    }
    for (const Ref f : functions) {
      for (const Ref term : terms(f)) bound(term);
    }
    const auto narrow =
        std::min_element(bounds_.begin(), bounds_.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
    if (narrow == bounds_.end() || narrow->step >= (t1_ - t0_) / 2) bounds_.clear();
  }

  /// What is added up is looked at term by term: a sum bounds its terms worse than these (sin^2 + cos^2), and a pulse
  /// beside a large constant is one.
  std::vector<Ref> terms(Ref sum) {
    std::vector<Ref> open{sum}, result;
    while (!open.empty()) {
      const Ref r = open.back();
      open.pop_back();
      if (depends_(r) != 1 || !seen_terms_.insert(r.id).second) continue;
      const Node& node = dag_[r];
      using symbolic::Op;
      if (node.op == Op::symbol && dag_.symbol_of(r).kind == SymbolKind::input) {
        open.push_back(*inputs_[dag_.symbol_of(r).index].expression);
        continue;
      }
      const bool scaled = (node.op == Op::mul && (depends_(node.args[0]) == 0 || depends_(node.args[1]) == 0)) ||
                          (node.op == Op::div && depends_(node.args[1]) == 0);
      if (node.op != Op::add && node.op != Op::sub && node.op != Op::neg && !scaled) {
        result.push_back(r);
        continue;
      }
      for (std::size_t k = 0; k < node.arity; ++k) open.push_back(node.args[k]);
    }
    return result;
  }

  void bound(Ref function) {
    RangeCode code = code_of({function});
    if (!code.complete()) return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto see = [&](double v) {
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    };
    const auto cell = [&](double a, double b) {
      const double m = a + (b - a) / 2;
      code.hold(at(m, m));
      for (const double t : {a, m, b}) see(code.value(at(t, m)));
      const Sloped f = code.range(box(a, b));
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
    std::vector<eom::StepBound> own;
    for (const Cell& c : done) {
      const double step = steps_per_cell * (c.b - c.a);
      if (own.empty() || own.back().step != step) own.push_back({c.a, step});
    }
    bounds_ = lower_of(bounds_, own);
  }

  /// The lower of two bounds, everywhere.
  static std::vector<eom::StepBound> lower_of(const std::vector<eom::StepBound>& a,
                                              const std::vector<eom::StepBound>& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    std::vector<eom::StepBound> result;
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

  const system::EquationSystem& system_;
  const Dag& dag_;
  const std::vector<double>& parameters_;
  const std::vector<ClockInput>& inputs_;
  double t0_, t1_;
  Dependence depends_;
  std::vector<Break> cuts_;
  std::vector<std::vector<Ref>> surfaces_;
  std::set<std::uint32_t> seen_terms_;
  std::vector<eom::StepBound> bounds_;
  std::optional<double> unfollowed_from_;
  std::vector<double> at_;
  std::vector<Sloped> box_;
};

}  // namespace

Clock look_at_time(const system::EquationSystem& system, const std::vector<double>& parameters,
                   const std::vector<ClockInput>& inputs, double t0, double t1) {
  return Search(system, parameters, inputs, t0, t1).run();
}

}  // namespace eomgen::run
