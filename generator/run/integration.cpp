// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/integration.hpp"

#include <eom/hybrid/run.hpp>
#include <eom/hybrid/stepwise_run.hpp>
#include <utility>

#include "run/bind.hpp"
#include "run/methods.hpp"

namespace eomgen::run {

struct Integration::Bound {
  Bound(const RunRequest& request, const std::string& solver)
      : problem(make_problem(request, solver)), integration(problem) {}
  eom::hybrid::Problem problem;
  eom::hybrid::Integration integration;
};

Integration::Integration(const RunRequest& request, const std::string& solver)
    : bound_(std::make_unique<Bound>(request, solver)) {}
Integration::~Integration() = default;

eom::Result Integration::run(const eom::Options& options, const eom::hybrid::Observer& observer,
                             const eom::hybrid::OnEvent& event) {
  return bound_->integration.run(options, observer, event);
}

const std::vector<double>& Integration::initial_state() const { return bound_->integration.context().start; }
double Integration::begin() const { return bound_->problem.begin(); }
std::vector<int> Integration::contact_mode() const {
  eom::ModeArray mode = bound_->integration.context().model.mode();
  mode.release_branches();
  mode.set_charts(0);
  return mode.entries();
}
std::size_t Integration::kink_crossings() const { return bound_->integration.context().kinks.crossings_in_state(); }
std::vector<eom::hybrid::Segment> Integration::segments() const { return eom::hybrid::segments(bound_->problem); }
double Integration::constraint_defect(double t, const double* x) {
  return bound_->integration.context().constraint_defect(t, x);
}
int Integration::derivative(double t, const double* x, double* dx) {
  return bound_->integration.context().rhs(t, x, dx);
}

struct StepwiseState {
  eom::hybrid::StepwiseRun::State state;
};

struct StepwiseRun::Pieces {
  explicit Pieces(eom::hybrid::Problem problem) : run(std::move(problem)) {}
  eom::hybrid::StepwiseRun run;
};

StepwiseRun::StepwiseRun(eom::hybrid::Problem problem) : pieces_(std::make_unique<Pieces>(std::move(problem))) {}
StepwiseRun::~StepwiseRun() = default;

eom::Result StepwiseRun::advance(double t_end, bool one_step, const std::atomic<bool>* interrupt,
                                 const eom::hybrid::OnEvent& event) {
  return pieces_->run.advance(t_end, {one_step, interrupt, event});
}
double StepwiseRun::t() const { return pieces_->run.t(); }
std::vector<double> StepwiseRun::state() const { return pieces_->run.state(); }
int StepwiseRun::outputs(std::span<double> y) { return pieces_->run.outputs(y); }
std::vector<double> StepwiseRun::inputs() { return pieces_->run.inputs(); }
std::span<const double> StepwiseRun::parameters() const { return pieces_->run.parameters(); }
void StepwiseRun::set_input(std::size_t input, eom::hybrid::Signal signal) {
  pieces_->run.set_input(input, std::move(signal));
}
void StepwiseRun::set_parameters(std::span<const double> values) { pieces_->run.set_parameters(values); }
void StepwiseRun::restart(double t, std::span<const double> x, std::vector<bool> open) {
  pieces_->run.restart(t, x, std::move(open));
}
std::vector<double> StepwiseRun::gaps(double t, std::span<const double> x) { return pieces_->run.gaps(t, x); }
std::shared_ptr<const StepwiseState> StepwiseRun::save() const {
  return std::make_shared<const StepwiseState>(StepwiseState{pieces_->run.save()});
}
void StepwiseRun::restore(const StepwiseState& from) { pieces_->run.restore(from.state); }

eom::hybrid::RunResult run_problem(const eom::hybrid::Problem& problem) { return eom::hybrid::run(problem); }

}  // namespace eomgen::run
