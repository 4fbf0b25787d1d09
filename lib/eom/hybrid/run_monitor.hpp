// SPDX-License-Identifier: MIT
// Quantities monitored after every step of a run (invariants, power balance, constraints, ranges of coordinates), and
// the output of rows. In: accepted steps, events. Out: rows through the callback, the monitored results at the end.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/run_context.hpp"
#include "eom/hybrid/run_result.hpp"
#include "eom/watch/drift.hpp"

namespace eom::hybrid {

/// Writes a row at multiples of the interval, at parts of it where steps are shorter, at recorded events, and at the
/// end.
class RowWriter {
 public:
  /// Both must outlive this object.
  RowWriter(const Problem& problem, RunContext& context)
      : problem_(problem), context_(context), y_(problem.code->output_names.size()), between_(problem.states()) {}

  /// Whether the problem asks for rows.
  bool any() const { return problem_.output_interval > 0; }

  /// Writes the rows of a step. Returns the time of the last row if the run was interrupted meanwhile and ends there.
  std::optional<double> write_until(const StepView& view) {
    const std::uint64_t parts = parts_of_interval(), stride = parts_between_rows(view);
    const double part = problem_.output_interval / static_cast<double>(parts);
    // Parts of the interval are counted, so that the grid does not drift. A last sliver belongs to the end.
    const auto time = [&](std::uint64_t n) { return problem_.t0 + static_cast<double>(n) * part; };
    std::uint64_t next = (written_ / stride + 1) * stride;
    while (next % parts != 0 && time(next) <= view.t0) next += stride;  // in earlier steps, which have fewer rows
    for (;; next += stride) {
      const double t = time(next);
      write_event_rows(std::min(t, view.t1));
      if (t > view.t1 || t > problem_.t1) return std::nullopt;
      if (t == last_) {
        // the row of an event has this time
      } else if (t == view.t1) {
        row(t, view.x1.data());
      } else {
        view.interpolate(t, between_);
        row(t, between_.data());
        if (problem_.interrupt != nullptr && problem_.interrupt->load(std::memory_order_relaxed)) return t;
      }
      written_ = next;
    }
  }

  /// Queues the row of an event until the remaining rows of its step are written.
  void event(double t, std::span<const double> x) { pending_.emplace_back(t, std::vector<double>(x.begin(), x.end())); }

  /// Writes one row.
  void row(double t, const double* x) { row(t, x, t); }
  /// at: the time at which functions of time are evaluated, which differs from t beside a kink in time.
  void row(double t, const double* x, double at) {
    if (!any() || !problem_.row) return;
    context_.outputs(at, x, y_);
    problem_.row(t, y_);
    last_ = t;
  }
  /// Time of the last row; NaN before the first one.
  double last() const { return last_; }
  const std::vector<double>& last_state() const { return between_; }  // at an interruption

 private:
  std::uint64_t parts_of_interval() const { return std::max<std::uint32_t>(1, problem_.row_subdivisions); }

  /// Parts of the interval from one row to the next: the spacing is at most the longest of the last steps. One short
  /// step, as at the start or after an event, changes nothing.
  std::uint64_t parts_between_rows(const StepView& view) {
    std::uint64_t stride = parts_of_interval();
    lengths_[steps_++ % lengths_.size()] = view.t1 - view.t0;
    if (steps_ < lengths_.size()) return stride;
    const double longest = *std::max_element(lengths_.begin(), lengths_.end());
    const double part = problem_.output_interval / static_cast<double>(parts_of_interval());
    while (stride > 1 && longest < static_cast<double>(stride) * part) stride /= 2;
    return stride;
  }

  void write_event_rows(double until) {
    std::size_t written = 0;
    for (; written < pending_.size() && pending_[written].first <= until; ++written) {
      if (pending_[written].first != last_) row(pending_[written].first, pending_[written].second.data());
    }
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(written));
  }

  const Problem& problem_;
  RunContext& context_;
  std::vector<double> y_, between_;
  std::vector<std::pair<double, std::vector<double>>> pending_;  // of the current step
  std::uint64_t written_ = 0;                                    // the last row, in parts of the interval
  std::array<double, 4> lengths_ = {};                           // of the last steps
  std::size_t steps_ = 0;
  double last_ = std::numeric_limits<double>::quiet_NaN();
};

/// Observes the accepted steps of a run: drift of invariants, power balance, ranges of coordinates, rows.
class RunMonitor {
 public:
  /// Observes the start and writes its row. Both must outlive this object.
  RunMonitor(const Problem& problem, RunContext& context)
      : problem_(problem),
        context_(context),
        rows_(problem, context),
        y_(problem.code->output_names.size()),
        last_(problem.invariants.size()),
        shift_(problem.invariants.size()) {
    for (const Invariant& invariant : problem.invariants) drifts_.emplace_back(invariant.name);
    const std::vector<double> x = context.start;
    observe(problem.begin(), x.data());
    rows_.row(problem.t0, x.data(), problem.begin());
  }

  /// Observes an accepted step. False: the run ends here.
  bool step(const StepView& view) {
    observe(view.t1, view.x1.data());
    if (has_left_range(view)) {
      set_end(view.t0, view.x0);
      return false;
    }
    if (const std::optional<double> t = rows_.any() ? rows_.write_until(view) : std::nullopt) {
      interrupted_ = true;
      set_end(*t, rows_.last_state());
      return false;
    }
    if (problem_.progress) problem_.progress((view.t1 - problem_.t0) / (problem_.t1 - problem_.t0));
    return true;
  }

  /// Records an event; a custom event also gets a row, a reset one before and one after it.
  void event(const Event& event, std::span<const double> x) {
    if (is_recorded(event)) events_.push_back(event);
    if (event.kind == "impulse") shift_invariants(event.t, x.data(), false);
    if (event.kind == "reset" || event.kind == "sample") shift_invariants(event.t, x.data(), true);
    if (rows_.any() && event.kind == "custom") rows_.event(event.t, x);
    if (event.kind == "reset" || (event.kind == "before_reset" && event.t != rows_.last()))
      rows_.row(event.t, x.data());
  }

  /// Ends the result with the previous step if a coordinate left its range, or with the last row if the run was
  /// interrupted between two rows. The end is the last row, unless it is already on the grid. at: the time at which
  /// functions of time are evaluated there. Returns that of the new end.
  double finish(Result& end, double at, Reason& reason) {
    if (interrupted_) {
      end.outcome = Outcome::interrupted;
      reason = {Reason::Kind::rows, end_t_};
    }
    if (left_) {
      end.outcome = Outcome::chart_left;
      reason = *left_;
    }
    if (interrupted_ || left_) {
      end.t = at = end_t_;
      end.x = end_x_;
    }
    if (rows_.any() && end.t != rows_.last()) rows_.row(end.t, end.x.data(), at);
    return at;
  }

  /// The largest change of the energy beyond the work, in the units of the energy.
  double energy_defect() const {
    double defect = problem_.power ? balance_.max_abs_defect() : 0;
    for (std::size_t i = 0; i < drifts_.size(); ++i) {
      if (problem_.invariants[i].output == problem_.energy) defect = std::max(defect, drifts_[i].max_abs_drift());
    }
    return defect;
  }

  void report(RunResult& result) const {
    result.events = events_;
    if (left_) {  // events in the step that left the range are discarded
      std::erase_if(result.events, [&](const Event& event) { return event.t > end_t_; });
    }
    for (const Drift& drift : drifts_) result.invariants.push_back({drift.initial(), drift.max_relative_drift()});
    result.power_balance = balance_.max_relative_defect();
    result.constraint_drift = defect_;
  }

 private:
  void set_end(double t, std::span<const double> x) {
    end_t_ = t;
    end_x_.assign(x.begin(), x.end());
  }

  void observe(double t, const double* x) {
    context_.outputs(t, x, y_);
    const double magnitude = std::abs(y_[problem_.kinetic]) + std::abs(y_[problem_.potential]);
    const std::span<const std::uint32_t> own = context_.charts.own_outputs();
    for (std::size_t i = 0; i < drifts_.size(); ++i) {
      const Invariant& invariant = problem_.invariants[i];
      // Near the singularity of the own chart its formulas are inaccurate.
      if (std::find(own.begin(), own.end(), invariant.output) != own.end()) continue;
      const double terms = invariant.magnitude ? y_[*invariant.magnitude] : 0;
      last_[i] = y_[invariant.output];
      drifts_[i].observe(y_[invariant.output] - shift_[i], invariant.output == problem_.energy ? magnitude : terms);
    }
    const double work = problem_.power ? x[problem_.code->layout().size()] : 0;
    balance_.observe(y_[problem_.energy] - context_.projection.work() - context_.impulse_work, work, magnitude);
    defect_ = std::max(defect_, context_.constraint_defect(t, x));
    for (const std::size_t i : problem_.redundant) defect_ = std::max(defect_, std::abs(y_[i]));
  }

  // An energy is conserved only between the impulses of supports; momenta are conserved through them. Resets change
  // every invariant.
  void shift_invariants(double t, const double* x, bool all) {
    context_.outputs(t, x, y_);
    for (std::size_t i = 0; i < drifts_.size(); ++i) {
      const double now = y_[problem_.invariants[i].output];
      if (all || problem_.invariants[i].energy) shift_[i] += now - last_[i];
      last_[i] = now;
    }
  }

  // The outputs begin with every coordinate, also eliminated ones, followed by its rate.
  bool has_left_range(const StepView& view) {
    for (std::size_t i = 0; i < problem_.ranges.size(); ++i) {
      const Range& range = problem_.ranges[i];
      const double q = y_[2 * i];
      if (context_.charts.has_exchanged(static_cast<std::uint32_t>(i))) continue;
      if (q > range.lower && q < range.upper) continue;
      if (std::find(beyond_.begin(), beyond_.end(), i) != beyond_.end()) continue;
      if (problem_.beyond_range && context_.charts.second_charts() == 0 &&
          problem_.beyond_range(static_cast<std::uint32_t>(i), view.t1, view.x1)) {
        beyond_.push_back(i);
        continue;
      }
      left_ = {Reason::Kind::range, view.t0,    0, problem_.code->output_names[2 * i], i, view.t0, view.t1,
               range.lower,         range.upper};
      return true;
    }
    return false;
  }

  const Problem& problem_;
  RunContext& context_;
  RowWriter rows_;
  std::vector<double> y_;
  std::vector<Drift> drifts_;
  std::vector<double> last_, shift_;  // of invariants: value at the end of the last step; change by impulses
  PowerBalance balance_;
  double defect_ = 0;
  std::vector<Event> events_;
  std::vector<std::size_t> beyond_;  // coordinates whose range the equations do not need
  std::optional<Reason> left_;
  bool interrupted_ = false;
  double end_t_ = 0;
  std::vector<double> end_x_;
};

}  // namespace eom::hybrid
