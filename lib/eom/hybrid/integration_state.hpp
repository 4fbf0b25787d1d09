// SPDX-License-Identifier: MIT
// The members of Integration that save what a run remembers, and continue another one from it.
#pragma once

#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

EOM_RUNTIME_INLINE Integration::State Integration::save() const {
  State state{{},
              {},
              context_.charts.save(),
              context_.kinks.largest_values(),
              context_.rows.integral_constants(),
              choice_,
              resets_.taken(),
              context_.model.sliding_kinks(),
              context_.events.save(),
              narrow_.save()};
  if (context_.solved_contacts) state.solved_contacts = context_.solved_contacts->save();
  if (context_.contacts) state.contacts = context_.contacts->save();
  return state;
}

EOM_RUNTIME_INLINE void Integration::restore(double t, const std::vector<double>& x, const State& from) {
  context_.charts.restore(from.charts, x.data());
  context_.model.set_code(context_.charts.code());
  context_.model.reset_mode();
  context_.model.set_charts(context_.charts.second_charts());
  context_.rows.set_charts(context_.charts.code(), context_.model.mode());
  context_.rows.set_integral_constants(from.integral_constants);
  context_.kinks.set_largest_values(from.largest_kink_values);
  context_.model.set_sliding(from.sliding);
  if (from.contacts) {
    context_.contacts->restore(*from.contacts);
    context_.model.set_contact_mode(from.contacts->mode);
  }
  if (from.solved_contacts) context_.solved_contacts->restore(*from.solved_contacts);
  context_.freeze_branches(t, x.data(), true);
  context_.events.restore(from.clearance);
  narrow_.restore(from.narrow);
  choice_ = from.choice;
  if (!from.samples_taken.empty()) resets_.set_taken(from.samples_taken);
}

}  // namespace eom::hybrid
