// SPDX-License-Identifier: MIT
// The members of Integration that act at the surface of a kink: the state crosses it, begins to slide along it, or
// leaves it. In: the crossing. Out: the sides of the kinks, events.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE EventAction Integration::change_side(const EventPoint& point, std::size_t kink,
                                                        const OnEvent& event) {
  Model& model = context_.model;
  const std::vector<std::size_t> before = model.sliding_kinks();
  if (model.is_sliding(kink)) {
    model.end_sliding(kink, point.t, point.x.data());
  } else if (context_.may_slide && model.begin_sliding(kink, point.t, point.x.data())) {
    if (model.correct_sliding(point.t, point.x.data()) != 0) model.end_sliding(kink, point.t, point.x.data());
  } else {
    context_.kinks.flip_branch(point.t, kink, point.crossing.up);
  }
  model.end_invalid_sliding(point.t, point.x.data());
  report_sliding(before, point.t, point.x, event);
  return before == model.sliding_kinks() ? EventAction::resume : EventAction::restart;
}

/// Reports the surfaces along which the state began or ended to slide. before: those before.
EOM_RUNTIME_INLINE void Integration::report_sliding(const std::vector<std::size_t>& before, double t,
                                                    std::span<const double> x, const OnEvent& event) {
  const std::vector<std::size_t>& now = context_.model.sliding_kinks();
  if (!event || before == now) return;
  const auto report = [&](const char* kind, std::size_t k) { event({t, kind, problem_.code->kinks[k]}, x); };
  for (const std::size_t k : before)
    if (!context_.model.is_sliding(k)) report("slide_end", k);
  for (const std::size_t k : now)
    if (std::find(before.begin(), before.end(), k) == before.end()) report("slide", k);
}

}  // namespace eom::hybrid
