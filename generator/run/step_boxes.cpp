// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/step_boxes.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr double beyond = 0.05;  // of its width: what is not of second order within a box

}  // namespace

StepBoxes::StepBoxes(const system::EquationSystem& s, const std::vector<double>& parameters)
    : system_(&s), parameters_(parameters), states_(2 * s.free.size() + s.integrals.size()) {}

std::optional<RangeCode> StepBoxes::code(symbolic::Ref expression) {
  using symbolic::SymbolKind;
  const std::vector<std::uint32_t>& free = system_->free;
  RangeCode code(*system_->dag, {expression}, [&](const symbolic::Symbol& symbol) {
    if (symbol.kind == SymbolKind::time) return RangeCode::Leaf::of_variable(0);
    if (symbol.kind == SymbolKind::parameter) return RangeCode::Leaf::of(parameters_[symbol.index]);
    if (symbol.kind == SymbolKind::side) return RangeCode::Leaf::of(0);
    if (symbol.kind == SymbolKind::input) {
      inputs_ = std::max<std::size_t>(inputs_, symbol.index + 1);
      return RangeCode::Leaf::of_variable(1 + states_ + symbol.index);
    }
    const auto place = std::find(free.begin(), free.end(), symbol.index);
    if (symbol.kind != SymbolKind::coordinate || symbol.order > 1 || place == free.end()) return RangeCode::Leaf{};
    return RangeCode::Leaf::of_variable(1 + symbol.order * free.size() +
                                        static_cast<std::size_t>(place - free.begin()));
  });
  if (!code.complete()) return std::nullopt;
  return code;
}

void StepBoxes::place(const eom::StepView& step, const Inputs& inputs, StepPlace& place) const {
  const double t = place.s >= 1 ? step.t1 : step.t0 + place.s * (step.t1 - step.t0);
  x_.resize(step.x0.size());
  if (place.s <= 0)
    x_.assign(step.x0.begin(), step.x0.end());
  else if (place.s >= 1)
    x_.assign(step.x1.begin(), step.x1.end());
  else
    step.interpolate(t, x_);
  place.variables.assign(1, t);
  place.variables.insert(place.variables.end(), x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(states_));
  if (inputs_ == 0) return;
  const double* u = inputs(t);
  place.variables.insert(place.variables.end(), u, u + inputs_);
}

const std::vector<Sloped>& StepBoxes::box(const StepPlace& a, const StepPlace& m, const StepPlace& b) const {
  box_.resize(a.variables.size());
  for (std::size_t v = 0; v < box_.size(); ++v) {
    const double x = a.variables[v], z = b.variables[v], control = 2 * m.variables[v] - (x + z) / 2;
    const double bend = beyond * std::max(std::abs(control - x), std::abs(z - control)),
                 low = std::min(2 * (control - x), 2 * (z - control)),
                 high = std::max(2 * (control - x), 2 * (z - control));
    const double loose = v == 0 ? 0 : 4 * bend;
    box_[v] = {{std::min({x, z, control}) - bend, std::max({x, z, control}) + bend}, {low - loose, high + loose}};
  }
  return box_;
}

}  // namespace eomgen::run
