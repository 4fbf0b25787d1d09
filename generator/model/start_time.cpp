// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/start_time.hpp"

#include <algorithm>

#include "model/units.hpp"

namespace eomgen::model {
namespace {

std::string free_name(const Model& model, std::string name) {
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
  };
  while (taken(model.parameters) || taken(model.functions) || taken(model.inputs) || taken(model.coordinates) ||
         taken(model.definitions) || taken(model.places) || taken(model.frames) || taken(model.constraints) ||
         taken(model.forces) || taken(model.events) || taken(model.states)) {
    name += '_';
  }
  return name;
}

}  // namespace

void name_start_values(Model& model) {
  for (Parameter& p : model.parameters) {
    if (!p.initial_value_of) continue;
    const Coordinate& q = model.coordinates[*p.initial_value_of];
    std::string name;
    std::swap(name, p.name);  // its own name must not count as taken
    p.name = free_name(model, name);
    p.unit = q.unit;
    p.note = "start value of " + q.name;
    if (!q.tex.empty()) p.tex = "{" + q.tex + "}^{0}";
  }
}

void name_integrals(Model& model) {
  std::size_t number = 0;
  for (State& state : model.states) {
    if (state.integral || state.name.empty()) state.name = free_name(model, "integral_" + std::to_string(++number));
  }
}

void add_start_time(Model& model, bool units_stated) {
  const auto first =
      std::find_if(model.states.begin(), model.states.end(), [](const State& state) { return state.integral; });
  if (first == model.states.end()) return;
  Parameter start;
  start.name = free_name(model, "t_start");
  start.value = model.scenes.front().t0;
  if (units_stated) start.unit = unit_of(dimension_of("s"));
  start.tex = "t_{0}";
  start.note = "start of the run, from which integrals count";
  start.span = first->span;
  start.used = true;
  const auto index = static_cast<std::uint32_t>(model.parameters.size());
  model.parameters.push_back(std::move(start));
  model.start_time = index;
  for (Scene& scene : model.scenes) scene.parameters.emplace_back(index, scene.t0);
}

}  // namespace eomgen::model
