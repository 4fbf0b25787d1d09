// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <eom/watch/drift.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "model/names.hpp"
#include "run/balance.hpp"
#include "run/estimate.hpp"
#include "run/integration.hpp"
#include "run/resolution.hpp"

namespace eomgen::run {
namespace {

using Stopwatch = std::chrono::steady_clock;

double seconds_since(Stopwatch::time_point start) {
  return std::chrono::duration<double>(Stopwatch::now() - start).count();
}

/// What is looked at after every step: invariants, power balance, constraints; and the rows in between.
class Watch {
 public:
  Watch(const RunRequest& request, Integration& integration)
      : request_(request), integration_(integration), y_(request.code.output_names.size()) {
    const std::vector<std::string>& names = request.code.output_names;
    kinetic_ = index_of(names, "kinetic");
    potential_ = index_of(names, "potential");
    energy_ = index_of(names, "energy");
    for (const std::string& name : request.conserved) {
      conserved_.push_back(index_of(names, name));
      drifts_.emplace_back(name);
    }
    for (const std::string& name : request.magnitudes)
      magnitudes_.push_back(name.empty() ? no_output : index_of(names, name));
    magnitudes_.resize(conserved_.size(), no_output);
    last_.resize(conserved_.size());
    shift_.resize(conserved_.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].starts_with(system::watched_prefix)) redundant_.push_back(i);
    }
    const std::vector<double> x = integration.initial_state();
    between_.resize(x.size());
    see(request.scene.t0, x.data());
    row(request.scene.t0, x.data());
  }

  bool step(const eom::StepView& view) {
    see(view.t1, view.x1.data());
    if (left_chart(view)) {
      // Nothing of this step is a result: the chart's equations stop holding somewhere inside it.
      chart_detail_ = fmt::format(
          "{} leaves its range ({}, {}) between t = {} and {}: give it a wider one in [coordinates] if the equations "
          "hold beyond it, or take coordinates "
          "that do not end there (Cartesian ones, Euler parameters, an angle of another sequence)",
          left_, lower_, upper_, view.t0, view.t1);
      last_t_ = view.t0;
      last_x_.assign(view.x0.begin(), view.x0.end());
      return false;
    }
    if (request_.every > 0 && !rows_within(view)) return false;
    if (request_.progress) {
      request_.progress((view.t1 - request_.scene.t0) / (request_.scene.t1 - request_.scene.t0));
    }
    return true;
  }

  /// An event: told, and a row of its own, put in order when the rest of its step is written.
  void event(const RunEvent& event, std::span<const double> x) {
    events_.push_back(event);
    if (event.kind == "impulse") shift_invariants(event.t, x.data());
    if (request_.every > 0 && event.kind == "custom")
      pending_.emplace_back(event.t, std::vector<double>(x.begin(), x.end()));
  }

  /// Where a coordinate left its range, the run ends with the step before; tells what happened. Where it was
  /// interrupted between two rows it ends with the last one.
  void cut(eom::Result& end) const {
    if (interrupted_) {
      end.outcome = eom::Outcome::interrupted;
      end.detail = "while rows were written";
      end.t = last_t_;
      end.x = last_x_;
    }
    if (chart_detail_.empty()) return;
    end.outcome = eom::Outcome::chart_left;
    end.detail = chart_detail_;
    end.t = last_t_;
    end.x = last_x_;
  }

  /// The end of the run as a last row, unless it is on the grid already.
  void finish(double t, const double* x) {
    if (request_.every > 0 && t != last_row_) row(t, x);
  }

  void report(RunResult& result) const {
    result.events = events_;
    if (!chart_detail_.empty()) {  // what lay in the step that left the chart is no result
      std::erase_if(result.events, [&](const RunEvent& event) { return event.t > last_t_; });
    }
    for (const eom::Drift& drift : drifts_) {
      result.invariants.push_back({drift.name(), drift.initial(), drift.max_relative_drift()});
    }
    result.power_balance = balance_.max_relative_defect();
    result.constraint_drift = defect_;
  }

 private:
  void see(double t, const double* x) {
    integration_.outputs(t, x, y_);
    const double magnitude = std::abs(y_[kinetic_]) + std::abs(y_[potential_]);
    const std::vector<std::uint32_t>& own = integration_.charts().own_outputs();
    for (std::size_t i = 0; i < conserved_.size(); ++i) {
      // Near where the own chart fails its formulas say little.
      if (std::find(own.begin(), own.end(), conserved_[i]) != own.end()) continue;
      const double terms = magnitudes_[i] == no_output ? 0 : y_[magnitudes_[i]];
      last_[i] = y_[conserved_[i]];
      drifts_[i].see(y_[conserved_[i]] - shift_[i], conserved_[i] == energy_ ? magnitude : terms);
    }
    const double work = request_.watch_power ? x[2 * request_.code.free.size() + request_.code.integrals] : 0;
    balance_.see(y_[energy_] - integration_.work - integration_.contact_work, work, magnitude);
    defect_ = std::max(defect_, integration_.constraint_defect(t, x));
    for (const std::size_t i : redundant_) defect_ = std::max(defect_, std::abs(y_[i]));
  }

  // An energy is conserved between the impulses of supports; momenta are, through them.
  void shift_invariants(double t, const double* x) {
    integration_.outputs(t, x, y_);
    for (std::size_t i = 0; i < conserved_.size(); ++i) {
      if (drifts_[i].name() != "energy" && drifts_[i].name() != "jacobi") continue;
      shift_[i] += y_[conserved_[i]] - last_[i];
    }
  }

  // Every coordinate, eliminated ones too, comes first among the outputs, with its rate.
  bool left_chart(const eom::StepView& view) {
    const Scene& scene = request_.scene;
    for (std::size_t i = 0; i < scene.lower.size(); ++i) {
      const double q = y_[2 * i];
      if (integration_.charts().has_exchanged(static_cast<std::uint32_t>(i))) continue;
      if (q > scene.lower[i] && q < scene.upper[i]) continue;
      if (std::find(beyond_.begin(), beyond_.end(), i) != beyond_.end()) continue;
      if (request_.beyond_range && integration_.charts().second() == 0 &&
          request_.beyond_range(static_cast<std::uint32_t>(i), view.t1, view.x1)) {
        beyond_.push_back(i);
        continue;
      }
      left_ = request_.code.output_names[2 * i];
      lower_ = scene.lower[i], upper_ = scene.upper[i];
      return true;
    }
    return false;
  }

  /// False where the run was interrupted meanwhile.
  bool rows_within(const eom::StepView& view) {
    // Multiples of the interval, counted, so that the grid does not drift; a last sliver belongs to the end.
    while (true) {
      const double t = request_.scene.t0 + static_cast<double>(next_) * request_.every;
      rows_of_events(std::min(t, view.t1));
      if (t > view.t1 || t > request_.scene.t1) return true;
      if (t == last_row_) {
        // an event's row stands there already
      } else if (t == view.t1) {
        row(t, view.x1.data());
      } else {
        view.interpolate(t, between_);
        row(t, between_.data());
        if (request_.interrupt != nullptr && request_.interrupt->load(std::memory_order_relaxed)) {
          interrupted_ = true;
          last_t_ = t;
          last_x_ = between_;
          return false;
        }
      }
      ++next_;
    }
  }

  void rows_of_events(double until) {
    std::size_t written = 0;
    for (; written < pending_.size() && pending_[written].first <= until; ++written) {
      if (pending_[written].first != last_row_) row(pending_[written].first, pending_[written].second.data());
    }
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(written));
  }

  void row(double t, const double* x) {
    if (request_.every <= 0 || !request_.row) return;
    integration_.outputs(t, x, y_);
    request_.row(t, y_);
    last_row_ = t;
  }

  const RunRequest& request_;
  Integration& integration_;
  std::vector<double> y_, between_;
  std::size_t kinetic_ = 0, potential_ = 0, energy_ = 0;
  static constexpr std::size_t no_output = static_cast<std::size_t>(-1);
  std::vector<std::size_t> conserved_, magnitudes_, redundant_;
  std::vector<eom::Drift> drifts_;
  std::vector<double> last_, shift_;  // of invariants: where the last step ended; by which impulses changed them
  eom::PowerBalance balance_;
  double defect_ = 0;
  std::string left_, chart_detail_;
  std::vector<std::size_t> beyond_;  // coordinates whose range the equations do not need
  double lower_ = 0, upper_ = 0;     // of its range
  double last_t_ = 0;
  std::vector<double> last_x_;
  std::vector<RunEvent> events_;
  std::vector<std::pair<double, std::vector<double>>> pending_;  // rows at events of the step that is being made
  std::uint64_t next_ = 1;
  double last_row_ = std::nan("");
  bool interrupted_ = false;
};

/// Of a parameter that is no number nothing follows, also where no number that the run gives shows it (a comparison is
/// false then).
void tell_parameters(const Scene& scene, RunResult& result) {
  if (result.outcome != eom::Outcome::done && result.outcome != eom::Outcome::stopped_by_event) return;
  if (std::all_of(scene.parameters.begin(), scene.parameters.end(), [](double value) { return std::isfinite(value); }))
    return;
  result.outcome = eom::Outcome::not_finite;
  result.detail = "a parameter is infinite or not a number";
}

eom::Options options_of(const RunRequest& request) {
  eom::Options options;
  options.rtol = request.scene.rtol;
  options.atol = request.scene.atol;
  options.fixed_step = request.scene.step;
  if (request.scene.max_step > 0) options.max_step = request.scene.max_step;
  options.interrupt = request.interrupt;
  options.max_steps = request.steps_allowed(options.fixed_step > 0);
  return options;
}

}  // namespace

const eom::MethodInfo& method_named(const std::string& name) {
  static constexpr eom::MethodInfo automatic{eom::Automatic::name, eom::Automatic::order, 4, true};
  if (name == automatic.name) return automatic;
  for (const eom::MethodInfo& method : eom::methods()) {
    if (name == method.name) return method;
  }
  throw std::logic_error("no method is called " + name);
}

std::pair<std::string, std::string> choose_solver(const std::string& asked, const Scene& scene) {
  if (asked != "auto") {
    for (const eom::MethodInfo& method : eom::methods()) {
      if (asked != method.name) continue;
      if (!method.adaptive && scene.step <= 0) {
        throw Error("run", {}, fmt::format("solver '{}' takes steps of a fixed size, and none is given", asked),
                    "give --step H (or step = H in the scene), or take dop853, which chooses its steps");
      }
      if (const std::string why = unfit(asked, scene); !why.empty()) {
        throw Error("run", {}, fmt::format("solver '{}' cannot integrate this scene: {}", asked, why),
                    "take dop853 or auto");
      }
      return {asked, "as asked for"};
    }
    std::string names;
    std::vector<std::string> known{"auto"};
    for (const eom::MethodInfo& method : eom::methods()) {
      names += fmt::format("{}, ", method.name);
      known.emplace_back(method.name);
    }
    const std::string hint = model::did_you_mean(asked, known);
    throw Error("run", {}, fmt::format("there is no solver {}", model::quote(asked)),
                (hint.empty() ? "" : hint + " ") + "choose from: " + names + "auto");
  }
  if (scene.step > 0) return {"rk4", "a fixed step is given"};
  return {eom::Automatic::name, scene.rtol > 1e-6
                                    ? "rtol is above 1e-6, where order 5 needs the fewest evaluations"
                                    : "rtol is 1e-6 or below, where order 8 needs the fewest evaluations"};
}

/// What `auto` did: the method that it ended with, the changes, where df/dx came from.
static void tell_choice(const RunRequest& request, const eom::Choice& choice, RunResult& result) {
  if (choice.method != nullptr) result.solver = choice.method;
  for (const eom::MethodChange& change : choice.changes) {
    result.solver_changes.push_back({change.t, change.from, change.to, change.why});
  }
  if (choice.changes.empty()) return;
  const eom::MethodChange& first = choice.changes.front();
  result.reason = fmt::format("{} until t = {:.6g}, since {}; then {}: {}", first.from, first.t, result.reason,
                              first.to, first.why);
  if (choice.changes.size() > 1) result.reason += fmt::format("; {} changes in all", choice.changes.size());
  if (result.statistics.jacobians == 0) return;
  result.reason += request.code.jac != nullptr
                       ? "; df/dx from the equations"
                       : "; df/dx by differences, since it was not compiled (solver radau5 has it compiled)";
}

RunResult integrate_scene(const RunRequest& request) {
  RunResult result;
  std::tie(result.solver, result.reason) = choose_solver(request.scene.solver, request.scene);
  if (method_named(result.solver).implicit)
    result.reason += request.code.jac != nullptr ? ", df/dx from the equations"
                                                 : ", df/dx by differences, since it was not compiled";
  if (method_named(result.solver).series) {
    if (request.code.taylor == nullptr)
      throw Error("run", {}, "the code was compiled without its Taylor series",
                  "choose the solver taylor when the code is made");
    result.reason += ", series from the equations";
  }
  if (const std::string why = unfit(result.solver, request.code); !why.empty()) {
    throw Error("run", {}, fmt::format("solver '{}' cannot integrate this model: {}", result.solver, why),
                instead_of(result.solver));
  }
  if (method_named(result.solver).constrained)
    result.reason +=
        "; constraints on positions and velocities are equations of each step, so that nothing is projected";
  if (method_named(result.solver).variational) {
    result.reason += ", momenta from the equations";
    if (request.watch_power)
      result.reason += "; forces that change the energy enter by d'Alembert's principle in discrete form";
  }
  if (request.scene.step > 0) {
    if (const std::vector<FinerSteps> finer = finer_steps(request.scene); !finer.empty())
      result.reason += fmt::format("; shorter steps from t = {:.6g} on where a function of time changes within one",
                                   finer.front().begin);
  }
  if (!request.scene.clock.incomplete.empty()) result.reason += "; " + request.scene.clock.incomplete;
  const eom::Options options = options_of(request);
  Integration integration(request, result.solver);
  Watch watch(request, integration);
  const Stopwatch::time_point start = Stopwatch::now();
  std::optional<Resolution> resolution;
  const auto& contacts = request.code.contacts;
  const bool impacts =
      std::any_of(contacts.begin(), contacts.end(), [](const eom::Contact& contact) { return contact.unilateral; });
  if (request.estimate && options.fixed_step > 0) resolution.emplace(impacts);
  const auto see = [&](const eom::StepView& view) {
    if (resolution && integration.charts().second() == 0) resolution->see(view);
    return watch.step(view);
  };
  const bool moves = request.scene.t1 != request.scene.t0;
  eom::Result end =
      moves ? integration.run(options, see,
                              [&](const RunEvent& event, std::span<const double> x) { watch.event(event, x); })
            : eom::Result{eom::Outcome::done, request.scene.t0, integration.initial_state(), {}, ""};
  result.seconds_integrate = seconds_since(start);
  if (!moves && result.solver == eom::Automatic::name) {
    result.solver = "dop853";
    result.reason = "nothing moves from the start to the start";
  }
  const std::string asked = result.solver;
  watch.cut(end);
  watch.finish(end.t, end.x.data());
  watch.report(result);
  result.outcome = end.outcome;
  result.detail = end.detail;
  if (end.outcome == eom::Outcome::max_steps) result.detail += "; --max-steps allows more";
  result.t = end.t;
  result.statistics = end.statistics;
  if (asked == eom::Automatic::name) tell_choice(request, integration.choice, result);
  for (std::size_t k = 0; k < request.code.kinks.size(); ++k) {
    result.kinks.push_back({request.code.kinks[k], integration.kink_crossings[k]});
  }
  result.projection_position = integration.position_correction;
  result.projection_velocity = integration.velocity_correction;
  result.projection_work = integration.work;
  result.contact_work = integration.contact_work;
  std::vector<double> y(request.code.output_names.size());
  integration.outputs(end.t, end.x.data(), y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    const std::string& name = request.code.output_names[i];
    const auto& sizes = request.magnitudes;
    if (std::find(sizes.begin(), sizes.end(), name) == sizes.end()) result.final.emplace_back(name, y[i]);
  }
  result.state = integration.own_state(end);
  tell_parameters(request.scene, result);
  if (integration.passed_over()) {
    result.estimate_note = fmt::format(
        "a step after t = {:.6g} goes over a force that is narrow in the state, and sees nothing of it: the estimate "
        "says nothing; give a shorter --step, or leave it out",
        *integration.passed_over());
  }
  if (const std::optional<double> from = request.narrow.unsure()) {
    result.reason += fmt::format(
        "; whether a force that is narrow in the state lies in a step could not be told from t = {:.6g} on (--max-step "
        "makes steps shorter)",
        *from);
  }
  const bool ended = result.outcome == eom::Outcome::done || result.outcome == eom::Outcome::stopped_by_event;
  if (request.estimate && ended && moves) {
    eom::Result own = end;
    own.x = result.state;
    estimate_error(request, asked, own, options, resolution ? &*resolution : nullptr, result);
  }
  if (ended) require_balance(request, result);
  return result;
}

}  // namespace eomgen::run
