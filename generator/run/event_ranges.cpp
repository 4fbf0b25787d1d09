// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/event_ranges.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr std::size_t most_boxes = 300;  // of a function in a step
constexpr double shortest = 1e-7;        // of the step
constexpr double beyond = 0.05;          // of its width: what is not of second order within a box

}  // namespace

EventRanges::EventRanges(const system::EquationSystem& s, const std::vector<std::optional<symbolic::Ref>>& functions, const std::vector<double>& parameters)
    : states_(2 * s.free.size() + s.integrals.size()) {
  const std::size_t n = s.free.size();
  const auto lookup = [&](const Symbol& symbol) {
    if (symbol.kind == SymbolKind::time) return RangeCode::Leaf::of_variable(0);
    if (symbol.kind == SymbolKind::parameter) return RangeCode::Leaf::of(parameters[symbol.index]);
    if (symbol.kind == SymbolKind::side) return RangeCode::Leaf::of(0);
    if (symbol.kind == SymbolKind::input) {
      inputs_ = std::max<std::size_t>(inputs_, symbol.index + 1);
      return RangeCode::Leaf::of_variable(1 + states_ + symbol.index);
    }
    const auto place = std::find(s.free.begin(), s.free.end(), symbol.index);
    if (symbol.kind != SymbolKind::coordinate || symbol.order > 1 || place == s.free.end()) return RangeCode::Leaf{};
    return RangeCode::Leaf::of_variable(1 + symbol.order * n + static_cast<std::size_t>(place - s.free.begin()));
  };
  for (const std::optional<symbolic::Ref>& function : functions) {
    codes_.emplace_back();
    if (!function) continue;
    RangeCode code(*s.dag, {*function}, lookup);
    if (!code.complete()) continue;
    codes_.back() = std::move(code);
    any_ = true;
  }
}

void EventRanges::at(const eom::StepView& step, const Inputs& inputs, Place& place) const {
  const double t = place.s >= 1 ? step.t1 : step.t0 + place.s * (step.t1 - step.t0);
  x_.resize(step.x0.size());
  if (place.s <= 0) x_.assign(step.x0.begin(), step.x0.end());
  else if (place.s >= 1) x_.assign(step.x1.begin(), step.x1.end());
  else step.interpolate(t, x_);
  place.variables.assign(1, t);
  place.variables.insert(place.variables.end(), x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(states_));
  if (inputs_ == 0) return;
  const double* u = inputs(t);
  place.variables.insert(place.variables.end(), u, u + inputs_);
}

std::optional<std::pair<double, double>> EventRanges::first(const eom::StepView& step, std::size_t i, int side, double from, double to, const Inputs& inputs) const {
  if (i >= codes_.size() || !codes_[i] || !(to > from)) return std::nullopt;
  const RangeCode& code = *codes_[i];
  const auto inward = [&](const Place& place) { return side * code.value(place.variables); };
  std::vector<std::pair<Place, Place>> open(1);
  open[0].first.s = from, open[0].second.s = to;
  at(step, inputs, open[0].first);
  at(step, inputs, open[0].second);
  for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
    const auto [a, b] = std::move(open.back());
    open.pop_back();
    Place m{(a.s + b.s) / 2, {}};
    at(step, inputs, m);
    // Between three states: the control points of the parabola through them, and some more.
    box_.resize(a.variables.size());
    for (std::size_t v = 0; v < box_.size(); ++v) {
      const double x = a.variables[v], z = b.variables[v], control = 2 * m.variables[v] - (x + z) / 2;
      const double bend = beyond * std::max(std::abs(control - x), std::abs(z - control)), low = std::min(2 * (control - x), 2 * (z - control)),
                   high = std::max(2 * (control - x), 2 * (z - control));
      const double loose = v == 0 ? 0 : 4 * bend;
      box_[v] = {{std::min({x, z, control}) - bend, std::max({x, z, control}) + bend}, {low - loose, high + loose}};
    }
    Sloped g = code.range(box_);
    const double middle = code.value(m.variables);
    if (std::isfinite(g.slope.width())) g.value = common(g.value, Interval{middle, middle} + g.slope * Interval{-0.5, 0.5});
    if (side < 0) g = {-g.value, -g.slope};
    if (g.value.low > 0) continue;
    const bool start = a.s == from, rises = g.slope.low > 0;
    if (start && rises) continue;  // from a crossing, or the surface, inward
    if (b.s - a.s < shortest || g.slope.high < 0 || rises) {
      if (inward(b) < 0 && !(start && b.s - a.s < shortest)) return std::pair{a.s, b.s};
      continue;
    }
    open.emplace_back(m, b);
    open.emplace_back(a, m);
  }
  return std::nullopt;
}

}  // namespace eomgen::run
