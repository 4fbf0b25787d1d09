// SPDX-License-Identifier: MIT
// The member of Integration that integrates one segment, to its end or to an earlier end of the run. Included by
// integration.hpp.
#pragma once

#include "eom/hybrid/integration.hpp"

namespace eom::hybrid {

#ifndef EOM_HYBRID_INTEGRATION_HERE
inline
#endif
    void
    Integration::integrate_until(double end, Options options, const Observer& observer, const OnEvent& event,
                                 Result& total) {
  const Motion f{context_, keeps_constraints_};
  const BoundedEvents g{context_, sampling_};
  const auto observe = [&](const StepView& step) {
    return observe_step(step, observer, event, options.fixed_step > 0);
  };
  const auto at = [&](const EventPoint& point) { return handle_event(point, event); };
  const auto after = [this](double t, double* x) {
    if (context_.rows.size() > 0 && !keeps_constraints_) {
      if (const int code = context_.projection(t, x); code != 0) return code;
    }
    return context_.model.correct_sliding(t, x);
  };
  stalled_restarts_ = 0;
  singularity_step_length_ = 0;
  while (true) {
    const std::vector<std::size_t> sliding = context_.model.sliding_kinks();
    context_.freeze_branches(total.t, total.x.data(), true);
    report_sliding(sliding, total.t, total.x, event);
    exchange_due_ = false;
    if (slow_slip_.must_switch(total.t, total.x.data())) slow_slip_.toggle();
    const double begin = total.t, length = singularity_step_length_;
    is_crossing_singularity_ = step_over_singularity(total, end, options, total.statistics.rhs_evaluations);
    Options now = slow_slip_.is_active() ? slow_slip_.refined_options(options) : options;
    if (is_crossing_singularity_) now.fixed_step = std::abs(length), now.events_at_end = false;
    const std::string method = is_crossing_singularity_ ? SingularityStep::solver
                               : slow_slip_.is_active() ? Automatic::name
                                                        : problem_.solver.c_str();
    const Result part = integrate_events(method, f, total.t, total.x, is_crossing_singularity_ ? total.t + length : end,
                                         now, g, context_.events.watched(), at, observe, after);
    if (!continue_after_event(part, begin, end, event, total)) return;
    options.initial_step = std::abs(last_step_);
    options.max_steps -= std::min(options.max_steps, part.statistics.steps + part.statistics.rejected);
  }
}

}  // namespace eom::hybrid
