// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/system_values.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>

#include <algorithm>

#include "lists.hpp"
#include "oracle/linear_solve.hpp"
#include "oracle/motion.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::verify {

using symbolic::Ref;
using symbolic::SymbolKind;
using system::EquationSystem;

namespace {

// Digits beyond the tolerance that a solve may lose; states with a larger condition are rejected.
constexpr double worst_condition = 1e8;

struct Solved {
  std::vector<std::vector<Real>> inverse;  // absolute values of the columns of [M A^T; A 0]^-1, if requested
  std::vector<Real> qddot, lambda;
  std::vector<Real> psi, A, b, gamma;
  std::vector<Real> M;
  std::vector<Real>
      lost;  // of each row: the size of terms that cancel in the formulation's expressions, from their lost digits
  double condition = 1;
};

std::vector<Ref> concatenate(std::initializer_list<const std::vector<Ref>*> lists) {
  std::vector<Ref> all;
  for (const auto* list : lists) all.insert(all.end(), list->begin(), list->end());
  return all;
}

// Numbers that are far smaller than the largest may be remainders of cancelled terms.
bool may_have_cancelled(const std::vector<Real>& values) {
  Real largest = 0;
  for (const Real& value : values) largest = cln::max(largest, cln::abs(value));
  const Real small = largest / cln::expt(cln::cl_RA(10), cln::cl_I(8));
  return std::any_of(values.begin(), values.end(),
                     [&](const Real& value) { return !cln::zerop(value) && cln::abs(value) < small; });
}

/// Sizes of cancelled terms in each row: a force whose terms cancel keeps their last digits, and an evaluation in more
/// digits shows how large these are.
std::vector<Real> lost_in_rows(const EquationSystem& s, const SymbolValues& lookup, int digits,
                               const std::vector<Real>& value, const Solved& out) {
  constexpr int more = 20;
  const std::size_t n = s.free.size(), m = s.active.size();
  const std::vector<Real> precise =
      symbolic::evaluate(*s.dag, concatenate({&s.M, &s.f, &s.psi, &s.A, &s.b, &s.gamma}), lookup, digits + more);
  const Real size = cln::expt(cln::cl_RA(10), cln::cl_I(digits));
  const auto lost = [&](std::size_t at) { return Real(cln::abs(value[at] - precise[at]) * size); };
  const std::size_t f = n * n, A = f + n + m, gamma = A + m * n + m;
  std::vector<Real> rows;
  for (std::size_t i = 0; i < n; ++i) {
    Real sum = lost(f + i);
    for (std::size_t k = 0; k < n; ++k) sum = sum + lost(i * n + k) * cln::abs(out.qddot[k]);
    for (std::size_t k = 0; k < m; ++k) sum = sum + lost(A + k * n + i) * cln::abs(out.lambda[k]);
    rows.push_back(sum);
  }
  for (std::size_t k = 0; k < m; ++k) {
    Real sum = lost(gamma + k);
    for (std::size_t i = 0; i < n; ++i) sum = sum + lost(A + k * n + i) * cln::abs(out.qddot[i]);
    rows.push_back(sum);
  }
  return rows;
}

/// [M A^T; A 0][qddot; -lambda] = [f; -gamma]
Solved solve_system(const EquationSystem& s, const SymbolValues& lookup, int digits, bool with_inverse) {
  const std::vector<Ref> roots = concatenate({&s.M, &s.f, &s.psi, &s.A, &s.b, &s.gamma});
  const std::vector<Real> value = symbolic::evaluate(*s.dag, roots, lookup, digits);
  auto next = value.begin();
  const auto take = [&](std::size_t count) {
    std::vector<Real> part(next, next + static_cast<std::ptrdiff_t>(count));
    next += static_cast<std::ptrdiff_t>(count);
    return part;
  };
  const std::size_t n = s.free.size(), m = s.active.size(), size = n + m;
  Solved out;
  out.M = take(n * n);
  const std::vector<Real>& M = out.M;
  const std::vector<Real> f = take(n);
  out.psi = take(m), out.A = take(m * n), out.b = take(m), out.gamma = take(m);
  std::vector<Real> matrix(size * size, Real(0));
  std::vector<Real> right = f;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k) matrix[i * size + k] = M[i * n + k];
  for (std::size_t k = 0; k < m; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      matrix[i * size + n + k] = out.A[k * n + i];
      matrix[(n + k) * size + i] = out.A[k * n + i];
    }
    right.push_back(-out.gamma[k]);
  }
  for (std::size_t j = 0; j < s.contacts.size(); ++j) {  // open contacts: lambda = 0 replaces the constraint
    const std::optional<std::uint32_t> k = s.contacts[j].unilateral;
    if (!k || eom::contact_sign(lookup.state.mode, j, 1) > 0) continue;
    for (std::size_t i = 0; i < n; ++i) matrix[(n + *k) * size + i] = 0;
    matrix[(n + *k) * size + n + *k] = 1;
    right[n + *k] = 0;
  }
  Solution solution = solve(std::move(matrix), right, with_inverse);
  out.condition = solution.condition;
  if (!solution.exists() || solution.condition > worst_condition) throw Singular("the mass matrix is nearly singular");
  for (std::size_t i = 0; i < n; ++i) out.qddot.push_back(solution.x()[i]);
  for (std::size_t k = 0; k < m; ++k) out.lambda.push_back(-solution.x()[n + k]);
  // Accelerations that the formulation solves itself count, not those from its matrix.
  if (s.solution) {
    out.qddot = symbolic::evaluate(*s.dag, s.solution->qddot, lookup, digits);
    out.lambda = symbolic::evaluate(*s.dag, s.solution->lambda, lookup, digits);
  }
  out.inverse = std::move(solution.inverse);
  if (with_inverse && (may_have_cancelled(f) || may_have_cancelled(out.M) || may_have_cancelled(out.A) ||
                       may_have_cancelled(out.gamma))) {
    out.lost = lost_in_rows(s, lookup, digits, value, out);
  }
  return out;
}

/// Accelerations of eliminated coordinates from psi_ddot = 0 of their constraints, by the oracle.
void complete_accelerations(const mechanics::Mechanics& mechanics, const Oracle& oracle, State& state) {
  const std::size_t count = mechanics.fixed.size();
  if (count == 0) return;
  const ConstraintValues c = oracle.constraint_values(state);
  std::vector<Real> matrix, right;
  for (const mechanics::FixedCoordinate& row : mechanics.fixed) {
    for (const mechanics::FixedCoordinate& column : mechanics.fixed)
      matrix.push_back(c.gradient[row.constraint][column.coordinate]);
    right.push_back(-c.psi_ddot[row.constraint]);
  }
  const Solution solution = solve(std::move(matrix), std::move(right));
  if (!solution.exists()) throw Singular("the constraints lose rank");
  for (std::size_t i = 0; i < count; ++i) state.qddot[mechanics.fixed[i].coordinate] = solution.x()[i];
}

/// sum_k |K^-1|_ik scale_k for the unknowns of the solve.
std::vector<Real> propagate(const Solved& solved, const std::vector<Real>& row_scale) {
  std::vector<Real> scale(row_scale.size(), Real(0));
  for (std::size_t k = 0; k < scale.size(); ++k)
    for (std::size_t i = 0; i < scale.size(); ++i) scale[i] = scale[i] + solved.inverse[k][i] * row_scale[k];
  return scale;
}

/// A joint or a constraint may carry no load at all: accelerations and multipliers that are 0 up to rounding get a
/// scale relative to the largest ones.
void raise_least(std::vector<Real>& scale, std::size_t accelerations, const Real& share) {
  const auto raise = [&](auto begin, auto end) {
    Real largest = 0;
    for (auto at = begin; at != end; ++at) largest = cln::max(largest, *at);
    for (auto at = begin; at != end; ++at) *at = cln::max(*at, largest * share);
  };
  const auto middle = scale.begin() + static_cast<std::ptrdiff_t>(accelerations);
  raise(scale.begin(), middle);
  raise(middle, scale.end());
}

/// The size of the terms of each equation, including those of the unknowns: the terms M_ik qddot_k may cancel.
std::vector<Real> sizes_of_rows(const EquationSystem& s, const Solved& solved, const SystemValues& v,
                                const std::vector<Real>& qddot, const std::vector<Real>& lambda) {
  const std::size_t n = s.free.size(), m = s.active.size();
  std::vector<Real> sizes;
  for (std::size_t i = 0; i < n; ++i) {
    Real sum = v.rows[s.free[i]].scale;
    for (std::size_t k = 0; k < n; ++k) sum = sum + cln::abs(solved.M[i * n + k] * qddot[k]);
    for (std::size_t k = 0; k < m; ++k) sum = sum + cln::abs(solved.A[k * n + i] * lambda[k]);
    sizes.push_back(sum);
  }
  for (std::size_t k = 0; k < m; ++k) {
    Real sum = cln::abs(solved.gamma[k]);
    for (std::size_t i = 0; i < n; ++i) sum = sum + cln::abs(solved.A[k * n + i] * qddot[i]);
    sizes.push_back(sum);
  }
  for (std::size_t i = 0; i < solved.lost.size(); ++i) sizes[i] = sizes[i] + solved.lost[i];
  return sizes;
}

void add_scales(const EquationSystem& s, const mechanics::Mechanics& mechanics, const Solved& solved, SystemValues& v) {
  const std::size_t n = s.free.size(), m = s.active.size(), all = v.state.q.size();
  const std::vector<Real> row_scale = sizes_of_rows(s, solved, v, solved.qddot, solved.lambda);
  std::vector<Real> unknown = propagate(solved, row_scale);
  v.scale.assign(all + v.lambda.size(), Real(0));
  // For an acceleration that a constraint makes 0, the terms of its own equation cancel.
  for (std::size_t i = 0; i < n; ++i) {
    const Real inertia = cln::abs(solved.M[i * n + i]);
    if (!cln::zerop(inertia)) unknown[i] = unknown[i] + row_scale[i] / inertia;
    v.scale[s.free[i]] = unknown[i];
  }
  const std::vector<Real> accelerations(unknown.begin(), unknown.begin() + static_cast<std::ptrdiff_t>(n));
  std::vector<Real> multipliers(unknown.begin() + static_cast<std::ptrdiff_t>(n), unknown.end());
  // A multiplier may be 0 but for rounding, such as that of a coordinate without inertia: its scale is one of forces.
  const Real share = minimum_relative_scale(*mechanics.model);
  Real largest_force = 0;
  for (std::size_t i = 0; i < n; ++i) largest_force = cln::max(largest_force, row_scale[i]);
  for (Real& multiplier : multipliers) multiplier = cln::max(multiplier, largest_force * share);
  for (std::size_t k = 0; k < m; ++k) v.scale[all + s.active[k]] = multipliers[k];
  const std::vector<Real> sized = sizes_of_rows(s, solved, v, accelerations, multipliers);
  for (std::size_t i = 0; i < n; ++i) v.rows[s.free[i]].scale = sized[i];
  for (const mechanics::FixedCoordinate& fixed : mechanics.fixed) {
    const std::vector<Real>& gradient = v.constraints.gradient[fixed.constraint];
    const Real slope = cln::abs(gradient[fixed.coordinate]);
    Real sum = 0;  // of psi_ddot
    for (std::size_t i = 0; i < all; ++i)
      sum = sum + cln::abs(gradient[i]) * cln::max(cln::abs(v.state.qddot[i]), v.scale[i]);
    v.scale[fixed.coordinate] = sum / slope;
    v.scale[all + fixed.constraint] = v.rows[fixed.coordinate].scale / slope;
  }
  if (!s.active.empty()) raise_least(v.scale, all, share);
}

}  // namespace

SymbolValues::SymbolValues(const Oracle& of, State at)
    : oracle(of), state(std::move(at)), lambda(of.constraints().size(), Real(0)) {
  if (state.z.empty()) state.z = oracle.with_integrals(state);
  const Interpreter now = oracle.interpreter(state);
  for (const std::vector<Jet>& orders : now.environment().functions) {
    functions.emplace_back();
    for (const Jet& jet : orders) functions.back().push_back(jet.real());
  }
}

Real SymbolValues::operator()(const symbolic::Symbol& symbol) const {
  switch (symbol.kind) {
    case SymbolKind::time: return state.t;
    case SymbolKind::coordinate:
      return (symbol.order == 0 ? state.q : symbol.order == 1 ? state.qdot : state.qddot).at(symbol.index);
    case SymbolKind::function: return functions.at(symbol.index).at(symbol.order);
    case SymbolKind::parameter: return state.parameters.at(symbol.index);
    case SymbolKind::input: return state.inputs.at(symbol.index);
    case SymbolKind::multiplier: {
      const std::optional<std::uint32_t> input = oracle.force_input(symbol.index);
      return input ? state.inputs.at(*input) : lambda.at(symbol.index);
    }
    case SymbolKind::integral:
    case SymbolKind::state: return state.z.at(symbol.index);
    case SymbolKind::branch: return 0;  // branches depend on the state
    case SymbolKind::friction: {
      const std::vector<std::uint32_t>& inputs = oracle.contact_inputs().friction;
      return inputs.empty() ? state.phi.at(symbol.index) : state.inputs.at(inputs.at(symbol.index));
    }
    case SymbolKind::contact_mode: return eom::contact_sign(state.mode, symbol.index, symbol.order);
    case SymbolKind::vector:
    case SymbolKind::auxiliary: break;
  }
  throw std::logic_error("verify: a symbol without a value");
}

void solve_accelerations(const EquationSystem& s, SymbolValues& lookup, int digits) {
  const Solved solved = solve_system(s, lookup, digits, false);
  for (std::size_t i = 0; i < s.free.size(); ++i) lookup.state.qddot[s.free[i]] = solved.qddot[i];
  for (std::size_t k = 0; k < s.active.size(); ++k) lookup.lambda[s.active[k]] = solved.lambda[k];
}

SystemValues evaluate_system(const EquationSystem& s, const mechanics::Mechanics& mechanics, const Oracle& oracle,
                             const State& state) {
  SymbolValues lookup(oracle, state);
  const Solved solved = solve_system(s, lookup, oracle.digits(), true);
  for (std::size_t i = 0; i < s.free.size(); ++i) lookup.state.qddot[s.free[i]] = solved.qddot[i];
  for (std::size_t k = 0; k < s.active.size(); ++k) lookup.lambda[s.active[k]] = solved.lambda[k];
  complete_accelerations(mechanics, oracle, lookup.state);
  std::vector<Ref> roots{s.kinetic, s.potential, s.energy, s.power};
  for (const system::Reaction& reaction : s.reactions) roots.push_back(reaction.value);
  for (const system::Output& output : s.outputs) roots.push_back(output.value);
  const std::vector<Real> value = symbolic::evaluate(*s.dag, roots, lookup, oracle.digits());
  SystemValues v;
  v.state = lookup.state;
  v.lambda.assign(oracle.constraints().size(), Real(0));
  v.kinetic = value[0], v.potential = value[1], v.energy = value[2], v.power = value[3];
  for (std::size_t i = 0; i < s.reactions.size(); ++i) v.lambda[s.reactions[i].constraint] = value[4 + i];
  v.outputs.assign(value.begin() + static_cast<std::ptrdiff_t>(4 + s.reactions.size()), value.end());
  v.psi = solved.psi, v.A = solved.A, v.b = solved.b;
  v.condition = solved.condition;
  v.rows = oracle.dalembert_residuals(v.state, v.lambda);
  v.constraints = oracle.constraint_values(v.state);
  add_scales(s, mechanics, solved, v);
  return v;
}

std::string system_name(const EquationSystem& s) { return s.formulation + " " + system::name(s.approach); }

std::vector<Real> right_hand_side(const EquationSystem& s, const Oracle& oracle, const State& state) {
  const SymbolValues lookup(oracle, state);
  const Solved solved = solve_system(s, lookup, oracle.digits(), false);
  std::vector<Real> dx = mapped(s.free, [&](std::uint32_t i) { return state.qdot[i]; });
  dx.insert(dx.end(), solved.qddot.begin(), solved.qddot.end());
  for (const Real& rate : state_rates(s, lookup, oracle.digits())) dx.push_back(rate);
  return dx;
}

std::vector<Real> state_rates(const EquationSystem& s, const SymbolValues& lookup, int digits) {
  std::vector<Ref> rates = mapped(s.states, &system::FirstOrderState::rate);
  return symbolic::evaluate(*s.dag, rates, lookup, digits);
}

Real energy_rate(const EquationSystem& s, const Oracle& oracle, const SystemValues& v, int digits) {
  // In 3 d digits a step of 10^-d makes truncation and rounding errors both 10^-2d. Fast motions take a shorter step,
  // and correspondingly more digits.
  Real fastest = 1;
  for (const std::uint32_t i : s.free)
    fastest = cln::max(fastest, cln::max(cln::abs(v.state.qdot[i]), cln::abs(v.state.qddot[i])));
  const auto bits = cln::float_exponent(cln::cl_float(fastest, cln::float_format(20)));
  const int more = 3 * digits + 10 + static_cast<int>(bits * 3 / 10);
  const Precision precision(more);
  const Real h =
      precision.round(cln::expt(cln::cl_RA(1) / 10, cln::cl_I(digits)) / cln::expt(cln::cl_RA(2), cln::cl_I(bits)));
  const std::vector<Real> rates = state_rates(s, SymbolValues(oracle, v.state), more);
  const auto energy_at = [&](const Real& step) {
    SymbolValues lookup(oracle, v.state);
    State& at = lookup.state;
    at.t = precision.round(at.t) + step;
    for (const std::uint32_t i : s.free) {
      at.q[i] = precision.round(at.q[i]) + step * precision.round(at.qdot[i]);
      at.qdot[i] = precision.round(at.qdot[i]) + step * precision.round(at.qddot[i]);
    }
    for (std::size_t k = 0; k < rates.size(); ++k) {
      Real& value = at.z[s.states[k].symbol.index];
      value = precision.round(value) + step * precision.round(rates[k]);
    }
    return symbolic::evaluate(*s.dag, {s.energy}, lookup, more)[0];
  };
  return (energy_at(h) - energy_at(-h)) / (2 * h);
}

}  // namespace eomgen::verify
