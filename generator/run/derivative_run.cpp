// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/derivative_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/ode.hpp>
#include <string_view>

#include "error.hpp"

namespace eomgen::run {
namespace {

/// The reason why derivatives cannot follow the contacts of a run; empty if they can.
std::string unfollowed_contacts(const RunRequest& request) {
  if (request.code.contacts.empty() && request.code.contact_set.empty()) return "";
  const bool resets = std::any_of(request.events.begin(), request.events.end(),
                                  [](const eom::hybrid::WatchedEvent& event) { return !event.reset.set.empty(); });
  if (resets || !request.samples.empty()) return "the model has contacts, and events or samples that change its state";
  return "";
}

constexpr std::string_view refused = "no derivatives of the end: ";

}  // namespace

void refuse_derivative(const std::string& what) {
  throw Error("run", {}, std::string(refused) + what, "compare runs with changed values (--set), or sweep over them");
}

std::string reason_of_refusal(const Error& error) {
  const std::string& message = error.message();
  return message.starts_with(refused) ? message.substr(refused.size()) : message;
}

void require_derivatives(const RunRequest& request, const RunResult& result) {
  if (const std::string reason = unfollowed_contacts(request); !reason.empty())
    refuse_derivative(reason + ", and derivatives are not implemented there");
  for (std::size_t i = 0; i < request.events.size(); ++i) {
    if (request.events[i].stop && !request.events[i].reset.set.empty())
      refuse_derivative(fmt::format("the event '{}' ends the run and changes the state there", request.events[i].name));
  }
  const auto slides = [](const RunEvent& event) { return event.kind == "slide"; };
  if (const auto at = std::find_if(result.events.begin(), result.events.end(), slides); at != result.events.end())
    refuse_derivative(fmt::format("the motion slides along a surface of {} from t = {} on, and derivatives jump there",
                                  at->name, at->t));
  if (request.scene.clock.unresolved_from && *request.scene.clock.unresolved_from < result.t)
    refuse_derivative(
        fmt::format("a condition on time changes too often from t = {} on", *request.scene.clock.unresolved_from));
}

std::string derivative_solver(const std::string& solver) {
  const eom::MethodInfo& method = get_method(solver);
  if (method.needs.required.none()) return solver;
  return uses_jacobian(method) ? default_solvers.implicit : default_solvers.adaptive;
}

eom::Options derivative_options(const RunRequest& request, const std::string& solver) {
  eom::Options options;
  options.rtol = request.scene.rtol;
  options.atol = request.scene.atol;
  options.fixed_step = get_method(solver).adaptive ? 0 : request.scene.step;
  options.interrupt = request.interrupt;
  options.step_bounds = request.scene.clock.bounds;
  if (request.scene.max_step > 0) options.max_step = request.scene.max_step;
  options.max_steps = request.steps_allowed(options.fixed_step > 0);
  return options;
}

void EndComparison::require(const std::vector<double>& errors) const {
  const std::size_t i = worst(errors);
  if (i == none) return;
  refuse_derivative(
      fmt::format("the motion that is integrated with them ends at {} = {}, and the run at {}: something on the way is "
                  "not differentiated",
                  request_.state_names[i], end_[i], result_.state[i]));
}

std::size_t EndComparison::worst(const std::vector<double>& errors) const {
  double size = 0;
  for (std::size_t i = 0; i < request_.state_names.size(); ++i) size = std::max(size, std::abs(result_.state[i]));
  for (std::size_t i = 0; i < request_.state_names.size(); ++i) {
    double allowed = request_.scene.atol + request_.scene.rtol * size;
    if (errors.empty() && result_.error_estimate.empty()) allowed *= unknown_errors;
    if (!errors.empty()) allowed += 10 * errors[i];
    if (i < result_.error_estimate.size()) allowed += 10 * result_.error_estimate[i].second;
    if (!(std::abs(end_[i] - result_.state[i]) <= allowed)) return i;
  }
  return none;
}

}  // namespace eomgen::run
