// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/dalembert.hpp"

#include <cln/real.h>

#include <algorithm>
#include <functional>
#include <unordered_set>

#include "model/model.hpp"
#include "oracle/affine_residual_cache.hpp"
#include "oracle/applied_forces.hpp"

namespace eomgen::verify {
namespace {

/// Whether an expression of a Model contains a node, also through definitions and places.
bool uses(const model::Model& model, model::NodeId expression, const std::function<bool(const model::Node&)>& is_it) {
  using model::Op;
  std::vector<model::NodeId> open{expression};
  std::unordered_set<model::NodeId> seen;
  while (!open.empty()) {
    const model::NodeId id = open.back();
    open.pop_back();
    if (id == model::no_node || !seen.insert(id).second) continue;
    const model::Node& node = model.arena[id];
    if (is_it(node)) return true;
    open.insert(open.end(), node.args.begin(), node.args.end());
    switch (node.op) {
      case Op::definition: open.push_back(model.definitions[node.index].expression); break;
      case Op::place:
      case Op::place_velocity:
      case Op::place_acceleration:
      case Op::unit_basis:
      case Op::covariant_basis:
      case Op::contravariant_basis: open.push_back(model.places[node.index].position); break;
      case Op::axis: open.push_back(model.frames[node.index].stages[node.order / 3].e[node.order % 3]); break;
      case Op::angular_velocity:
        if (node.index > 0)
          open.insert(open.end(), model.frames[node.index].stages.back().e.begin(),
                      model.frames[node.index].stages.back().e.end());
        break;
      default: break;
    }
  }
  return false;
}

bool uses(const model::Model& model, model::NodeId expression, model::Op op) {
  return uses(model, expression, [op](const model::Node& node) { return node.op == op; });
}

// Highest derivative of a function of time that an expression can need: a residual needs the second, an expression such
// as ddt(d_ddot) two more.
constexpr std::size_t function_orders = 4;

/// All mixed slopes of `jet` on the levels 1 .. top: the top-th time derivative.
Jet nested_slope(Jet jet, unsigned top) {
  for (unsigned level = top; level >= 1; --level) jet = jet.slope(level, 0);
  return jet;
}

}  // namespace

void Residual::add(const Real& term, const Real& size) {
  value = value + term;
  scale = scale + size;
}

double relative_difference(const Real& difference, const Real& scale) {
  if (cln::zerop(difference)) return 0;
  if (cln::zerop(scale)) return 1;
  const Real quotient = cln::abs(difference) / scale;
  return quotient > cln::expt(cln::cl_RA(10), cln::cl_I(300)) ? 1e300 : cln::double_approx(quotient);
}

double Residual::relative() const { return verify::relative_difference(value, scale); }

Oracle::Oracle(const model::Model& model, int digits) : model_(model), digits_(digits), precision_(digits) {
  for (const model::Constraint& constraint : model.constraints) {
    psi_.insert(psi_.end(), constraint.psi.begin(), constraint.psi.end());
    for (std::size_t k = 0; k < constraint.psi.size(); ++k) holonomic_.push_back(!constraint.is_velocity_equation(k));
  }
  constexpr int rounding = 5;  // digits that large sums may lose
  if (std::any_of(model.states.begin(), model.states.end(), [](const model::State& s) { return s.integral; }))
    quadrature_.emplace(digits - rounding, precision_);
}

bool Oracle::is_independent_parameter(std::size_t index) const {
  return !uses(model_, model_.parameters[index].value, model::Op::parameter);
}

std::vector<Real> Oracle::default_parameters() const {
  std::vector<Real> values;
  for (std::size_t i = 0; i < model_.parameters.size(); ++i) {
    const bool number = is_independent_parameter(i);
    values.push_back(number ? precision_.round(evaluate_constant(model_.parameters[i].value, {})) : Real(0));
  }
  values = parameters(std::move(values));
  for (Real& value : values) value = precision_.round(value);
  return values;
}

// Parameters may depend on one another in any order of the file, without cycles: each round computes some.
std::vector<Real> Oracle::parameters(std::vector<Real> given) const {
  given.resize(model_.parameters.size(), Real(0));
  std::vector<bool> known;
  for (std::size_t i = 0; i < given.size(); ++i) known.push_back(is_independent_parameter(i));
  const auto unknown = [&](const model::Node& node) { return node.op == model::Op::parameter && !known[node.index]; };
  for (std::size_t round = 0; round < given.size(); ++round) {
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (known[i] || uses(model_, model_.parameters[i].value, unknown)) continue;
      given[i] = evaluate_constant(model_.parameters[i].value, given);
      known[i] = true;
    }
  }
  return given;
}

void Oracle::add_functions(Environment& environment, const std::vector<Real>& z, std::size_t orders) const {
  environment.functions.assign(model_.functions.size(), {});
  environment.states.assign(model_.states.size(), {});
  // A function may use others, and integrals, declared before or after it.
  const auto unknown = [&](const model::Node& node) {
    return (node.op == model::Op::function && environment.functions[node.index].empty()) ||
           (node.op == model::Op::integral && environment.states[node.index].empty());
  };
  bool progress = true;
  const auto add = [&](model::NodeId expression, std::vector<Jet>& known) {
    if (!known.empty() || uses(model_, expression, unknown)) return;
    Interpreter now(model_, environment, precision_);
    Interpreter* at = &now;
    std::vector<Jet> found{now.scalar(expression)};
    for (unsigned k = 1; k <= orders; ++k) {
      at = &at->with_time_slope();
      try {
        found.push_back(nested_slope(at->scalar(expression), k));
      } catch (const Error&) {
        break;  // it depends on a derivative of another function: fewer of its own derivatives are known
      }
    }
    known = std::move(found);
    progress = true;
  };
  while (progress) {
    progress = false;
    for (std::size_t i = 0; i < model_.functions.size(); ++i)
      add(model_.functions[i].expression, environment.functions[i]);
    for (std::size_t i = 0; i < z.size(); ++i) {
      std::vector<Jet>& orders_of_state = environment.states[i];
      if (!model_.states[i].integral || !orders_of_state.empty()) continue;
      add(model_.states[i].rate, orders_of_state);  // its rate and further derivatives
      if (!orders_of_state.empty()) orders_of_state.insert(orders_of_state.begin(), Jet(z[i]));
    }
  }
}

void Oracle::add_states(Environment& environment, const std::vector<Real>& z, KinkMargin* margin) const {
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!model_.states[i].integral) environment.states[i] = {Jet(z[i])};
  }
  Interpreter now(model_, environment, precision_, margin);
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (!model_.states[i].integral) environment.states[i].push_back(now.scalar(model_.states[i].rate));
  }
}

Interpreter Oracle::interpreter(const State& state, KinkMargin* margin) const {
  Environment environment;
  environment.t = Jet(state.t);
  for (const Real& value : state.parameters) environment.parameters.emplace_back(value);
  for (const Real& value : state.inputs) environment.inputs.emplace_back(value);
  const std::vector<Real> z = state.z.size() == model_.states.size() ? state.z : with_integrals(state);
  add_functions(environment, z, function_orders);
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    environment.coordinates.push_back({Jet(state.q[i]), Jet(state.qdot[i])});
    if (i < state.qddot.size()) environment.coordinates.back().emplace_back(state.qddot[i]);
  }
  add_states(environment, z, margin);
  return Interpreter(model_, std::move(environment), precision_, margin);
}

// Whether the expression, or a function or integral in it, contains a time derivative.
bool Oracle::needs_derivatives(model::NodeId expression) const {
  bool found = false;
  std::vector<model::NodeId> open{expression};
  std::set<model::NodeId> seen;
  while (!open.empty() && !found) {
    const model::NodeId id = open.back();
    open.pop_back();
    if (!seen.insert(id).second) continue;
    found = uses(model_, id, [&](const model::Node& node) {
      if (node.op == model::Op::function) open.push_back(model_.functions[node.index].expression);
      if (node.op == model::Op::integral) open.push_back(model_.states[node.index].rate);
      return node.order > 0 || node.op == model::Op::total_derivative || node.op == model::Op::partial_derivative;
    });
  }
  return found;
}

Real Oracle::integral_value(std::uint32_t integral, const State& state) const {
  const model::NodeId integrand = model_.states[integral].rate;
  const std::size_t orders = needs_derivatives(integrand) ? function_orders : 0;
  const auto value = [&](const Real& t) {
    State at = state;
    at.t = t;
    Environment environment;
    environment.t = Jet(t);
    for (const Real& parameter : state.parameters) environment.parameters.emplace_back(parameter);
    at.z.assign(integral, Real(0));
    // Integrals inside of this one come before it.
    for (std::uint32_t i = 0; i < integral; ++i) {
      const auto inner = [i](const model::Node& node) { return node.op == model::Op::integral && node.index == i; };
      if (uses(model_, integrand, inner)) at.z[i] = integral_value(i, at);
    }
    add_functions(environment, at.z, orders);
    return Interpreter(model_, std::move(environment), precision_).scalar(integrand).real();
  };
  return (*quadrature_)(value, state.parameters.at(*model_.start_time), state.t);
}

std::vector<Real> Oracle::with_integrals(const State& state) const {
  std::vector<Real> z = state.z;
  z.resize(model_.states.size(), Real(0));
  for (std::uint32_t i = 0; i < z.size(); ++i) {
    if (model_.states[i].integral) z[i] = integral_value(i, state);
  }
  return z;
}

Real Oracle::evaluate(model::NodeId expression, const State& state) const {
  return interpreter(state).scalar(expression).real();
}

Real Oracle::evaluate_constant(model::NodeId expression, const std::vector<Real>& parameters) const {
  Environment environment;
  for (const Real& value : parameters) environment.parameters.emplace_back(value);
  try {
    return Interpreter(model_, std::move(environment), precision_).scalar(expression).real();
  } catch (const std::domain_error& error) {
    throw UndefinedValue(error.what(), place_of(model_, model_.arena[expression]));
  }
}

Oracle::~Oracle() = default;

// Whether two states differ in accelerations and constraint forces at most.
namespace {

bool same(const std::vector<Real>& a, const std::vector<Real>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Real& x, const Real& y) { return cln::equal(x, y); });
}

bool same_place(const State& a, const State& b) {
  return cln::equal(a.t, b.t) && same(a.q, b.q) && same(a.qdot, b.qdot) && same(a.parameters, b.parameters) &&
         same(a.inputs, b.inputs) && same(a.z, b.z);
}

}  // namespace

AffineResidualCache& Oracle::residual_cache(const State& state) const {
  if (!residual_cache_ || !same_place(residual_cache_->state, state))
    residual_cache_ = std::make_unique<AffineResidualCache>(*this, state);
  return *residual_cache_;
}

std::vector<Residual> Oracle::dalembert_residuals(const State& state, const std::vector<Real>& lambda,
                                                  KinkMargin* margin) const {
  AffineResidualCache& at = residual_cache(state);
  std::vector<Residual> sums = at.inertia().multiply(state.qddot);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i].add(at.offset()[i].value, at.offset()[i].scale);
  subtract_friction(state, at.now(), sums);
  // A joint may prevent a rotation that no load drives. Every term of that equation is then rounding error; the least
  // force makes it count as 0 relative to the other equations.
  Real least = 0;
  if (!model_.joints.empty())
    for (const Real& force : lambda) least = cln::max(least, cln::abs(force) / 10000000000u);
  for (std::size_t k = 0; k < psi_.size(); ++k) {
    const std::vector<Real>& f = at.gradient(k);
    const std::optional<std::uint32_t> input = force_input(k);
    const Real& force = input ? state.inputs[*input] : lambda[k];
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (cln::zerop(f[i])) continue;
      sums[i].add(-force * f[i], cln::abs(force * f[i]) + least * cln::abs(f[i]));
    }
  }
  if (margin != nullptr) margin->add(at.margin());
  return sums;
}

void Oracle::subtract_friction(const State& state, Interpreter& now, std::vector<Residual>& sums) const {
  Interpreter& by_q = now.with_coordinate_slopes(false);
  for (const FrictionForce& friction : state.friction) {
    if (friction.place == 0) {
      sums[friction.coordinate].add(-friction.force[0]);
      continue;
    }
    if (friction.body_contact) {
      subtract_contact(*model_.constraints[*friction.body_contact].contact, friction.force, now, sums);
      continue;
    }
    const Vector r = by_q.place(friction.place);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) sums[i].add(-friction.force[k] * r[k].slope(by_q.level(), i).real());
    }
  }
}

// A contact force on a body: at its centre of mass, with its moment about it, F . dr/dq_i + (p x F) . dw/dqdot_i. The
// other body has the opposite force.
void Oracle::subtract_contact(const model::BodyContact& contact, const std::array<Real, 3>& force, Interpreter& now,
                              std::vector<Residual>& sums) const {
  Interpreter& by_q = now.with_coordinate_slopes(false);
  const auto act = [&](std::uint32_t place, std::uint32_t frame, model::NodeId arm, int sign) {
    const Vector F{Jet(sign * force[0]), Jet(sign * force[1]), Jet(sign * force[2])};
    const Vector r = by_q.place(place), moment = cross(now.vector(arm), F);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Vector turn = now.virtual_rotation(frame, i);
      for (std::size_t k = 0; k < 3; ++k) {
        sums[i].add(-F[k].real() * r[k].slope(by_q.level(), i).real());
        sums[i].add(-moment[k].real() * turn[k].real());
      }
    }
  };
  act(contact.place, contact.frame, contact.arm, 1);
  if (contact.other_frame > 0) act(contact.other_place, contact.other_frame, contact.other_arm, -1);
}

ConstraintValues Oracle::constraint_values(const State& state, KinkMargin* margin) const {
  AffineResidualCache& at = residual_cache(state);
  ConstraintValues values;
  for (std::size_t k = 0; k < psi_.size(); ++k) {
    const AffineResidualCache::PathValues& along = at.path_values(k);
    values.psi.push_back(along.psi);
    values.psi_dot.push_back(along.rate);
    values.gradient.push_back(at.gradient(k));
    if (state.qddot.empty()) continue;
    Real second = at.psi_ddot_offset(k);  // at zero acceleration
    for (std::size_t i = 0; i < state.qddot.size(); ++i) {
      const Real& slope = values.gradient.back()[i];
      if (!cln::zerop(slope)) second = second + slope * state.qddot[i];
    }
    values.psi_ddot.push_back(second);
  }
  if (margin != nullptr) margin->add(at.margin());
  return values;
}

EnergyValues Oracle::energy_values(const State& state) const {
  Interpreter now = interpreter(state);
  Interpreter& later = now.with_time_slope();
  EnergyValues sum;
  const auto add = [&](const Jet& term, Real& value, Real& rate) {
    const Real slope = term.slope(later.level(), 0).real();
    value = value + term.real();
    rate = rate + slope;
    sum.scale = sum.scale + cln::abs(term.real());
    sum.rate_scale = sum.rate_scale + cln::abs(slope);
  };
  Interpreter& twice = later.with_time_slope();
  for (const Mass& mass : list_masses(model_)) {
    const Vector v = slope(twice.place(mass.place), twice.level(), 0);
    const Jet half_mass = later.scalar(mass.mass) / 2;
    for (const Jet& component : v) add(half_mass * component * component, sum.kinetic, sum.kinetic_rate);
  }
  for (const model::Body& body : model_.bodies) {
    const Vector w = later.angular_velocity(body.frame), H = inertia_times(body, later, w);
    for (std::size_t k = 0; k < 3; ++k) add(w[k] * H[k] / 2, sum.kinetic, sum.kinetic_rate);
  }
  if (model_.energy.kinetic != model::no_node) {
    const Jet T = later.scalar(model_.energy.kinetic);
    add(T, sum.kinetic, sum.kinetic_rate);
  }
  for (const Jet& term : potentials(model_, precision_, later)) add(term, sum.potential, sum.potential_rate);
  for (const model::State& z : model_.states) {
    if (z.energy != model::no_node) add(later.scalar(z.energy), sum.stored, sum.stored_rate);
  }
  return sum;
}

}  // namespace eomgen::verify
