// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of a run in one scene, for sensitivities: own ones, and those of scenes beside it. In: a request, a
// scene. Out: the right-hand side, event functions, and the changes of the state by events and samples at any (t, x).
#pragma once

#include <algorithm>
#include <cstdint>
#include <eom/hybrid/resets.hpp>
#include <eom/hybrid/run_context.hpp>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// The equations in one scene.
struct VariationalEquations {
  VariationalEquations(eom::hybrid::Problem of, std::vector<eom::hybrid::Breakpoint> times)
      : problem(std::move(of)), kinks(std::move(times)), context(problem), resets(context) {
    set_tolerances(problem.rtol, problem.atol);
  }
  VariationalEquations(const VariationalEquations&) = delete;
  VariationalEquations& operator=(const VariationalEquations&) = delete;

  /// Of slip. One in two directions has no direction at first: the derivatives of its start have an error in proportion
  /// to the slip that counts as none. Rounding, divided by this slip, has to stay below the error control.
  /// coarse: rounding did not.
  void set_tolerances(double rtol, double atol, bool coarse = false) {
    constexpr double least = 1e-8, part = 1e-2, rounding = 1e-19;
    const bool fine = !coarse && has_slip_of_two();
    const double relative = fine ? std::max(part * rtol, std::min(least, rounding / rtol)) : std::max(rtol, least),
                 absolute = fine ? std::max(part * atol, 1e-3 * relative) : std::max(atol, 1e-3 * least);
    if (context.contacts) context.contacts->set_tolerances(relative, absolute);
    if (context.solved_contacts && has_slip_of_two()) context.solved_contacts->set_tolerances(relative, absolute);
  }

  /// Whether a contact slips in two directions.
  bool has_slip_of_two() const {
    const std::vector<eom::contacts::Description>& solved = problem.code->contact_set.contacts;
    const std::vector<eom::Contact>& compiled = problem.code->contacts;
    return std::any_of(solved.begin(), solved.end(), [](const auto& c) { return c.sticks && c.slip.size() == 2; }) ||
           std::any_of(compiled.begin(), compiled.end(), [](const eom::Contact& c) { return c.dimensions == 2; });
  }

  double end_of(std::size_t segment) const { return segment < kinks.size() ? kinks[segment].before : problem.t1; }
  double begin_of(std::size_t segment) const { return segment > 0 ? kinks[segment - 1].after : problem.t0; }
  /// Tables return their values of this segment.
  void enter(std::size_t segment) { context.model.set_segment_time((begin_of(segment) + end_of(segment)) / 2); }

  eom::hybrid::Problem problem;
  std::vector<eom::hybrid::Breakpoint> kinks;
  eom::hybrid::RunContext context;
  eom::hybrid::Resets resets;
};

/// The problem of a run without its work, which is not part of the state of variational equations.
eom::hybrid::Problem problem_of(const RunRequest& request, const std::string& solver);
/// The same in another scene.
eom::hybrid::Problem problem_in(const Scene& scene, eom::hybrid::Problem problem);

/// A sample that is due at a boundary: its kind and its number.
struct DueSample {
  std::size_t kind;
  std::int64_t k;
};
/// The samples at the boundary from the end of a segment to the start of the next one, at `until`.
std::vector<DueSample> due_samples(const eom::hybrid::Problem& problem, double from, double until);

/// The state after samples, and after the events that they cause. Throws Error{stage "run"} if it is undetermined, or
/// if an event ends the run.
void take_samples(VariationalEquations& in, const std::vector<DueSample>& due, double t, std::vector<double>& x);
/// The state after event i, and after the events that its reset causes. Throws Error{stage "run"} if it is
/// undetermined.
void apply_reset(VariationalEquations& in, std::size_t i, double t, std::vector<double>& x);

}  // namespace eomgen::run
