// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/comparisons.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "oracle/applied_forces.hpp"
#include "oracle/motion.hpp"
#include "symbolic/evaluate.hpp"
#include "verify/code_comparisons.hpp"
#include "verify/friction_law.hpp"
#include "verify/state_comparisons.hpp"
#include "verify/system_values.hpp"

namespace eomgen::verify {
namespace {

using symbolic::Ref;
using system::EquationSystem;

// A state is rejected if the solve loses more than 8 digits; the guard digits and these cover the loss.
constexpr int digits_given_up = 5;

double worst(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::isnan(value) ? 1.0 : std::max(largest, value);
  return largest;
}

/// Accelerations and multipliers of two systems, relative to the terms of the equations.
double difference(const SystemValues& a, const SystemValues& b) {
  const std::size_t n = a.state.qddot.size();
  double largest = 0;
  for (std::size_t i = 0; i < n + a.lambda.size(); ++i) {
    const Real d = i < n ? a.state.qddot[i] - b.state.qddot[i] : a.lambda[i - n] - b.lambda[i - n];
    largest = std::max(largest, relative_difference(d, cln::max(a.scale[i], b.scale[i])));
  }
  return largest;
}

/// Absolute tolerance of a constraint acceleration. The rounding error of an equation that holds identically, and whose
/// derivatives cancel to the last digit, has no other scale. The tolerance is far above rounding in 20 or more digits,
/// and far below any significant derivative.
Real absolute_tolerance(const State& state) {
  Real fastest = 0;
  for (std::size_t i = 0; i < state.qddot.size(); ++i) {
    fastest = cln::max(fastest, cln::max(cln::abs(state.qddot[i]), state.qdot[i] * state.qdot[i]));
  }
  return fastest / cln::expt(cln::cl_RA(10), cln::cl_I(15));
}

/// d'Alembert's residuals and psi_ddot = 0 with the accelerations and multipliers of the system.
double motion_residual(const SystemValues& v) {
  double largest = 0;
  const Real nothing = absolute_tolerance(v.state);
  for (const Residual& row : v.rows) largest = std::max(largest, row.relative());
  for (std::size_t k = 0; k < v.constraints.psi_ddot.size(); ++k) {
    if (v.state.open.contains(k)) continue;
    Residual along;  // A qddot and the remaining terms of psi_ddot
    for (std::size_t i = 0; i < v.state.qddot.size(); ++i) {
      const Real& slope = v.constraints.gradient[k][i];
      along.add(slope * v.state.qddot[i], cln::abs(slope) * cln::max(cln::abs(v.state.qddot[i]), v.scale[i]));
    }
    along.add(v.constraints.psi_ddot[k] - along.value);
    along.add(Real(0), nothing);
    largest = std::max(largest, along.relative());
  }
  return largest;
}

/// psi = 0, A = dpsi/dq (for velocity constraints: their coefficients) and A qdot + b = 0 of the constraints that keep
/// a multiplier.
double constraint_residual(const EquationSystem& s, const SystemValues& v) {
  double largest = 0;
  const std::size_t n = s.free.size();
  for (std::size_t k = 0; k < s.active.size(); ++k) {
    Residual rate;
    Real length = 0, size = 0, fastest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Real& slope = v.constraints.gradient[s.active[k]][s.free[i]];
      length = cln::max(length, cln::abs(slope));
      fastest = cln::max(fastest, cln::abs(v.state.qdot[s.free[i]]));
      size = size + cln::abs(slope * v.state.q[s.free[i]]);
      rate.add(v.A[k * n + i] * v.state.qdot[s.free[i]]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Real slope = v.constraints.gradient[s.active[k]][s.free[i]];
      largest = std::max(largest, relative_difference(v.A[k * n + i] - slope, length));
    }
    rate.add(v.b[k]);
    rate.add(Real(0),
             length * fastest);  // a rate that is 0 up to rounding of cancelled derivatives has no scale of its own
    largest = std::max({largest, relative_difference(v.psi[k] - v.constraints.psi[s.active[k]], size + length),
                        relative_difference(rate.value - v.constraints.psi_dot[s.active[k]], rate.scale)});
    if (!v.state.open.contains(s.active[k]))
      largest = std::max({largest, rate.relative(), relative_difference(v.psi[k], size + length)});
  }
  return largest;
}

void compare_energies(const EquationSystem& s, const SystemValues& v, const Oracle& oracle, ComparisonTable& tally) {
  const EnergyValues e = oracle.energy_values(v.state);
  const std::string name = system_name(s);
  tally.record("energies of " + name, oracle_name, false,
               worst({relative_difference(v.kinetic - e.kinetic, e.scale),
                      relative_difference(v.potential - e.potential, e.scale),
                      relative_difference(v.energy - e.kinetic - e.potential - e.stored, e.scale)}));
  Real scale = e.rate_scale + cln::abs(v.power);  // plus the power of every term of the equations
  for (std::size_t i = 0; i < v.rows.size(); ++i) scale = scale + cln::abs(v.state.qdot[i]) * v.rows[i].scale;
  tally.record("power of " + name, oracle_name, false,
               relative_difference(v.power - e.kinetic_rate - e.potential_rate - e.stored_rate, scale));
  const Real rate = energy_rate(s, oracle, v, oracle.digits() - guard_digits);
  // The difference of two energies has no more digits than these.
  const Real noise = e.scale * cln::expt(cln::cl_RA(1) / 10, cln::cl_I(tally.digits()));
  tally.record("power of " + name, "its energy along the path", true,
               relative_difference(v.power - rate, scale + noise));
}

/// Outputs that the oracle can compute from the model: coordinates, positions, velocities, scalar definitions.
void compare_outputs(const EquationSystem& s, const SystemValues& v, const Oracle& oracle, ComparisonTable& tally) {
  const model::Model& m = oracle.model();
  Interpreter now = oracle.interpreter(v.state);
  Interpreter& later = now.with_time_slope();
  std::map<std::string, std::pair<Real, Real>> expected;  // value, scale
  const auto expect = [&](const std::string& name, const Real& value, const Real& scale) {
    expected[name] = {value, scale};
  };
  for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
    expect(m.coordinates[i].name, v.state.q[i], cln::abs(v.state.q[i]));
    expect(m.coordinates[i].name + "_dot", v.state.qdot[i], cln::abs(v.state.qdot[i]));
  }
  for (std::size_t i = 0; i < m.states.size(); ++i) {
    if (!m.states[i].integral) expect(m.states[i].name, v.state.z[i], cln::abs(v.state.z[i]));
  }
  for (std::uint32_t i = 1; i < m.places.size(); ++i) {
    const Vector r = later.place(i);
    Real length = 0, speed = 0;
    for (const Jet& x : r)
      length = length + cln::abs(x.real()), speed = speed + cln::abs(x.slope(later.level(), 0).real());
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis = std::to_string(k + 1);
      expect(m.places[i].name + ".position" + axis, r[k].real(), length);
      expect(m.places[i].name + ".velocity" + axis, r[k].slope(later.level(), 0).real(), speed);
    }
  }
  for (std::uint32_t f = 1; f < m.frames.size(); ++f) {
    const Vector w = now.angular_velocity(f);
    const Real size = cln::abs(w[0].real()) + cln::abs(w[1].real()) + cln::abs(w[2].real());
    for (std::size_t k = 0; k < 3; ++k)
      expect(m.frames[f].name + ".omega" + std::to_string(k + 1), dot(w, now.axis(f, k)).real(), size);
  }
  for (const model::Definition& definition : m.definitions)
    if (!definition.vector) {
      const Real value = now.scalar(definition.expression).real();
      expect(definition.name, value, cln::abs(value) + 1);
    }
  double largest = 0;
  for (std::size_t i = 0; i < s.outputs.size(); ++i)
    if (const auto found = expected.find(s.outputs[i].name); found != expected.end())
      // eliminated coordinates come from a projection and may be 0 up to rounding
      largest = std::max(largest, relative_difference(v.outputs[i] - found->second.first, found->second.second + 1));
  tally.record("outputs of " + system_name(s), oracle_name, false, largest);
}

/// The largest residual, each relative to the sum of the absolute values of its terms, with unknowns as large as their
/// scales.
double largest_residual(const DisplayForm& form, const symbolic::Dag& dag, const SymbolValues& at, const Motion& motion,
                        const Oracle& oracle) {
  SymbolValues sized = at;
  for (std::size_t i = 0; i < sized.state.qddot.size(); ++i)
    sized.state.qddot[i] = cln::max(cln::abs(at.state.qddot[i]), motion.scale[i]);
  for (std::size_t k = 0; k < sized.lambda.size(); ++k)
    sized.lambda[k] = cln::max(cln::abs(at.lambda[k]), motion.lambda_scale[k]);
  std::vector<Ref> roots;  // of each residual: itself, then its terms
  std::vector<std::size_t> first;
  for (const Ref residual : form.residuals) {
    first.push_back(roots.size());
    roots.push_back(residual);
    top_level_terms(dag, residual, roots);
  }
  first.push_back(roots.size());
  const std::vector<Real> value = symbolic::evaluate(dag, roots, at, oracle.digits());
  const std::vector<Real> size = symbolic::evaluate(dag, roots, sized, oracle.digits());
  double largest = 0;
  for (std::size_t r = 0; r + 1 < first.size(); ++r) {
    Real scale = 0;
    for (std::size_t i = first[r] + 1; i < first[r + 1]; ++i)
      scale = scale + cln::max(cln::abs(value[i]), cln::abs(size[i]));
    largest = std::max(largest, relative_difference(value[first[r]], scale));
  }
  return largest;
}

/// Whether an acceleration enters d'Alembert's principle; the acceleration of a coordinate without inertia follows from
/// the constraints alone.
bool has_inertia(const Oracle& oracle, State at, const std::vector<Real>& lambda, std::uint32_t coordinate,
                 const Real& wrong) {
  const std::vector<Residual> before = oracle.dalembert_residuals(at, lambda);
  at.qddot[coordinate] = wrong;
  const std::vector<Residual> after = oracle.dalembert_residuals(at, lambda);
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (relative_difference(after[i].value - before[i].value, before[i].scale) > 1e-9) return true;
  }
  return false;
}

constexpr long most_exponent = 600;  // of quotients of terms: squares of numbers that binary64 can hold

/// Residuals of the display form for the motion by the oracle. The form also has to detect a wrong acceleration: 0 = 0
/// holds for every motion.
double display_form_residual(const DisplayForm& form, const mechanics::Mechanics& mechanics, const Motion& motion,
                             const Oracle& oracle, bool try_wrong_ones) {
  SymbolValues lookup(oracle, motion.state);
  lookup.lambda = motion.lambda;
  const double largest = largest_residual(form, *mechanics.dag, lookup, motion, oracle);
  for (const std::uint32_t i : mechanics.free) {
    if (!try_wrong_ones) break;
    const Real right = lookup.state.qddot[i];
    const auto is_noticed = [&](const Real& error) {
      lookup.state.qddot[i] = right + error;
      const bool noticed = largest_residual(form, *mechanics.dag, lookup, motion, oracle) > 1e-9;
      lookup.state.qddot[i] = right;
      return noticed;
    };
    // The error is as large as the terms, so that it is not lost among them.
    const Real error = cln::abs(right) + motion.scale[i] + 1;
    if (is_noticed(error) || !has_inertia(oracle, lookup.state, lookup.lambda, i, right + error)) continue;
    // Beside lengths of 1e30 it takes a larger one.
    if (!is_noticed(error * cln::expt(cln::cl_I(10), cln::cl_I(most_exponent)))) return 1;
  }
  return largest;
}

/// A state with arbitrary friction forces: the equations must hold for any of them.
State with_any_friction(const mechanics::Mechanics& mechanics, const Oracle& oracle, const State& at) {
  State state = at;
  std::vector<Real> phi;
  for (const mechanics::Contact& contact : mechanics.contacts) {
    for (std::size_t a = 0; a < contact.dimensions(); ++a) {
      phi.push_back(contact.first_input
                        ? at.inputs.at(*contact.first_input + a)
                        : oracle.precision().round(cln::cl_RA(static_cast<long>(2 * phi.size() + 3)) / 7));
    }
  }
  if (!phi.empty()) set_friction(mechanics, oracle, state, std::move(phi));
  return state;
}

/// The state in `mode`: open contacts are moved off their constraints, along the coordinate with the largest
/// derivative.
State in_mode(const EquationSystem& s, const SystemValues& at, const State& state, const std::vector<int>& mode) {
  State result = state;
  result.mode = mode;
  for (std::size_t j = 0; j < s.contacts.size(); ++j) {
    const std::optional<std::uint32_t> k = s.contacts[j].unilateral;
    if (!k || eom::contact_sign(mode, j, 1) > 0 || eom::contact_sign(state.mode, j, 1) < 0) continue;
    std::size_t steepest = 0;
    const auto slope = [&](std::size_t i) { return at.A[*k * s.free.size() + i]; };
    for (std::size_t i = 1; i < s.free.size(); ++i) {
      if (cln::abs(slope(i)) > cln::abs(slope(steepest))) steepest = i;
    }
    Real& q = result.q[s.free[steepest]];
    q = q + (cln::minusp(slope(steepest)) ? -1 : 1) * (cln::abs(q) + 1) / 16;
  }
  return result;
}

/// The possible modes of a state: contacts that are open in it are not closed. If the motion is prescribed as a
/// whole, sticking friction is not determined, and contacts slide.
std::vector<std::vector<int>> modes_of(const EquationSystem& s, const State& state) {
  std::vector<eom::ContactShape> shapes;
  for (const system::Contact& contact : s.contacts) shapes.push_back(contact.shape());
  constexpr std::size_t enough = 40;
  std::vector<std::vector<int>> modes = eom::contact_modes(shapes, state.open.empty() ? enough : 1000);
  std::erase_if(modes, [&](const std::vector<int>& mode) {
    for (std::size_t j = 0; j < shapes.size(); ++j) {
      if (shapes[j].unilateral && eom::contact_sign(state.mode, j, 1) < 0 && eom::contact_sign(mode, j, 1) > 0)
        return true;
      if (s.free.empty() && s.contacts[j].can_stick() && eom::contact_sign(mode, j, 0) == 0) return true;
    }
    return false;
  });
  if (modes.size() > enough) modes.resize(enough);
  return modes;
}

}  // namespace

void ComparisonTable::record(const std::string& a, const std::string& b, bool shares_code, double relative_difference,
                             Arithmetic arithmetic) {
  const auto same = [&](const Comparison& row) { return row.a == a && row.b == b; };
  auto row = std::find_if(rows_.begin(), rows_.end(), same);
  if (row == rows_.end()) {
    rows_.push_back({a, b, shares_code, 0, 0, 0, true});
    row = rows_.end() - 1;
    row->tolerance =
        arithmetic == Arithmetic::binary64 ? tolerance_binary64 : std::pow(10.0, digits_given_up - digits_);
  }
  row->max_relative_difference = std::max(row->max_relative_difference, relative_difference);
  const double largest = row->max_relative_difference;
  row->pass = largest <= row->tolerance;
  const int digits = largest > 0 ? static_cast<int>(std::floor(-std::log10(largest))) : digits_;
  row->digits_agreed = std::clamp(digits, 0, digits_);
}

void compare_at(const mechanics::Mechanics& mechanics, const Subjects& subjects, const Oracle& oracle, const State& at,
                ComparisonTable& tally) {
  std::vector<SystemValues> values;
  const State state = with_any_friction(mechanics, oracle, at);
  for (const EquationSystem& s : subjects.systems) values.push_back(evaluate_system(s, mechanics, oracle, state));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const EquationSystem& s = subjects.systems[i];
    tally.record(system_name(s), oracle_name, false, motion_residual(values[i]));
    if (!s.active.empty())
      tally.record("constraints of " + system_name(s), oracle_name, false, constraint_residual(s, values[i]));
    compare_energies(s, values[i], oracle, tally);
    compare_outputs(s, values[i], oracle, tally);
    for (std::size_t k = 0; k < i; ++k)
      tally.record(system_name(subjects.systems[k]), system_name(s), true, difference(values[k], values[i]));
  }
  if (!subjects.reading.empty()) {
    const Motion motion = solve_motion(oracle, state);
    for (const DisplayForm& form : subjects.reading)
      if (!form.residuals.empty())
        tally.record(form.name, oracle_name, false,
                     display_form_residual(form, mechanics, motion, oracle, tally.points() == 0));
  }
  if (values.empty()) return;
  const EquationSystem& first = subjects.systems.front();
  compare_states(mechanics, first, values.front(), oracle, tally);
  compare_resets(first, values.front(), oracle, tally);
  if (first.contacts.empty()) return compare_code(subjects, values.front(), oracle, {}, tally);
  for (const std::vector<int>& mode : modes_of(first, state)) {
    State lawful = in_mode(first, values.front(), state, mode);
    set_friction(mechanics, oracle, lawful, solve_friction_law(first, oracle, lawful));
    const SystemValues in_mode = evaluate_system(first, mechanics, oracle, lawful);
    double largest = 0;
    for (const Residual& row : in_mode.rows) largest = std::max(largest, row.relative());
    tally.record("contacts of " + system_name(first), oracle_name, false, largest);
    compare_code(subjects, in_mode, oracle, mode, tally);
  }
}

}  // namespace eomgen::verify
