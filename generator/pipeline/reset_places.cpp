// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/reset_places.hpp"

#include <algorithm>

namespace eomgen::pipeline {
namespace {

/// The places of the values of a reset in the array r of the function resets, from `next` on.
eom::hybrid::Reset placed(const system::Reset& reset, std::size_t& next) {
  eom::hybrid::Reset result;
  if (reset.condition) result.condition = next++;
  for (const system::Reset::Entry& entry : reset.set) result.set.push_back({entry.component, next++});
  return result;
}

}  // namespace

ResetPlaces reset_places(const DerivedModel& derived, const run::Scene& scene) {
  const system::EquationSystem& system = derived.candidates.front();
  ResetPlaces places;
  std::size_t next = 0;
  for (const system::Event& event : system.events) places.events.push_back(placed(event.reset, next));
  const auto component = [&](std::uint32_t state) {
    const auto found = std::find_if(system.states.begin(), system.states.end(),
                                    [&](const system::FirstOrderState& s) { return s.symbol.index == state; });
    return system.layout().first_order_begin() + static_cast<std::size_t>(found - system.states.begin());
  };
  for (std::size_t i = 0; i < system.samples.size(); ++i) {
    const model::Sample& sample = derived.model.samples[i];
    places.samples.push_back({sample.name, scene.samples[i].first, scene.samples[i].second, {}, {}});
    for (const model::Noise& noise : sample.noise)
      places.samples.back().noise.push_back(
          {component(noise.state), noise.distribution == model::Noise::Distribution::normal, noise.seed});
    places.samples.back().reset = placed(system.samples[i].reset, next);
  }
  return places;
}

}  // namespace eomgen::pipeline
