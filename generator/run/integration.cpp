// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/integration.hpp"

#include <eom/hybrid/integration.hpp>
#include <eom/ode.hpp>

#include "run/bind.hpp"

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

}  // namespace eomgen::run
