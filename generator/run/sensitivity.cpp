// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/error_estimate.hpp>
#include <eom/ode.hpp>

#include "run/methods.hpp"
#include "run/variational.hpp"

namespace eomgen::run {
namespace {

/// The method of the run; if it needs a series, momenta or constraints, a method of similar order that does not.
std::string without_requirements(const std::string& solver) {
  const eom::MethodInfo& method = get_method(solver);
  if (method.needs.required.none()) return solver;
  return uses_jacobian(method) ? "radau5" : "dop853";
}

constexpr const char* by_runs = "compare runs with changed values (--set), or sweep over them";

void require_smooth(const RunRequest& request, const RunResult& result) {
  const auto refuse = [](const std::string& what) { throw Error("run", {}, "--sensitivity: " + what, by_runs); };
  if (!request.code.contacts.empty() || !request.code.contact_set.empty())
    refuse("contacts and friction change the equations during the run, and derivatives of the end jump there");
  for (std::size_t i = 0; i < request.events.size(); ++i) {
    if (request.events[i].stop && !request.events[i].reset.set.empty())
      refuse(fmt::format("the event '{}' ends the run and changes the state there", request.events[i].name));
  }
  const auto slides = [](const RunEvent& event) { return event.kind == "slide"; };
  if (const auto at = std::find_if(result.events.begin(), result.events.end(), slides); at != result.events.end())
    refuse(fmt::format("the motion slides along a surface of {} from t = {} on, and derivatives jump there", at->name,
                       at->t));
  if (request.scene.clock.unresolved_from && *request.scene.clock.unresolved_from < result.t)
    refuse(fmt::format("a condition on time changes too often from t = {} on", *request.scene.clock.unresolved_from));
}

/// x of the variational equations has to end where the run does: otherwise they miss something.
class EndComparison {
 public:
  EndComparison(const RunRequest& request, const RunResult& result, const eom::Result& end)
      : request_(request), result_(result), end_(end) {}

  /// Whether each component agrees within the tolerances, or within 10 of both errors.
  bool agrees(const std::vector<double>& errors) const { return worst(errors) == none; }

  void require(const std::vector<double>& errors) const {
    const std::size_t i = worst(errors);
    if (i == none) return;
    throw Error(
        "run", {},
        fmt::format("--sensitivity: the motion of the variational equations ends at {} = {}, and the run at {}: "
                    "something on the way is not differentiated",
                    request_.state_names[i], end_.x[i], result_.state[i]),
        by_runs);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t worst(const std::vector<double>& errors) const {
    double size = 0;
    for (std::size_t i = 0; i < request_.state_names.size(); ++i) size = std::max(size, std::abs(result_.state[i]));
    for (std::size_t i = 0; i < request_.state_names.size(); ++i) {
      double allowed = request_.scene.atol + request_.scene.rtol * size;
      if (!errors.empty()) allowed += 10 * errors[i];
      if (i < result_.error_estimate.size()) allowed += 10 * result_.error_estimate[i].second;
      if (!(std::abs(end_.x[i] - result_.state[i]) <= allowed)) return i;
    }
    return none;
  }

  const RunRequest& request_;
  const RunResult& result_;
  const eom::Result& end_;
};

}  // namespace

Sensitivities integrate_sensitivities(const RunRequest& request, const RunResult& motion,
                                      const std::vector<Direction>& directions, bool estimate) {
  require_smooth(request, motion);
  Sensitivities result;
  result.solver = without_requirements(motion.solver);
  eom::Options options;
  options.rtol = request.scene.rtol;
  options.atol = request.scene.atol;
  options.fixed_step = get_method(result.solver).adaptive ? 0 : request.scene.step;
  options.interrupt = request.interrupt;
  options.step_bounds = request.scene.clock.bounds;
  if (request.scene.max_step > 0) options.max_step = request.scene.max_step;
  options.max_steps = request.steps_allowed(options.fixed_step > 0);
  VariationalRun run(request, motion, result.solver, directions);
  const eom::Result end = run(options);
  result.outcome = end.outcome;
  result.t = motion.t;
  result.statistics = end.statistics;
  const std::size_t n = request.state_names.size(), all = directions.size();
  for (std::size_t d = 0; d < all; ++d) {
    result.list.push_back({directions[d].name, {}, 0, {}, 0});
    Sensitivity& s = result.list.back();
    for (std::size_t i = 0; i < n; ++i) s.value.push_back(end.x[(d + 1) * n + i] / directions[d].scale);
    if (end.outcome == eom::Outcome::done) s.of_time = end.x[(all + 1) * n + d] / directions[d].scale;
  }
  if (end.outcome != eom::Outcome::done) return result;
  const EndComparison comparison(request, motion, end);
  if (!estimate && comparison.agrees({})) return result;
  const eom::ErrorEstimate error = eom::estimate_error(get_method(result.solver).order, request.scene.t0, end, options,
                                                       [&run](const eom::Options& tighter) { return run(tighter); });
  comparison.require(error.x);
  if (!estimate) return result;
  for (std::size_t d = 0; d < all; ++d) {
    Sensitivity& s = result.list[d];
    for (std::size_t i = 0; i < n; ++i) s.error.push_back(error.x[(d + 1) * n + i] / directions[d].scale);
    s.error_of_time = error.x[(all + 1) * n + d] / directions[d].scale;
  }
  if (error.outcome != eom::Outcome::done)
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(error.outcome));
  return result;
}

}  // namespace eomgen::run
