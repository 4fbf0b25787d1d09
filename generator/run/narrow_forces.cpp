// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/narrow_forces.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

using symbolic::Op;

constexpr std::size_t most_boxes = 200;  // of a function in a step
constexpr double shortest = 1e-9;        // of the step
constexpr double nothing = 1e-100;       // in the units of the function
constexpr double everything = 1e100;
constexpr double of_values = 1e-3;   // beyond the samples: what smooth functions do between them
constexpr double of_tolerance = 30;  // a path between the ends of a step is less accurate than these
constexpr double difference = 1e-3;  // of a width, for slopes of the path
constexpr double nearest = 1e-3;     // of a box
constexpr int high_power = 20;
constexpr int steep_power = 4;  // in a denominator: 1/(1 + x^2) still has tails that are seen

/// What is a bump of a function without tails, as itself, its slope or its inverse are; nothing of functions whose
/// tails the error control sees.
std::vector<symbolic::Ref> bumps(symbolic::Dag& dag, symbolic::Ref r) {
  const symbolic::Node node = dag[r];
  const auto steep = [&](symbolic::Ref part) { return dag[part].op == Op::power && dag[part].payload >= steep_power; };
  switch (node.op) {
    case Op::div: {
      const std::vector<symbolic::Ref> parts = dag.reachable({node.args[1]});
      if (std::none_of(parts.begin(), parts.end(), steep)) return {};
      return {dag.div(dag.one(), node.args[1])};
    }
    case Op::exp: return {r, dag.call(Op::exp, dag.neg(node.args[0]))};
    case Op::tanh: return {dag.sub(dag.one(), dag.power(r, 2))};
    case Op::cosh: return {dag.div(dag.one(), r)};
    case Op::sinh: return {dag.div(dag.one(), dag.add(dag.one(), dag.power(r, 2)))};
    case Op::pow: return {r};
    case Op::power: return node.payload >= high_power ? std::vector{r} : std::vector<symbolic::Ref>{};
    default: return {};
  }
}

}  // namespace

NarrowForces::NarrowForces(const system::EquationSystem& s, const std::vector<double>& parameters)
    : n_(s.free.size()), boxes_(s, parameters) {
  std::vector<symbolic::Ref> roots;
  for (const auto* part : {&s.M, &s.f, &s.A, &s.b, &s.gamma}) roots.insert(roots.end(), part->begin(), part->end());
  const auto of_state = [&s](symbolic::Ref r) {
    const std::vector<symbolic::Symbol> symbols = s.dag->symbols({r});
    return std::any_of(symbols.begin(), symbols.end(),
                       [](const symbolic::Symbol& symbol) { return symbol.kind == symbolic::SymbolKind::coordinate; });
  };
  for (const symbolic::Ref r : s.dag->reachable(roots)) {
    const std::vector<symbolic::Ref> found = bumps(*s.dag, r);
    if (found.empty() || !of_state(r)) continue;
    for (const symbolic::Ref bump : found) {
      if (std::optional<RangeCode> code = boxes_.code(bump)) codes_.push_back(std::move(*code));
    }
  }
}

double NarrowForces::longest(const eom::StepView& step, const Setting& setting) const {
  const double h = std::abs(step.t1 - step.t0);
  double first = 1;
  for (const RangeCode& code : codes_) first = std::min(first, hidden(code, step, setting).value_or(1));
  if (first < 1) return first * h;
  if (setting.series && unsatisfied(step, setting, 1, 1)) return h / 2;
  return std::numeric_limits<double>::infinity();
}

/// Where a function has a value that no sample of the step has, and the equations are not satisfied.
std::optional<double> NarrowForces::hidden(const RangeCode& code, const eom::StepView& step,
                                           const Setting& setting) const {
  const auto bounded = [](double v) { return std::clamp(v, -everything, everything); };
  const auto value = [&](const StepPlace& at) { return bounded(code.value(at.variables)); };
  std::vector<std::pair<StepPlace, StepPlace>> open(1);
  open[0].second.s = 1;
  for (StepPlace* at : {&open[0].first, &open[0].second}) boxes_.place(step, setting.inputs, *at);
  // The ends alone are what every method sees.
  Interval seen = hull({value(open[0].first), value(open[0].first)}, {value(open[0].second), value(open[0].second)});
  for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
    const auto [a, b] = std::move(open.back());
    open.pop_back();
    StepPlace m{(a.s + b.s) / 2, {}};
    boxes_.place(step, setting.inputs, m);
    const double middle = value(m), width = b.s - a.s;
    Sloped range = code.range(boxes_.box(a, m, b));
    if (std::isfinite(range.slope.width()))
      range.value = common(range.value, Interval{middle, middle} + range.slope * Interval{-0.5, 0.5});
    range.value = {bounded(range.value.low), bounded(range.value.high)};
    const double room =
        std::max({seen.width(), of_values * std::max(std::abs(seen.low), std::abs(seen.high)), nothing});
    const auto shown = [&](double v) { return v >= seen.low - room && v <= seen.high + room; };
    if (shown(range.value.low) && shown(range.value.high)) continue;
    if (!shown(middle)) {
      if (unsatisfied(step, setting, m.s, width)) return m.s;
      // A bump has no slope at its top: its sides, however steep they are.
      for (double beside = width / 4; beside > width * nearest; beside /= 4) {
        if (unsatisfied(step, setting, m.s - beside, beside) || unsatisfied(step, setting, m.s + beside, beside))
          return m.s - beside;
      }
      seen = hull(seen, {middle, middle});
    }
    if (width < shortest) continue;
    open.emplace_back(m, b);
    open.emplace_back(a, m);
  }
  if (!open.empty() && !unsure_) unsure_ = step.t0;
  return std::nullopt;
}

/// Whether the accelerations of the step's path at s differ from those of the equations by more than tolerances allow,
/// if they do so for `width` of the step.
bool NarrowForces::unsatisfied(const eom::StepView& step, const Setting& setting, double s, double width) const {
  const double h = step.t1 - step.t0, reach = difference * width, from = std::max(0.0, s - reach),
               to = std::min(1.0, s + reach);
  for (std::vector<double>* x : {&x_, &before_, &after_, &dx_}) x->resize(step.x0.size());
  const auto state = [&](double at, std::vector<double>& x) {
    if (at >= 1)
      x.assign(step.x1.begin(), step.x1.end());
    else
      step.interpolate(step.t0 + at * h, x);
  };
  state(s, x_);
  state(from, before_);
  state(to, after_);
  if (setting.derivative(step.t0 + s * h, x_.data(), dx_.data()) != 0) return true;
  for (std::size_t i = n_; i < 2 * n_; ++i) {
    const double slope = (after_[i] - before_[i]) / ((to - from) * h);
    // Of a one-sided difference the path's own curvature is taken for a part of it.
    const double size = std::max(std::abs(step.x0[i]), std::abs(step.x1[i]));
    const double bend = from < s && to > s ? 0 : difference * std::abs(step.x1[i] - step.x0[i]);
    if (!(std::abs(dx_[i] - slope) * width * std::abs(h) <= of_tolerance * (setting.atol + setting.rtol * size) + bend))
      return true;
  }
  return false;
}

}  // namespace eomgen::run
