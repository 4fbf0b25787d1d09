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
#include "eom/hybrid/solved_contacts.hpp"
#include "eom/hybrid/state_projection.hpp"

namespace eom::hybrid {

struct RunContext {
  explicit RunContext(const Problem& asked)
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
    start_charts(problem.begin(), start);
    const auto energy = [this](double t, std::span<const double> x) { return outputs.energy(t, x.data()); };
    const auto work_of = [this, energy](double t, std::span<const double> before, std::span<const double> after) {
      const double first = energy(t, before);
      const double work = energy(t, after) - first;
      impulse_work += work;
      return work;
    };
    if (!problem.code->contact_set.empty()) {
      solved_contacts = std::make_unique<SolvedContacts>(problem, model, work_of, energy);
      events.set_contacts(solved_contacts.get());
      rows.set_contacts(solved_contacts.get());
      g.resize(events.size());
      std::vector<double> x = start;
      start_contacts(problem.begin(), x);
    }
    if (problem.code->contacts.empty()) return;
    contacts = std::make_unique<ContactModes>(problem, model, rows, work_of, energy);
    std::vector<double> x = start;
    start_contacts(problem.begin(), x);  // sets the mode for observers of the start
  }
  RunContext(const RunContext&) = delete;
  RunContext& operator=(const RunContext&) = delete;

  /// Free coordinates, rates, states of first order, the work done since the start.
  std::vector<double> own_start() const {
    std::vector<double> x = problem.start;
    x.resize(problem.states());
    return x;
  }

  /// dx/dt in the current mode. Returns 2 if the state is too close to the singularity of its chart.
  int rhs(double t, const double* x, double* dx) {
    if (charts.has_charts()) {
      if (const int code = charts.check_chart(x); code != 0) return code;
    }
    return model.rhs(t, x, dx);
  }

  std::vector<std::string> start_charts(double t, std::span<double> x) {
    model.set_charts(0);
    if (!charts.has_charts() || !charts.start(t, x.data())) return {};
    return exchange_charts(t, x);
  }

  std::vector<std::string> exchange_charts(double t, std::span<double> x) {
    std::vector<std::string> recorded = charts.exchange(t, x);
    model.set_code(charts.code());
    model.set_charts(charts.second_charts());
    rows.set_charts(charts.code(), model.mode());
    return recorded;
  }

  std::vector<Event> start_contacts(double t, std::span<double> x) {
    if (solved_contacts) {
      impulse_work = 0;
      std::vector<Event> recorded;
      for (const SolvedContacts::Change& change : solved_contacts->start(t, x, problem.starts_open))
        recorded.push_back({t, change.kind, change.name, change.work, change.impulses});
      solved_contacts->update(x.data());
      return recorded;
    }
    if (!contacts) return {};
    impulse_work = 0;
    model.reset_mode();  // a model with contacts does not exchange charts
    std::vector<Event> recorded = contacts->start(t, x);
    model.set_contact_mode(contacts->mode());
    return recorded;
  }

  /// largest: values of all event functions so far.
  void observe_kinks(std::span<const double> largest) {
    if (kinks.any() && largest.size() == events.size()) kinks.observe(largest.data() + events.first_kink());
  }

  /// Freezes each kink on the side of the state. anew: whether earlier sides are discarded.
  void freeze_branches(double t, const double* x, bool anew) {
    if (!kinks.any()) return;
    if (anew) {
      leave_surfaces(t, x);
      model.release_branches();
    }
    if (kinks.are_all_frozen() || events(t, x, g.data()) != 0) return;
    kinks.freeze(g.data() + events.first_kink(), anew);
    if (anew) slide_from_surfaces(t, x);
  }

  /// To be called at the end of each accepted step: what the equations remember of the motion so far.
  void observe_state(double t, const double* x) {
    freeze_branches(t, x, false);
    if (contacts) contacts->update_min_slip(t, x);
    if (solved_contacts) solved_contacts->update(x);
  }

  /// A state that a jump moved away from a surface slides along it no longer.
  void leave_surfaces(double t, const double* x) {
    if (model.sliding_kinks().empty() || model.surfaces(t, x, g.data()) != 0) return;
    const std::vector<std::size_t> sliding = model.sliding_kinks();
    std::vector<std::size_t> kept;
    for (const std::size_t k : sliding)
      if (kinks.is_on_surface(k, g[k])) kept.push_back(k);
    model.set_sliding(kept);
    model.end_invalid_sliding(t, x);
  }

  /// A state on the surface of a kink slides along it, or gets the side to which it leaves the surface.
  void slide_from_surfaces(double t, const double* x) {
    if (!may_slide || kinks.are_all_frozen() || model.surfaces(t, x, g.data()) != 0) return;
    const std::vector<double> surfaces(g.begin(), g.begin() + static_cast<std::ptrdiff_t>(problem.code->kinks.size()));
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      if (model.mode().kink(k) == 0 && kinks.is_on_surface(k, surfaces[k])) model.begin_sliding(k, t, x);
  }

  /// The state at the end of a run in the model's own charts.
  std::vector<double> own_state(double t, const std::vector<double>& end) const {
    std::vector<double> x = end;
    charts.to_own_charts(t, end.data(), std::span(x).first(problem.code->layout().size()));
    return x;
  }

  /// Whether the work is integrated like the other states; else it is a quadrature. With sticking contacts the state
  /// may not change at all, and steps would not resolve the work of what moves the contacts.
  bool work_is_state() const { return problem.power && has_contacts(); }
  bool has_contacts() const { return contacts || solved_contacts; }

  /// Largest |psi|, |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x) { return rows.defect(t, x); }

  const Problem& problem;
  ChartSwitch charts;
  Model model;
  Outputs outputs;
  ConstraintRows rows;
  StateProjection projection;
  Kinks kinks;
  std::unique_ptr<ContactModes> contacts;           // null if there are none
  std::unique_ptr<SolvedContacts> solved_contacts;  // whose forces are inputs; null if there are none
  EventFunctions events;
  std::vector<double> start;  // in the second chart if the own one is near its singularity
  std::vector<double> g;      // event functions
  bool may_slide = false;     // along surfaces of kinks
  double impulse_work = 0;    // of impacts, of supports, and of the start or end of sliding in two directions
};

}  // namespace eom::hybrid
