// SPDX-License-Identifier: MIT
// The components of one run, each in a file of its own, and the operations that involve several of them: the start, an
// exchange of charts, new sides of kinks.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "eom/hybrid/charts.hpp"
#include "eom/hybrid/constraint_rows.hpp"
#include "eom/hybrid/contacts.hpp"
#include "eom/hybrid/event_functions.hpp"
#include "eom/hybrid/kinks.hpp"
#include "eom/hybrid/model.hpp"
#include "eom/hybrid/outputs.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/state_projection.hpp"

namespace eom::hybrid {

struct Parts {
  explicit Parts(const Problem& asked)
      : problem(asked),
        charts(asked),
        model(asked),
        outputs(asked, model, charts),
        rows(asked),
        projection(asked, model, rows, outputs),
        kinks(asked, model),
        events(asked, model, contacts),
        start(own_start()),
        g(events.size()) {
    start_charts(problem.t0, start);
    if (problem.code->contacts.empty()) return;
    contacts = std::make_unique<ContactModes>(
        problem, model, rows, [this](double t, std::span<const double> before, std::span<const double> after) {
          const double energy = outputs.energy(t, before.data());
          impulse_work += outputs.energy(t, after.data()) - energy;
        });
    std::vector<double> x = start;
    start_contacts(problem.t0, x);  // sets the mode for observers of the start
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  /// Free coordinates, rates, integrals, the work done since the start.
  std::vector<double> own_start() const {
    std::vector<double> x = problem.start;
    x.resize(problem.states());
    return x;
  }

  /// dx/dt in the current mode. Returns 2 if the state is too close to the singularity of its chart.
  int rhs(double t, const double* x, double* dx) {
    if (charts.any()) {
      if (const int code = charts.admits(x); code != 0) return code;
    }
    return model.rhs(t, x, dx);
  }

  std::vector<std::string> start_charts(double t, std::span<double> x) {
    model.charts(0);
    if (!charts.any() || !charts.start(t, x.data())) return {};
    return exchange_charts(t, x);
  }

  std::vector<std::string> exchange_charts(double t, std::span<double> x) {
    std::vector<std::string> told = charts.exchange(t, x);
    model.use(charts.code());
    model.charts(charts.mode());
    rows.charts(charts.code(), charts.mode());
    return told;
  }

  std::vector<ModeEvent> start_contacts(double t, std::span<double> x) {
    if (!contacts) return {};
    impulse_work = 0;
    model.mode(0);  // a model with contacts does not exchange charts
    std::vector<ModeEvent> told = contacts->start(t, x);
    model.mode(contacts->mode());
    return told;
  }

  /// Freezes each kink on the side of the state. anew: whether earlier sides are discarded.
  void hold_sides(double t, const double* x, bool anew) {
    if (!kinks.any()) return;
    if (anew) model.forget_sides();
    if (kinks.all_held() || events(t, x, g.data()) != 0) return;
    kinks.hold(g.data() + events.first_kink(), anew);
  }

  /// The state at the end of a run in the model's own charts.
  std::vector<double> own_state(double t, const std::vector<double>& end) const {
    std::vector<double> x = end;
    charts.own(t, end.data(), std::span(x).first(2 * problem.n() + problem.code->integrals));
    return x;
  }

  /// Largest |psi|, |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x) { return rows.defect(t, x); }

  const Problem& problem;
  ChartSwitch charts;
  Model model;
  Outputs outputs;
  ConstraintRows rows;
  StateProjection projection;
  Kinks kinks;
  std::unique_ptr<ContactModes> contacts;  // null if there are none
  EventFunctions events;
  std::vector<double> start;  // in the second chart if the own one is near its singularity
  std::vector<double> g;      // event functions
  double impulse_work = 0;    // of impacts, of supports, and of the start or end of sliding in two directions
};

}  // namespace eom::hybrid
