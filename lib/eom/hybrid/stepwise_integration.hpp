// SPDX-License-Identifier: MIT
// An integration that is continued in pieces, with changes of inputs, parameters and the state in between: what
// StepwiseRun hides. Compiled where the code of runs is (compiled_runtime.hpp). In: a Problem. Out: as
// stepwise_run.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/compiled_runtime.hpp"
#include "eom/hybrid/integration.hpp"
#include "eom/hybrid/run_options.hpp"
#include "eom/hybrid/samples.hpp"
#include "eom/hybrid/stepwise_modes.hpp"
#include "eom/hybrid/stepwise_run.hpp"
#include "eom/hybrid/time_analysis.hpp"

namespace eom::hybrid {

/// What StepwiseRun hides.
class StepwiseIntegration {
 public:
  using Piece = StepwiseRun::Piece;
  using State = StepwiseRun::State;

  explicit StepwiseIntegration(Problem problem);
  StepwiseIntegration(const StepwiseIntegration&) = delete;
  StepwiseIntegration& operator=(const StepwiseIntegration&) = delete;

  // As the functions of StepwiseRun.
  Result advance(double t_end, const Piece& piece);
  const Reason& reason() const { return reason_; }
  double t() const { return t_; }
  std::vector<double> state() const { return integration_->context().own_state(t_, x_); }
  int outputs(std::span<double> y);
  std::vector<double> inputs();
  std::span<const double> parameters() const { return problem_.parameters; }
  void set_input(std::size_t input, Signal signal);
  void set_parameters(std::span<const double> values);
  void restart(double t, std::span<const double> x, std::vector<bool> open);
  std::vector<double> gaps(double t, std::span<const double> x);
  State save() const;
  void restore(const State& from);

 private:
  void rebuild();
  void analyse_time(double t_end);
  double end_beyond_jump(double t_end) const;
  bool has_left_range(const StepView& view);
  void write_row(double t, const double* x);
  void write_rows(const StepView& view);

  Problem problem_;
  TimeFunctions functions_;  // of time
  bool functions_use_inputs_ = false;
  double span_;
  double analysed_until_;
  std::unique_ptr<Integration> integration_;
  double t_;
  std::vector<double> x_;
  bool begun_ = false;
  double next_step_ = 0, origin_;
  std::uint64_t next_row_ = 0;
  Reason reason_;
  std::vector<std::size_t> ranged_;  // coordinates with a range that is still monitored
  bool is_output_ranged_ = false;    // one of them is no component of the state
  std::vector<double> y_, between_;
};

inline StepwiseIntegration::StepwiseIntegration(Problem problem)
    : problem_(std::move(problem)),
      functions_(std::exchange(problem_.time, {})),
      span_(problem_.t1 - problem_.t0),
      analysed_until_(-std::numeric_limits<double>::infinity()),
      t_(problem_.t0),
      origin_(problem_.t0),
      y_(problem_.code->output_names.size()) {
  problem_.power.reset();
  problem_.estimate = false;
  evaluate_sample_times(problem_.samples, problem_.parameters);
  require_functions(problem_);
  for (const auto* tables : {&functions_.surfaces, &functions_.terms}) {
    for (const expressions::Table& table : *tables) {
      for (const expressions::Step& step : table.steps)
        functions_use_inputs_ = functions_use_inputs_ || (step.op == expressions::Op::variable && step.a[0] > 0);
    }
  }
  for (std::size_t i = 0; i < problem_.ranges.size(); ++i) {
    if (!std::isfinite(problem_.ranges[i].lower) && !std::isfinite(problem_.ranges[i].upper)) continue;
    ranged_.push_back(i);
    const std::vector<std::uint32_t>& free = problem_.code->free;
    is_output_ranged_ = is_output_ranged_ || std::find(free.begin(), free.end(), i) == free.end();
  }
  integration_ = std::make_unique<Integration>(problem_);
  x_ = integration_->context().own_start();
  between_.resize(x_.size());
}

/// Kinks in time and bounds on steps, until t_end at least.
inline void StepwiseIntegration::analyse_time(double t_end) {
  if (functions_.empty() || t_end <= analysed_until_) return;
  analysed_until_ = std::max(t_end, t_ + span_);
  TimeAnalysis found = analyse_time_functions(functions_, problem_.parameters, problem_.inputs, t_, analysed_until_);
  problem_.breakpoints = std::move(found.breakpoints);
  problem_.bounds = std::move(found.bounds);
}

/// A piece that would end within the two times of a kink ends after it: the next one would begin beyond its jump.
inline double StepwiseIntegration::end_beyond_jump(double t_end) const {
  for (const Breakpoint& b : problem_.breakpoints) {
    if (b.before <= t_end && t_end <= b.after && b.before > t_)
      return std::nextafter(b.after, std::numeric_limits<double>::infinity());
  }
  return t_end;
}

inline Result StepwiseIntegration::advance(double t_end, const Piece& piece) {
  reason_ = {};
  if (!(t_end > t_)) return {Outcome::done, t_, state(), {}, ""};
  analyse_time(t_end);
  problem_.t0 = t_;
  problem_.t1 = end_beyond_jump(t_end);
  problem_.interrupt = piece.interrupt;
  Options options = options_of(problem_);
  if (piece.one_step && options.fixed_step > 0) problem_.t1 = std::min(problem_.t1, t_ + options.fixed_step);
  if (options.fixed_step == 0) options.initial_step = next_step_;
  double longest = 0, from = t_;
  std::vector<double> before;
  bool left = false, stopped = false;
  const auto observe = [&](const StepView& view) {
    longest = std::max(longest, view.t1 - view.t0);
    if (!ranged_.empty() && has_left_range(view)) {
      left = true;
      from = view.t0;
      before.assign(view.x0.begin(), view.x0.end());
      return false;
    }
    write_rows(view);
    return !piece.one_step;
  };
  const auto record = [&](const Event& event, std::span<const double> x) {
    if (!is_recorded(event)) return;
    stopped = stopped || event.kind == "stop";
    if (piece.event) piece.event(event, x);
  };
  if (!begun_ && problem_.output_interval > 0) {
    write_row(t_, integration_->context().start.data());
    ++next_row_;
  }
  Result end =
      begun_ ? integration_->resume(x_, options, observe, record) : integration_->run(options, observe, record);
  if (!left) reason_ = integration_->reason();
  begun_ = true;
  if (left) {
    end.outcome = Outcome::chart_left;
    end.detail = sentence(reason_);
    end.t = from;
    end.x = before;
  } else if (piece.one_step && longest > 0 && end.outcome == Outcome::stopped_by_event && !stopped) {
    end.outcome = Outcome::done;
    end.detail.clear();
    reason_ = {};
  }
  t_ = end.t;
  x_ = end.x;
  if (options.fixed_step == 0 && longest > 0) next_step_ = std::max(end.next_step, longest);
  end.x = state();
  return end;
}

inline bool StepwiseIntegration::has_left_range(const StepView& view) {
  RunContext& context = integration_->context();
  if (is_output_ranged_) context.outputs(view.t1, view.x1.data(), y_);
  for (std::size_t k = 0; k < ranged_.size(); ++k) {
    const std::size_t i = ranged_[k];
    const auto coordinate = static_cast<std::uint32_t>(i);
    if (context.charts.has_exchanged(coordinate)) continue;
    const std::vector<std::uint32_t>& free = problem_.code->free;
    const auto place = std::find(free.begin(), free.end(), coordinate);
    const double q = place != free.end() ? view.x1[static_cast<std::size_t>(place - free.begin())] : y_[2 * i];
    const Range& range = problem_.ranges[i];
    if (q > range.lower && q < range.upper) continue;
    if (problem_.beyond_range && context.charts.second_charts() == 0 &&
        problem_.beyond_range(coordinate, view.t1, view.x1)) {
      ranged_.erase(ranged_.begin() + static_cast<std::ptrdiff_t>(k--));
      continue;
    }
    reason_ = {Reason::Kind::range, view.t0,    0, problem_.code->output_names[2 * i], i, view.t0, view.t1,
               range.lower,         range.upper};
    return true;
  }
  return false;
}

inline void StepwiseIntegration::write_row(double t, const double* x) {
  if (!problem_.row) return;
  integration_->context().outputs(t, x, y_);
  problem_.row(t, y_);
}

inline void StepwiseIntegration::write_rows(const StepView& view) {
  if (!(problem_.output_interval > 0)) return;
  while (true) {
    // Multiples of the interval are counted, so that the grid does not drift.
    const double t = origin_ + static_cast<double>(next_row_) * problem_.output_interval;
    if (t > view.t1) return;
    if (t == view.t1) {
      write_row(t, view.x1.data());
    } else {
      view.interpolate(t, between_);
      write_row(t, between_.data());
    }
    ++next_row_;
  }
}

inline int StepwiseIntegration::outputs(std::span<double> y) {
  RunContext& context = integration_->context();
  context.model.set_segment_time(std::nextafter(t_, std::numeric_limits<double>::infinity()));
  return context.outputs(t_, begun_ ? x_.data() : context.start.data(), y);
}

inline std::vector<double> StepwiseIntegration::inputs() {
  Model& model = integration_->context().model;
  model.set_segment_time(std::nextafter(t_, std::numeric_limits<double>::infinity()));
  const double* u = model.inputs(t_);
  return {u, u + problem_.inputs.size()};
}

inline void StepwiseIntegration::set_input(std::size_t input, Signal signal) {
  Signal& now = problem_.inputs.at(input);
  const bool both_tables =
      !now.times.empty() && !signal.times.empty() && is_time_dependent(now) == is_time_dependent(signal);
  now = std::move(signal);
  if (functions_use_inputs_) analysed_until_ = t_;
  if (!both_tables) rebuild();  // what the model keeps depends on the kind of its inputs, not on the values of tables
}

inline void StepwiseIntegration::set_parameters(std::span<const double> values) {
  const std::vector<Sample> before = problem_.samples;
  evaluate_sample_times(problem_.samples, values);
  problem_.parameters.assign(values.begin(), values.end());
  analysed_until_ = t_;
  rebuild();
  if (!begun_ || before.empty()) return;
  Integration::State modes = integration_->save();
  move_taken(modes.samples_taken, before, problem_.samples, t_);
  integration_->restore(t_, x_, modes);
}

/// Makes the components of the run anew, in the same state.
inline void StepwiseIntegration::rebuild() {
  problem_.t0 = t_;
  problem_.t1 = t_ + span_;
  if (!begun_) {
    integration_ = std::make_unique<Integration>(problem_);
    return;
  }
  const Integration::State modes = integration_->save();
  integration_ = std::make_unique<Integration>(problem_);
  integration_->restore(t_, x_, modes);
}

inline void StepwiseIntegration::restart(double t, std::span<const double> x, std::vector<bool> open) {
  problem_.start.assign(x.begin(), x.end());
  problem_.starts_open = std::move(open);
  problem_.t0 = t_ = t;
  problem_.t1 = t + span_;
  origin_ = t;
  next_row_ = 0;
  begun_ = false;
  next_step_ = 0;
  analysed_until_ = -std::numeric_limits<double>::infinity();
  integration_ = std::make_unique<Integration>(problem_);
  x_ = integration_->context().own_start();
}

inline std::vector<double> StepwiseIntegration::gaps(double t, std::span<const double> x) {
  RunContext& context = integration_->context();
  if (SolvedContacts* const solved = context.solved_contacts.get()) {
    std::vector<double> of_solved;
    for (std::size_t j = 0; j < solved->size(); ++j) of_solved.push_back(solved->gap(t, x.data(), j));
    return of_solved;
  }
  const std::vector<Contact>& contacts = problem_.code->contacts;
  std::vector<double> g(context.events.size()), result(contacts.size());
  if (contacts.empty()) return result;
  if (context.model.events_of(open_mode(contacts), t, x.data(), g.data()) != 0) return {};
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    if (contacts[j].unilateral) result[j] = g[context.events.first_contact() + contact_values * j + 3];
  }
  return result;
}

inline StepwiseRun::State StepwiseIntegration::save() const {
  return {t_,
          x_,
          begun_,
          next_step_,
          origin_,
          next_row_,
          problem_.inputs,
          problem_.parameters,
          std::make_shared<const StepwiseModes>(StepwiseModes{integration_->save()})};
}

inline void StepwiseIntegration::restore(const State& from) {
  t_ = from.t;
  x_ = from.x;
  begun_ = from.begun;
  next_step_ = from.next_step;
  origin_ = from.origin;
  next_row_ = from.next_row;
  problem_.inputs = from.inputs;
  problem_.parameters = from.parameters;
  evaluate_sample_times(problem_.samples, problem_.parameters);
  problem_.t0 = t_;
  problem_.t1 = t_ + span_;
  analysed_until_ = -std::numeric_limits<double>::infinity();
  if (!begun_) problem_.start.assign(x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(x_.size()));
  integration_ = std::make_unique<Integration>(problem_);
  if (begun_) integration_->restore(t_, x_, *from.modes);
}

EOM_RUNTIME_INLINE StepwiseRun::StepwiseRun(Problem problem, RuntimeLayout)
    : run_(std::make_unique<StepwiseIntegration>(std::move(problem))) {}
EOM_RUNTIME_INLINE StepwiseRun::~StepwiseRun() = default;
EOM_RUNTIME_INLINE Result StepwiseRun::advance(double t_end, const Piece& piece) { return run_->advance(t_end, piece); }
EOM_RUNTIME_INLINE const Reason& StepwiseRun::reason() const { return run_->reason(); }
EOM_RUNTIME_INLINE double StepwiseRun::t() const { return run_->t(); }
EOM_RUNTIME_INLINE std::vector<double> StepwiseRun::state() const { return run_->state(); }
EOM_RUNTIME_INLINE int StepwiseRun::outputs(std::span<double> y) { return run_->outputs(y); }
EOM_RUNTIME_INLINE std::vector<double> StepwiseRun::inputs() { return run_->inputs(); }
EOM_RUNTIME_INLINE std::span<const double> StepwiseRun::parameters() const { return run_->parameters(); }
EOM_RUNTIME_INLINE void StepwiseRun::set_input(std::size_t input, Signal signal) {
  run_->set_input(input, std::move(signal));
}
EOM_RUNTIME_INLINE void StepwiseRun::set_parameters(std::span<const double> values) { run_->set_parameters(values); }
EOM_RUNTIME_INLINE void StepwiseRun::restart(double t, std::span<const double> x, std::vector<bool> open) {
  run_->restart(t, x, std::move(open));
}
EOM_RUNTIME_INLINE std::vector<double> StepwiseRun::gaps(double t, std::span<const double> x) {
  return run_->gaps(t, x);
}
EOM_RUNTIME_INLINE StepwiseRun::State StepwiseRun::save() const { return run_->save(); }
EOM_RUNTIME_INLINE void StepwiseRun::restore(const State& from) { run_->restore(from); }

}  // namespace eom::hybrid
