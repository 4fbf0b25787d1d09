// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/jumps.hpp>
#include <eom/ode.hpp>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/prescribed_forces.hpp"
#include "conservation/conserved.hpp"
#include "derive/formulations/lagrange.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "model/names.hpp"
#include "symbolic/evaluate.hpp"
#include "system/equation_system.hpp"

namespace eomgen::analysis {

using pipeline::DerivedModel;
using symbolic::SymbolKind;

namespace {

double length(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// The normal force of a contact, from the reactions or as given.
symbolic::Ref squared_normal_force(const system::EquationSystem& s, const system::Contact& contact) {
  symbolic::Dag& dag = *s.dag;
  if (contact.reactions.empty()) return dag.mul(contact.normal, contact.normal);
  symbolic::Ref sum = dag.zero();
  const std::size_t n = contact.reactions.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const symbolic::Ref product =
          dag.mul(s.reactions[contact.reactions[i]].value, s.reactions[contact.reactions[j]].value);
      sum = dag.add(sum, dag.mul(contact.gram[i * n + j], product));
    }
  }
  return sum;
}

/// Friction along a motion that is prescribed as a whole. In: the equations of a model without free coordinates, whose
/// reactions depend on the friction forces phi. Out: phi at a time. The law is that of docs/theory.md, "Friction":
/// phi = -mu N slip/|slip|. Slip is a function of time here, so that only N is left to solve for.
class PrescribedFriction {
 public:
  using Lookup = std::function<double(const symbolic::Symbol&)>;

  /// `system` must outlive this object. Throws Error if a contact can open.
  PrescribedFriction(const system::EquationSystem& system, const std::string& file) : system_(system) {
    for (const system::Contact& contact : system.contacts) {
      if (contact.unilateral) {
        throw Error("inverse", SourceLocation{file, 0, 0, 1, ""},
                    fmt::format("'{}' can open, though the motion is prescribed as a whole", contact.name),
                    "write holds = \"bilateral\" here: the sign of its reaction shows where it would open");
      }
      count_ = std::max(count_, contact.first + contact.slip.size());
    }
  }

  struct Forces {
    std::vector<double> phi;           // by index of the symbol
    std::vector<std::string> resting;  // contacts at rest: any friction up to the static limit fits, and phi is 0
  };
  /// The friction forces at a time; `lookup` gives all other symbols. Empty if none that fit the motion were found.
  std::optional<Forces> at(const Lookup& lookup) const {
    constexpr int most_iterations = 500;
    constexpr double converged = 4 * std::numeric_limits<double>::epsilon();
    Forces result{std::vector<double>(count_, 0.0), {}};
    std::vector<double>& phi = result.phi;
    const Lookup with_friction = [&](const symbolic::Symbol& s) {
      return s.kind == SymbolKind::friction ? phi.at(s.index) : lookup(s);
    };
    std::vector<std::vector<double>> directions;
    std::vector<symbolic::Ref> strengths;
    for (const system::Contact& contact : system_.contacts) {
      directions.push_back(direction(contact, lookup));
      if (directions.back().empty() && !contact.slip.empty()) {
        result.resting.push_back(contact.name);
        directions.back().assign(contact.slip.size(), 0.0);
      }
      if (contact.slip.empty()) continue;
      strengths.push_back(contact.dynamic_coefficient);
      strengths.push_back(squared_normal_force(system_, contact));
    }
    // The normal forces depend on friction where its directions are not perpendicular to theirs: fixed point.
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const std::vector<double> values = symbolic::evaluate(*system_.dag, strengths, with_friction);
      double change = 0, largest = 0;
      std::vector<double> next(count_, 0.0);
      std::size_t at = 0;
      for (std::size_t j = 0; j < system_.contacts.size(); ++j) {
        const system::Contact& contact = system_.contacts[j];
        if (contact.slip.empty()) continue;
        const double force = values[at] * std::sqrt(values[at + 1]);
        at += 2;
        for (std::size_t a = 0; a < contact.slip.size(); ++a) {
          double& value = next[contact.first + a];
          value = -force * directions[j][a];
          change = std::max(change, std::fabs(value - phi[contact.first + a]));
          largest = std::max(largest, std::fabs(value));
        }
      }
      phi = next;
      if (!std::isfinite(largest)) break;
      if (change <= converged * largest) return result;
    }
    return std::nullopt;
  }

 private:
  /// slip/|slip|, or its limit after this time where slip vanishes; smoothed by the width of a smooth law. Empty at
  /// rest.
  std::vector<double> direction(const system::Contact& contact, const Lookup& lookup) const {
    std::vector<double> slip = symbolic::evaluate(*system_.dag, contact.slip, lookup);
    double speed = length(slip);
    if (contact.width) {
      speed = std::hypot(speed, symbolic::evaluate(*system_.dag, {*contact.width}, lookup)[0]);
    } else if (speed == 0) {
      slip = symbolic::evaluate(*system_.dag, contact.slip_rate, lookup);
      speed = length(slip);
      if (speed == 0) return {};
    }
    for (double& x : slip) x /= speed;
    return slip;
  }

  const system::EquationSystem& system_;
  std::size_t count_ = 0;
};

/// Labels of the requested constraints; all of the form q = f(t) if none are named.
std::vector<std::string> chosen_constraints(const mechanics::Mechanics& m, const std::vector<std::string>& names) {
  if (names.empty()) {
    std::vector<std::string> labels = analysis::prescribing_constraints(m);
    if (!labels.empty()) return labels;
    throw Error("inverse", SourceLocation{m.model->file, 0, 0, 1, ""},
                "no constraint of this model prescribes a motion",
                "add one that reads coordinate = function of time, such as [[constraint]] name = \"drive\", holonomic "
                "= \"R - f\", "
                "or name others with --constraint");
  }
  std::vector<std::string> labels, known;
  for (const mechanics::Constraint& c : m.constraints) known.push_back(c.label);
  for (const std::string& name : names) {
    const std::size_t before = labels.size();
    for (const mechanics::Constraint& c : m.constraints) {
      if (c.label == name || c.name == name) labels.push_back(c.label);
    }
    if (labels.size() == before) {
      throw Error("inverse", {}, fmt::format("there is no constraint {}", model::quote(name)),
                  model::suggest_choice(name, known));
    }
  }
  return labels;
}

std::vector<std::string> columns_of(const model::Model& model, const std::vector<std::string>& forces,
                                    const run::Scene& scene) {
  std::vector<std::string> columns;
  const auto add = [&](const std::string& name) {
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  };
  for (const std::string& name : run::state_columns(model)) add(name);
  for (const std::string& name : forces) add(name);
  for (const std::string& name : scene.outputs) add(name);
  return columns;
}

std::vector<std::string> force_columns(mechanics::Mechanics& m, system::EquationSystem& system,
                                       const std::vector<std::string>& labels) {
  std::vector<std::string> names = analysis::add_prescribed_forces(m, system, labels);
  for (const std::string& label : labels) names.push_back("reaction." + label);
  return names;
}

/// Case that every coordinate is prescribed: no integration.
class Prescribed {
 public:
  explicit Prescribed(mechanics::Mechanics mechanics) : model_(*mechanics.model), m_(std::move(mechanics)) {}

  InverseDynamicsResult answer(const InverseRequest& request) {
    InverseDynamicsResult result;
    verify::Subjects subjects;
    subjects.systems = verify::all_formulations(m_);
    const verify::Certificate certificate =
        verify::certify(m_, subjects, {50, pipeline::emission_points, request.seed, {}});
    pipeline::require_pass(certificate, model_);
    result.certificate = certificate.summary();
    system_ = derive::lagrange(m_, system::Approach::one);
    friction_.emplace(system_, model_.file);
    result.forces = force_columns(m_, system_, chosen_constraints(m_, request.constraints));
    scene_ = run::resolve_scene(m_, system_, model_.scene(request.scene), request.overrides);
    const double every = pipeline::row_interval(scene_);
    result.columns = columns_of(model_, result.forces, scene_);
    if (request.begin) request.begin(scene_, result.columns);
    t_ = scene_.t0;
    for (const std::string& name : result.columns) {
      const system::Output* output = system::find(system_.outputs, name);
      // Show exact zeros as 0 rather than as rounding errors.
      const bool nothing = conservation::zero_certainty(*m_.dag, {output->value}) != conservation::Certainty::no;
      values_.push_back(nothing ? m_.dag->zero() : output->value);
    }
    states_ = scene_.z;
    for (std::uint64_t i = 0; result.outcome == eom::Outcome::done; ++i) {
      const double t = scene_.t0 + static_cast<double>(i) * every;
      const bool last = t >= scene_.t1 - 1e-9 * every;
      if (i > 0) advance(last ? scene_.t1 : t, result);
      if (result.outcome == eom::Outcome::done) write_row(request, result);
      if (last) break;
      if (request.interrupt != nullptr && *request.interrupt && result.outcome == eom::Outcome::done) {
        result.outcome = eom::Outcome::interrupted;
        result.detail = fmt::format("at t = {}", t_);
      }
    }
    if (result.outcome == eom::Outcome::done) warn_of_jumps(result);
    return result;
  }

 private:
  std::vector<double> values_at(double t, const double* states, const std::vector<symbolic::Ref>& expressions,
                                const std::vector<double>& phi = {}) const {
    const double side = std::nextafter(t, scene_.t1 + 1);
    return symbolic::evaluate(*m_.dag, expressions,
                              [&](const symbolic::Symbol& s) -> double { return value_at(t, side, states, phi, s); });
  }

  double value_at(double t, double side, const double* states, const std::vector<double>& phi,
                  const symbolic::Symbol& s) const {
    switch (s.kind) {
      case symbolic::SymbolKind::time: return t;
      case symbolic::SymbolKind::parameter: return scene_.parameters[s.index];
      case symbolic::SymbolKind::input: return scene_.inputs[s.index](t, side);
      case symbolic::SymbolKind::friction:
        if (s.index < phi.size()) return phi[s.index];
        break;
      default: break;
    }
    for (std::size_t i = 0; i < system_.states.size(); ++i) {
      if (system_.states[i].symbol == s) return states[i];
    }
    throw std::logic_error("a prescribed motion leaves a symbol open");
  }

  /// States of first order.
  void advance(double t, InverseDynamicsResult& result) {
    const double from = std::exchange(t_, t);
    if (states_.empty()) return;
    std::vector<symbolic::Ref> rates = mapped(system_.states, &system::FirstOrderState::rate);
    const auto f = [&](double at, const double* x, double* dx) {
      const std::vector<double> rate = values_at(at, x, rates);
      std::copy(rate.begin(), rate.end(), dx);
      return 0;
    };
    eom::Options tolerances;
    if (scene_.max_step > 0) tolerances.max_step = scene_.max_step;
    tolerances.rtol = scene_.rtol;
    tolerances.atol = scene_.atol;
    const eom::Result end = eom::integrate(run::default_solvers.adaptive, f, from, states_, t, tolerances);
    states_ = end.x;
    result.outcome = end.outcome;
    result.detail = end.detail;
  }

  /// Warns of jumps of velocities: there the forces are impulses, which no row shows.
  void warn_of_jumps(InverseDynamicsResult& result) const {
    const eom::hybrid::Jumps jumps(scene_.jumps, system_.layout(), scene_.inputs.size(), scene_.parameters,
                                   !scene_.clock.breakpoints.empty());
    if (!jumps.has_time_kinks()) return;
    for (const eom::hybrid::Breakpoint& at : scene_.clock.breakpoints) {
      if (at.before <= scene_.t0 || at.after >= scene_.t1) continue;  // before or behind the motion
      std::vector<double> before, after, x = states_;
      const double side = (at.before + at.after) / 2;
      for (const run::Signal& input : scene_.inputs)
        before.push_back(input(at.before, side)), after.push_back(input(at.after, side));
      const eom::hybrid::Impulse impulse =
          jumps.cross_time_kink({at.before, x, before.data()}, at.after, after.data(), x);
      if (!impulse.undetermined && !impulse.velocities) continue;
      result.outcome = eom::Outcome::jump_undetermined;
      result.detail = impulse.undetermined ? sentence(impulse.undetermined)
                                           : fmt::format(
                                                 "{} jumps at t = {:.15g}: the forces there are an impulse, "
                                                 "which no row shows; make it a motion that takes some time",
                                                 impulse.what.empty() ? "a velocity" : impulse.what, at.after);
      return;
    }
  }

  void write_row(const InverseRequest& request, InverseDynamicsResult& result) const {
    const double side = std::nextafter(t_, scene_.t1 + 1);
    const auto lookup = [&](const symbolic::Symbol& s) { return value_at(t_, side, states_.data(), {}, s); };
    const std::optional<PrescribedFriction::Forces> friction = friction_->at(lookup);
    if (!friction) {
      result.outcome = eom::Outcome::friction_no_solution;
      result.detail = fmt::format("at t = {} no friction forces that fit the motion were found: friction jams it", t_);
      return;
    }
    if (result.detail.empty() && !friction->resting.empty()) {
      result.detail = fmt::format(
          "'{}' is at rest at t = {}, where friction up to the static limit is not determined: rows at rest have none",
          friction->resting.front(), t_);
    }
    const std::vector<double> row = values_at(t_, states_.data(), values_, friction->phi);
    if (request.row) request.row(t_, row);
    if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); })) return;
    result.outcome = eom::Outcome::not_finite;
    result.detail = fmt::format("at t = {} the motion or a force has no value", t_);
  }

  const model::Model& model_;
  mechanics::Mechanics m_;
  system::EquationSystem system_;
  std::optional<PrescribedFriction> friction_;
  run::Scene scene_;
  std::vector<symbolic::Ref> values_;
  double t_ = 0;
  std::vector<double> states_;
};

/// Case that some coordinates are free: integrates the equations of motion.
InverseDynamicsResult along_a_run(const InverseRequest& asked) {
  InverseDynamicsResult result;
  pipeline::SimulationRequest request;
  request.take(asked);
  request.estimate = false;
  request.max_steps = asked.max_steps;
  request.prepare = [&](DerivedModel& derived) {
    const std::vector<std::string> labels = chosen_constraints(derived.mechanics, asked.constraints);
    for (system::EquationSystem& system : derived.candidates)
      result.forces = force_columns(derived.mechanics, system, labels);
    return result.forces;
  };
  std::vector<std::size_t> index;
  request.begin = [&](const DerivedModel& derived, const run::Scene& scene, const std::vector<std::string>& names) {
    result.columns = columns_of(derived.model, result.forces, scene);
    if (asked.begin) asked.begin(scene, result.columns);
    for (const std::string& column : result.columns) {
      index.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin()));
    }
  };
  request.row = [&](double t, std::span<const double> y) {
    std::vector<double> row = mapped(index, [&](std::size_t i) { return y[i]; });
    if (asked.row) asked.row(t, row);
  };
  request.interrupt = asked.interrupt;
  const pipeline::Simulation simulation = pipeline::simulate(request);
  result.certificate = simulation.certificate.summary();
  result.outcome = simulation.result.outcome;
  result.detail = simulation.result.detail;
  return result;
}

}  // namespace

InverseDynamicsResult inverse_dynamics(const InverseRequest& request) {
  mechanics::Mechanics mechanics = mechanics::build_mechanics(request.model);
  return mechanics.free.empty() ? Prescribed(std::move(mechanics)).answer(request) : along_a_run(request);
}

}  // namespace eomgen::analysis
