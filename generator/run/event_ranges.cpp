// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/event_ranges.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr std::size_t most_boxes = 300;  // of a function in a step
constexpr double shortest = 1e-7;        // of the step

}  // namespace

EventRanges::EventRanges(const system::EquationSystem& s, const std::vector<std::optional<symbolic::Ref>>& functions,
                         const std::vector<double>& parameters)
    : boxes_(s, parameters) {
  for (const std::optional<symbolic::Ref>& function : functions) {
    codes_.push_back(function ? boxes_.code(*function) : std::nullopt);
    any_ = any_ || codes_.back();
  }
}

std::optional<std::pair<double, double>> EventRanges::first(const eom::StepView& step, std::size_t i, int side,
                                                            double from, double to,
                                                            const StepBoxes::Inputs& inputs) const {
  if (i >= codes_.size() || !codes_[i] || !(to > from)) return std::nullopt;
  const RangeCode& code = *codes_[i];
  const auto inward = [&](const StepPlace& place) { return side * code.value(place.variables); };
  std::vector<std::pair<StepPlace, StepPlace>> open(1);
  open[0].first.s = from, open[0].second.s = to;
  boxes_.place(step, inputs, open[0].first);
  boxes_.place(step, inputs, open[0].second);
  for (std::size_t boxes = 0; !open.empty() && boxes < most_boxes; ++boxes) {
    const auto [a, b] = std::move(open.back());
    open.pop_back();
    StepPlace m{(a.s + b.s) / 2, {}};
    boxes_.place(step, inputs, m);
    Sloped g = code.range(boxes_.box(a, m, b));
    const double middle = code.value(m.variables);
    if (std::isfinite(g.slope.width()))
      g.value = common(g.value, Interval{middle, middle} + g.slope * Interval{-0.5, 0.5});
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
