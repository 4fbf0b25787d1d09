// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/automatic.hpp>
#include <eom/ensemble/integrate.hpp>
#include <eom/hybrid/balance.hpp>
#include <eom/hybrid/event_ranges.hpp>
#include <eom/ode.hpp>
#include <limits>
#include <memory>
#include <mutex>

#include "emit/targets.hpp"
#include "error.hpp"
#include "pipeline/bound_run.hpp"
#include "pipeline/graph_trimmer.hpp"
#include "run/monitored_functions.hpp"
#include "work.hpp"

namespace eomgen::pipeline {
namespace {

// A run with a larger energy error is repeated as a separate run, which monitors the energy after every step. The limit
// of a run without an error estimate is ten times as large.
constexpr double doubtful_energy = eom::hybrid::balance::without_estimate / 10;

emit::LoadedBatch compile_batch(const Simulation& first) {
  DerivedModel& derived = *first.derived;
  const run::Scene defaults =
      run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene("default"), {});
  const emit::EmissionContext context = emission_context(derived, first.program, defaults, first.certificate);
  std::vector<std::pair<std::string, std::string>> files;
  for (const emit::EmittedFile& file : emit::emit(first.program, context, "batch"))
    files.emplace_back(file.name, file.text);
  const work::DeferInterrupt heeded;  // the wait for the compiler handles an interrupt itself
  return emit::compile_and_load_batch(files, emit::mangled_id(context.id), &work::stop_flag());
}

bool stands_still(const run::Scene& scene) {
  const auto still = [](const run::Signal& signal) { return !signal.is_varying() && signal.knots().empty(); };
  return std::all_of(scene.inputs.begin(), scene.inputs.end(), still) && scene.jumps.functions.empty() &&
         scene.clock.bounds.empty() && scene.clock.breakpoints.empty();
}

/// Whether a coordinate has a range and varies; an eliminated coordinate with equal values at unrelated states is
/// constant.
std::string ranged(const Simulation& first, const run::Code& code) {
  const run::Scene& scene = first.scene;
  const std::size_t n = code.free.size();
  std::vector<double> u;
  for (const run::Signal& input : scene.inputs) u.push_back(input(scene.t0, scene.t0));
  std::vector<double> here(code.output_names.size()), there(here.size());
  const auto at = [&](double away, std::vector<double>& y) {
    std::vector<double> x(code.layout().size());
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = scene.q[code.free[i]] + away * (0.37 + 0.11 * static_cast<double>(i));
      x[n + i] = scene.qdot[code.free[i]] - away * (0.23 + 0.07 * static_cast<double>(i));
    }
    return code.outputs(scene.t0 + away, x.data(), scene.parameters.data(), u.data(), 0, y.data()) == 0;
  };
  const bool known = at(0, here) && at(0.7, there);
  for (std::size_t i = 0; i < scene.lower.size(); ++i) {  // outputs begin with every coordinate and its rate
    if (!std::isfinite(scene.lower[i]) && !std::isfinite(scene.upper[i])) continue;
    if (!known || here[2 * i] != there[2 * i]) return first.derived->model.coordinates[i].name;
  }
  return "";
}

class Runs {
 public:
  Runs(const Simulation& first, const emit::LoadedBatch* batch, const EnsembleRequest& asked)
      : first_(first),
        asked_(asked),
        graph_(first),
        code_(first.code.code_for_run()),
        batch_(batch),
        how_(asked.runs.size(), How::together),
        energy_(asked.runs.size()) {
    states_ = 2 * code_.free.size();
    p_ = first.scene.parameters.size();
    w_ = batch_ != nullptr && batch_->rhs_prepared != nullptr ? code_.prepared : 0;
    u_ = first.scene.inputs.size();
    const auto place = [&](const char* name) {
      return static_cast<std::size_t>(std::find(code_.output_names.begin(), code_.output_names.end(), name) -
                                      code_.output_names.begin());
    };
    for (std::size_t i = 0; i < first.derived->model.events.size(); ++i) {
      const model::Event::Direction direction = first.derived->model.events[i].direction;
      events_.push_back({direction == model::Event::Direction::up     ? eom::Direction::up
                         : direction == model::Event::Direction::down ? eom::Direction::down
                                                                      : eom::Direction::any,
                         first.scene.ends_run[i] ? eom::Watch::breaking : eom::Watch::passing});
    }
    if (!events_.empty()) {
      ranges_.resize(how_.size());
    }
    kinetic_ = place("kinetic");
    potential_ = place("potential");
    const auto& conserved = first.derived->conserved;
    watches_energy_ = std::any_of(conserved.begin(), conserved.end(), [](const conservation::ConservedQuantity& c) {
      return c.kind == system::OutputKind::energy;
    });
  }

  /// Whether the method of the scene can integrate members side by side.
  static bool wants_lanes(const run::Scene& scene) {
    return eom::ensemble::has_lanes<Lanes>(scene.solver, options_of(scene));
  }

  void run() {
    const run::Scene& scene = first_.scene;
    eom::EnsembleOptions options = options_of(scene);
    if (!has_lanes(scene)) return one_by_one();
    if (scene.max_step > 0) options.max_step = scene.max_step;
    if (scene.step > 0) options.max_steps = std::numeric_limits<std::size_t>::max();
    options.interrupt = asked_.interrupt;
    options.threads = asked_.threads;
    const auto start = [this](std::size_t member, eom::EnsembleStart& at) { begin(member, at); };
    const auto done = [this](const eom::EnsembleEnd& end) { finish(end); };
    const std::size_t rows = p_ + w_ + u_;
    if (events_.empty())
      eom::integrate_ensemble(scene.solver, Lanes{*this}, how_.size(), states_, rows, options, start, done);
    else
      eom::integrate_ensemble_events(
          scene.solver, Lanes{*this}, how_.size(), states_, rows, options, events_,
          [](std::size_t, const eom::EventPoint&) {}, start, done);
  }

 private:
  static eom::EnsembleOptions options_of(const run::Scene& scene) {
    eom::EnsembleOptions options;
    options.rtol = scene.rtol;
    options.atol = scene.atol;
    options.fixed_step = scene.step;
    return options;
  }
  /// Whether the code has the functions for lanes, too. The integrated work is not a state of the lanes: explicit
  /// methods get it without extra cost, others need more evaluations for it, which a separate run counts.
  bool has_lanes(const run::Scene& scene) const {
    if (batch_ == nullptr || !wants_lanes(scene)) return false;
    const eom::MethodInfo& method = run::get_method(scene.solver);
    return method.ensemble ||
           (watches_energy_ && (!method.needs.used.has(eom::Feature::jacobian) || batch_->jac != nullptr) &&
            (!method.needs.required.has(eom::Feature::series) || batch_->taylor != nullptr));
  }

  enum class How : char { together, alone, refused };

  /// The functions of one state, as in a separate run.
  struct One {
    const Runs& of;
    const eom::hybrid::EventRanges* ranges;  // null if there are none
    const double *p, *w, *u;                 // null if there are none
    int operator()(double t, const double* x, double* dx) const {
      return w != nullptr ? of.code_.rhs_prepared(t, x, p, w, u, 0, dx) : of.code_.rhs(t, x, p, u, 0, dx);
    }
    int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
      return of.code_.jac(t, x, p, u, 0, dfdx, dfdt);
    }
    int taylor(double t, const double* x, int order, double* c) const {
      return of.code_.taylor(t, x, p, u, 0, order, c);
    }
    int taylor_order() const { return of.code_.taylor_order; }
    std::size_t taylor_states() const { return of.states_; }
    int events(double t, const double* x, double* values) const { return of.code_.events(t, x, p, u, 0, values); }
    void begin_step(const eom::StepView&) const {
      if (ranges != nullptr) ranges->begin_step();
    }
    std::optional<std::pair<double, double>> hidden_crossing(const eom::StepView& step, std::size_t i, int side,
                                                             double from, double to) const {
      if (ranges == nullptr) return std::nullopt;
      const eom::hybrid::Sampling sampling{[this](double) { return u; }, {}};
      return ranges->first(step, i, side, from, to, sampling);
    }
  };

  struct Lanes {
    static constexpr int own = emit::own_time + emit::own_parameters + emit::own_inputs;
    const Runs& of;

    const double* inputs(const double* p, std::size_t stride) const {
      return of.u_ > 0 ? p + (of.p_ + of.w_) * stride : nullptr;
    }
    int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                   int* codes) const {
      const double *const w = p + of.p_ * stride, *const u = inputs(p, stride);
      return of.w_ > 0
                 ? of.batch_->rhs_prepared(count, stride, t, x, p, w, u, nullptr, own + emit::own_prepared, dx, codes)
                 : of.batch_->rhs(count, stride, t, x, p, u, nullptr, own, dx, codes);
    }
    int jacobian(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dfdx,
                 double* dfdt, int* codes) const {
      return of.batch_->jac(count, stride, t, x, p, inputs(p, stride), nullptr, own, dfdx, dfdt, codes);
    }
    int taylor(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
               const int* orders, double* coefficients, int* codes) const {
      return of.batch_->taylor(count, stride, t, x, p, inputs(p, stride), nullptr, orders, own + emit::own_orders,
                               coefficients, codes);
    }
    int taylor_order() const { return of.code_.taylor_order; }
    One member_rhs(std::size_t member, const double* p) const {
      const double* const w = p + of.p_;
      return {of, of.ranges_[member].get(), p, of.w_ > 0 ? w : nullptr, of.u_ > 0 ? w + of.w_ : nullptr};
    }
  };

  /// The scene of a run; nothing if it has no valid start, which has been reported.
  std::optional<run::Scene> scene_of(std::size_t member) {
    graph_.trim();
    DerivedModel& derived = *first_.derived;
    try {
      return run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene(first_.scene.name),
                                asked_.overrides(asked_.runs[member]), derived.scene_tables);
    } catch (const Error& error) {
      if (error.stage() != "scene") throw;
      asked_.on_refusal(asked_.runs[member], error.message());
      return std::nullopt;
    }
  }

  /// For methods without lanes: each thread makes one run after the other.
  void one_by_one() {
    eom::ensemble::run_in_threads(asked_.threads, how_.size(), [this](const auto& next) {
      for (std::size_t member = 0; next(member);) {
        if (stopped()) return;
        std::optional<BoundRun> run;
        {
          const std::lock_guard<std::mutex> guard(lock_);  // scenes are resolved in the model's own graph
          std::optional<run::Scene> scene = scene_of(member);
          if (!scene) continue;
          run.emplace(*first_.derived, first_, std::move(*scene), false);
        }
        run->request().interrupt = asked_.interrupt;
        const run::RunResult result = run->integrate();
        const std::lock_guard<std::mutex> guard(lock_);
        if (!stopped()) asked_.on_end(asked_.runs[member], result);
      }
    });
  }
  bool stopped() const { return asked_.interrupt != nullptr && *asked_.interrupt; }

  /// Begins a member; a run that cannot be made side by side ends immediately.
  void begin(std::size_t member, eom::EnsembleStart& start) {
    const std::lock_guard<std::mutex> guard(lock_);  // scenes are resolved in the model's own graph
    start.t0 = start.t1 = 0;
    std::fill(start.x.begin(), start.x.end(), 0.0);
    std::fill(start.p.begin(), start.p.end(), 0.0);
    if (stopped()) return;
    how_[member] = How::refused;
    const std::optional<run::Scene> scene = scene_of(member);
    if (!scene) return;
    const auto finite = [](double value) { return std::isfinite(value); };
    how_[member] = How::alone;
    if (!stands_still(*scene) || !std::all_of(scene->parameters.begin(), scene->parameters.end(), finite)) return;
    std::copy(scene->parameters.begin(), scene->parameters.end(), start.p.begin());
    if (w_ > 0 && batch_->model.prepare(start.p.data(), start.p.data() + p_) != 0) return;
    for (std::size_t i = 0; i < u_; ++i) start.p[p_ + w_ + i] = scene->inputs[i](scene->t0, scene->t0);
    for (std::size_t i = 0; i < code_.free.size(); ++i) {
      start.x[i] = scene->q[code_.free[i]];
      start.x[code_.free.size() + i] = scene->qdot[code_.free[i]];
    }
    start.t0 = scene->t0;
    start.t1 = scene->t1;
    how_[member] = How::together;
    if (!events_.empty()) {
      const eom::hybrid::StepVariables variables(states_, u_);
      ranges_[member] =
          std::make_unique<eom::hybrid::EventRanges>(first_.bounded_functions.events, variables, scene->parameters);
    }
    if (watches_energy_) energy_[member] = energy(outputs(start.t0, start.x, start.p)).first;
  }

  std::vector<double> outputs(double t, std::span<const double> x, std::span<const double> p) const {
    std::vector<double> y(code_.output_names.size());
    code_.outputs(t, x.data(), p.data(), u_ > 0 ? p.data() + p_ + w_ : nullptr, 0, y.data());
    return y;
  }
  /// The energy, and the size of its terms.
  std::pair<double, double> energy(const std::vector<double>& y) const {
    return {y[kinetic_] + y[potential_], std::abs(y[kinetic_]) + std::abs(y[potential_])};
  }

  void finish(const eom::EnsembleEnd& end) {
    const std::size_t run = asked_.runs[end.member];
    if (!events_.empty()) ranges_[end.member].reset();
    if (how_[end.member] == How::refused || end.outcome == eom::Outcome::interrupted || stopped()) return;
    run::RunResult result;
    const bool ended = end.outcome == eom::Outcome::done || end.outcome == eom::Outcome::stopped_by_event;
    if (how_[end.member] == How::together && ended) {
      const std::vector<double> y = outputs(end.t, end.x, end.p);
      const auto [now, size] = energy(y);
      if (!watches_energy_ || std::abs(now - energy_[end.member]) <= doubtful_energy * size) {
        result.outcome = end.outcome;
        result.t = end.t;
        result.statistics = end.statistics;
        for (std::size_t i = 0; i < y.size(); ++i) result.final.emplace_back(code_.output_names[i], y[i]);
        const std::lock_guard<std::mutex> guard(lock_);
        return asked_.on_end(run, result);
      }
    }
    const std::lock_guard<std::mutex> guard(lock_);
    graph_.trim();
    result = rerun(first_, asked_.overrides(run), false);
    if (!stopped()) asked_.on_end(run, result);
  }

  const Simulation& first_;
  const EnsembleRequest& asked_;
  GraphTrimmer graph_;
  const run::Code& code_;
  const emit::LoadedBatch* batch_;  // null: runs are made one by one
  std::vector<How> how_;
  std::vector<double> energy_;                                     // at the start of each
  std::vector<eom::EventFunction> events_;                         // of the model
  std::vector<std::unique_ptr<eom::hybrid::EventRanges>> ranges_;  // of the active members
  std::size_t states_ = 0, p_ = 0, w_ = 0, u_ = 0;                 // rows: parameters, prepared values, inputs
  std::size_t kinetic_ = 0, potential_ = 0;
  bool watches_energy_ = false;
  std::mutex lock_;
};

}  // namespace

std::string ensemble_solver(const model::Scene& scene, const run::Overrides& overrides) {
  if (overrides.solver || scene.solver != eom::Automatic::name) return overrides.solver.value_or(scene.solver);
  return overrides.step || scene.step != model::no_node ? run::default_solvers.fixed_step
                                                        : run::default_solvers.adaptive;
}

std::string ensemble_obstacle(const Simulation& first) {
  const run::Code& code = first.code.code_for_run();
  if (!code.contacts.empty() || !code.contact_set.empty())
    return "the model has contacts with friction, or unilateral contacts";
  if (!code.kinks.empty()) return "the equations have kinks (abs, sign, min, max, if, atan2), which are located";
  if (code.active_constraints > 0) return "constraints keep multipliers, and each step is projected onto them";
  if (first.charts != nullptr) return "the run may change to second charts near singularities";
  if (code.layout().others() > 0)
    return "the model has a state of first order, a discrete value, or an integral over time";
  if (code.reset_values > 0) return "events or samples of the model change the state";
  if (const std::string name = ranged(first, code); !name.empty())
    return fmt::format("'{}' has a range, which is checked after every step", name);
  if (!run::narrow_functions(first.derived->candidates.front(), run::Tails::none).empty())
    return "exp, tanh, sinh, cosh or a high power of the state may give a force that is narrow, which is searched for "
           "in every step";
  if (!stands_still(first.scene)) return "inputs or functions of time vary, and their jumps and pulses are located";
  return "";
}

Ensemble::Ensemble(const Simulation& first) : first_(first) {
  if (Runs::wants_lanes(first.scene)) batch_.emplace(compile_batch(first));
}

void Ensemble::run(const EnsembleRequest& asked) { Runs(first_, batch_ ? &*batch_ : nullptr, asked).run(); }

}  // namespace eomgen::pipeline
