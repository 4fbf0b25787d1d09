// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/flow.hpp"

#include <algorithm>
#include <eom/layout.hpp>
#include <limits>
#include <span>
#include <type_traits>

#include "linear/flow_numbers.hpp"
#include "model/units.hpp"

namespace eomgen::linear {

using symbolic::SymbolKind;

namespace {

/// A smaller pivot of M and A means that the coordinates are singular: it is the square of the distance from there, in
/// units of the coordinates, and a state is known to 16 digits.
constexpr int smallest_pivot_digits = 24;

constexpr const char* singular_coordinates = "the coordinates are singular there, or too close to where they are";

/// The largest relative change of an acceleration per force by the rounding of a coordinate: A is printed in 7 digits.
constexpr double largest_rounding = 1e-6;

/// The place of a discrete value, which is no entry of the state.
constexpr auto discrete = std::numeric_limits<std::size_t>::max();

/// States that move: discrete values, the last ones, stand still between events.
std::span<const system::FirstOrderState> moving_states(const system::EquationSystem& s) {
  return std::span(s.states).first(s.layout().first_order);
}

std::vector<Symbol> state_symbols(const system::EquationSystem& s) {
  std::vector<Symbol> result;
  for (const std::uint8_t order : {std::uint8_t{0}, std::uint8_t{1}}) {
    for (const std::uint32_t i : s.free) result.push_back({SymbolKind::coordinate, i, order});
  }
  for (const system::FirstOrderState& state : moving_states(s)) {
    if (state.symbol.kind == SymbolKind::state) result.push_back(state.symbol);
  }
  result.push_back({SymbolKind::time, 0, 0});
  return result;
}

}  // namespace

Flow::Flow(mechanics::Mechanics& m, const system::EquationSystem& s, const std::vector<HeldMode>& modes)
    : system_(s), n_(s.free.size()), m_(s.active.size()), held_(s.has_contacts()) {
  Dag& dag = *m.dag;
  for (const model::Input& input : m.model->inputs)
    inputs_ += input.source == model::Input::Source::contacts ? 0 : 1;  // these come last
  place_.assign(m.q.size(), 0);
  for (std::size_t i = 0; i < n_; ++i) place_[s.free[i]] = i;
  // Angles, and coordinates of unknown units, change by 1; lengths by their values alone.
  for (const std::uint32_t i : s.free) {
    const auto& dimension = m.model->coordinates[i].unit.dimension;
    scales_.push_back(dimension && !model::is_one(*dimension) ? 0 : 1);
  }
  for (const char* suffix : {"", "_dot"}) {
    for (const std::uint32_t i : s.free) names_.push_back(m.model->coordinates[i].name + suffix);
  }
  state_place_.assign(m.model->states.size(), discrete);
  std::vector<Ref> rates;  // of the declared states of first order, which come first
  for (const system::FirstOrderState& state : moving_states(s)) {
    if (state.symbol.kind != SymbolKind::state) continue;
    state_place_[state.symbol.index] = names_.size();
    names_.push_back(m.model->states[state.symbol.index].name);
    rates.push_back(state.rate);
  }
  directions_ = state_symbols(s);
  symbols_.assign(directions_.begin(), directions_.end() - 1);
  for (const Symbol& symbol : symbols_) entries_.push_back(dag.symbol(symbol));
  for (std::uint32_t i = 0; i < inputs_; ++i) directions_.push_back({SymbolKind::input, i, 0});
  HeldEquations held;
  if (held_) held = held_equations(m, s, modes);
  contacts_ = std::move(held.contacts);
  for (std::size_t k = 0; k < m_; ++k) {
    if (s.holonomic[k]) holonomic_.push_back(k);
  }
  std::vector<Ref> roots;
  if (held_) {
    roots = held.matrix;
    roots.insert(roots.end(), held.constant.begin(), held.constant.end());
    forces_ = std::move(held.forces);
  } else {
    roots = s.M;
    for (const auto* list : {&s.f, &s.A, &s.gamma, &s.b}) roots.insert(roots.end(), list->begin(), list->end());
    for (const std::size_t k : holonomic_) roots.push_back(s.psi[k]);
    for (const std::uint32_t k : s.active) forces_.push_back({SymbolKind::multiplier, k, 0});
  }
  roots.insert(roots.end(), rates.begin(), rates.end());
  curve_roots_ = roots.size();
  for (const HeldCurve& curve : held.curves) {
    curves_.push_back(curve.name);
    for (std::size_t k = 0; k < 2; ++k) {
      roots.insert(roots.end(), curve.slopes[k].begin(), curve.slopes[k].end());
      roots.push_back(curve.constant[k]);
    }
    roots.insert(roots.end(), curve.gram.begin(), curve.gram.end());
  }
  for (const mechanics::ConstraintIntegral& integral : m.integrals) leaf_.push_back(integral.psi);
  for (const std::size_t k : holonomic_) phi_expressions_.push_back(s.psi[k]);
  phi_expressions_.insert(phi_expressions_.end(), held.gaps.begin(), held.gaps.end());
  phi_expressions_.insert(phi_expressions_.end(), leaf_.begin(), leaf_.end());
  position_constraints_ = phi_expressions_.size();
  for (std::size_t k = 0; k < m_; ++k) {
    Ref rate = s.b[k];
    for (std::size_t i = 0; i < n_; ++i) rate = dag.add(rate, dag.mul(s.A[k * n_ + i], m.qdot[s.free[i]]));
    phi_expressions_.push_back(rate);
  }
  for (const auto* list : {&held.gap_rates, &held.slips})
    phi_expressions_.insert(phi_expressions_.end(), list->begin(), list->end());
  const std::vector<Symbol> symbols = dag.symbols(roots);
  uses_integrals_ =
      std::any_of(symbols.begin(), symbols.end(), [](const Symbol& x) { return x.kind == SymbolKind::integral; });
  tape_ = std::make_unique<Tape>(dag, roots, directions_);
  std::vector<Ref> of_constraints = held_ ? phi_expressions_ : s.A;
  if (!held_) {
    of_constraints.insert(of_constraints.end(), s.b.begin(), s.b.end());
    for (const std::size_t k : holonomic_) of_constraints.push_back(s.psi[k]);
  }
  constraint_tape_ = std::make_unique<Tape>(dag, of_constraints, directions_);
  leaf_tape_ = std::make_unique<Tape>(dag, leaf_, directions_);
}

template <class T>
std::function<T(const Symbol&)> Flow::lookup(const State<T>& z, const Setting<T>& setting) const {
  return [this, &z, &setting](const Symbol& s) -> T {
    switch (s.kind) {
      case SymbolKind::parameter: return setting.parameters[s.index];
      case SymbolKind::input: return setting.inputs[s.index];
      case SymbolKind::integral: return setting.held[s.index];
      case SymbolKind::state:
        return state_place_[s.index] == discrete ? setting.held[s.index] : z[state_place_[s.index]];
      case SymbolKind::time: return z[entries()];
      case SymbolKind::auxiliary: return setting.curves[s.index];
      case SymbolKind::coordinate:
        if (s.order < 2) return z[place_[s.index] + (s.order == 0 ? 0 : n_)];
        break;
      default: break;
    }
    throw std::logic_error("the equations of motion leave a symbol open");
  };
}

Tape Flow::tape(std::vector<Ref> expressions) const {
  return {*system_.dag, std::move(expressions), state_symbols(system_)};
}

template <class T>
std::vector<T> Flow::leaf(const State<T>& z, const Setting<T>& setting) const {
  return leaf_tape_->values<T>(lookup(z, setting));
}

template <class T>
Field<T> Flow::at(const State<T>& z, const Setting<T>& setting) const {
  Field<T> field;
  if (held_) {
    differentiate_held(held_values(z, setting), z, field);
    constrain_held(z, setting, field);
    return field;
  }
  const ValueAndJacobian<T> s = value_and_jacobian(*tape_, z, setting);
  differentiate(s, z, field);
  const std::size_t A0 = n_ * n_ + n_, b0 = A0 + m_ * n_ + m_;
  constrain(s, {A0, b0, b0 + m_}, z, setting, field);
  return field;
}

template <class T>
Field<T> Flow::constraints_at(const State<T>& z, const Setting<T>& setting) const {
  Field<T> field;
  if (held_) {
    constrain_held(z, setting, field);
    return field;
  }
  constrain(value_and_jacobian(*constraint_tape_, z, setting), {0, m_ * n_, m_ * n_ + m_}, z, setting, field);
  return field;
}

/// K = [M, -A^T; A, 0].
template <class T>
Matrix<T> Flow::matrix(const ValueAndJacobian<T>& s) const {
  const std::size_t A0 = n_ * n_ + n_;
  Matrix<T> K(n_ + m_, n_ + m_);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) K(i, j) = s.value[i * n_ + j];
  }
  for (std::size_t k = 0; k < m_; ++k) {
    for (std::size_t i = 0; i < n_; ++i) {
      K(n_ + k, i) = s.value[A0 + k * n_ + i];
      K(i, n_ + k) = -s.value[A0 + k * n_ + i];
    }
  }
  return K;
}

// K (a, lambda) = (f, -gamma), and along every direction d K (a', lambda') = (f' - M' a + A'^T lambda, -gamma' - A' a).
// The elimination drops redundant rows of A.
template <class T>
void Flow::differentiate(const ValueAndJacobian<T>& s, const State<T>& z, Field<T>& field) const {
  const std::size_t size = n_ + m_, f0 = n_ * n_, A0 = f0 + n_, gamma0 = A0 + m_ * n_;
  const Matrix<T> K = matrix(s);
  Matrix<T> right(size, 1), A(m_, n_);
  for (std::size_t i = 0; i < n_; ++i) right(i, 0) = s.value[f0 + i];
  for (std::size_t k = 0; k < m_; ++k) {
    for (std::size_t i = 0; i < n_; ++i) A(k, i) = s.value[A0 + k * n_ + i];
    right(n_ + k, 0) = -s.value[gamma0 + k];
  }
  const Elimination<T> solver(K, singular<T>());
  require_domain(solver.rank() == n_ + Elimination<T>(A, singular<T>()).rank(), "the accelerations are not determined");
  if constexpr (std::is_same_v<T, Precise>) {
    require_domain(solver.smallest_pivot() > tiny<Precise>(smallest_pivot_digits), singular_coordinates);
  }
  const Matrix<T> y = solver.solve(right);
  std::vector<T> force;  // of the constraints, on the side of f
  for (std::size_t k = 0; k < m_; ++k) force.push_back(-y(n_ + k, 0));
  const std::size_t count = directions_.size();
  Matrix<T> rates(size, count);
  for (std::size_t d = 0; d < count; ++d) {
    for (std::size_t i = 0; i < n_; ++i) {
      T sum = s.jacobian(f0 + i, d);
      for (std::size_t j = 0; j < n_; ++j) subtract(sum, s.jacobian(i * n_ + j, d), y(j, 0));
      for (std::size_t k = 0; k < m_; ++k) subtract(sum, s.jacobian(A0 + k * n_ + i, d), force[k]);
      rates(i, d) = sum;
    }
    for (std::size_t k = 0; k < m_; ++k) {
      T sum = -s.jacobian(gamma0 + k, d);
      for (std::size_t j = 0; j < n_; ++j) subtract(sum, s.jacobian(A0 + k * n_ + j, d), y(j, 0));
      rates(n_ + k, d) = sum;
    }
  }
  const Matrix<T> jacobian = solver.solve(rates);
  fill(y, jacobian, z, field);
  fill_first_order(s, gamma0 + 2 * m_ + holonomic_.size(), field);
  if constexpr (std::is_same_v<T, double>) {
    const std::size_t N = entries();
    field.inertia_force = Matrix<T>(n_, 1);
    field.inertia_force_jacobian = Matrix<T>(n_, N + 1);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) {
        field.inertia_force(i, 0) += s.value[i * n_ + j] * y(j, 0);
        for (std::size_t d = 0; d < N + 1; ++d)
          field.inertia_force_jacobian(i, d) +=
              s.jacobian(i * n_ + j, d) * y(j, 0) + s.value[i * n_ + j] * jacobian(j, d);
      }
    }
  }
}

// A force along a coordinate gives it the acceleration P = e^T K^-1 e. With K^-1 e = (a, lambda), P' = -a^T M' a +
// 2 lambda^T A' a. Near a pole of angles at a distance d it is 1/d^2, of which the rounding of the angle leaves no
// digit.
void Flow::require_regular(const State<Precise>& z, const Setting<Precise>& setting) const {
  if (held_) return;
  const ValueAndJacobian<Precise> s = value_and_jacobian(*tape_, z, setting);
  const Elimination<Precise> solver(matrix(s), singular<Precise>());
  const auto precise = [](double value) { return Precise(cln::cl_float(value, precise_format())); };
  const std::size_t A0 = n_ * n_ + n_;
  for (std::size_t along = 0; along < n_; ++along) {
    Matrix<Precise> unit(n_ + m_, 1);
    unit(along, 0) = Precise(1);
    const Matrix<Precise> moved = solver.solve(unit);
    // Constraints that hold the coordinate make P small beside the inverse of its inertia; singular ones make it large.
    if (magnitude(Precise(s.value[along * n_ + along] * moved(along, 0))) < tiny<Precise>(6)) continue;
    for (std::size_t d = 0; d < n_; ++d) {
      Precise change(0);
      for (std::size_t i = 0; i < n_; ++i) {
        if (is_zero(moved(i, 0))) continue;
        for (std::size_t j = 0; j < n_; ++j)
          subtract(change, s.jacobian(i * n_ + j, d), Precise(moved(i, 0) * moved(j, 0)));
        for (std::size_t k = 0; k < m_; ++k)
          subtract(change, s.jacobian(A0 + k * n_ + i, d), Precise(-2 * moved(n_ + k, 0) * moved(i, 0)));
      }
      const Precise rounding =
          precise(std::numeric_limits<double>::epsilon()) * std::max(precise(scales_[d]), magnitude(z[d]));
      require_domain(magnitude(change) * rounding <= magnitude(moved(along, 0)) * precise(largest_rounding),
                     singular_coordinates);
    }
  }
}

/// Velocities, accelerations and forces: y = (accelerations, forces), with their derivatives.
template <class T>
void Flow::fill(const Matrix<T>& y, const Matrix<T>& jacobian, const State<T>& z, Field<T>& field) const {
  const std::size_t N = entries(), count = directions_.size();
  field.X = Matrix<T>(N, 1);
  field.jacobian = Matrix<T>(N, N + 1);
  field.input_jacobian = Matrix<T>(N, inputs_);
  for (std::size_t i = 0; i < n_; ++i) {
    field.X(i, 0) = z[n_ + i];
    field.X(n_ + i, 0) = y(i, 0);
    field.jacobian(i, n_ + i) = T(1);
    for (std::size_t d = 0; d < N + 1; ++d) field.jacobian(n_ + i, d) = jacobian(i, d);
    for (std::size_t u = 0; u < inputs_; ++u) field.input_jacobian(n_ + i, u) = jacobian(i, N + 1 + u);
  }
  field.forces = Matrix<T>(forces_.size(), 1);
  field.force_jacobian = Matrix<T>(forces_.size(), count);
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    field.forces(k, 0) = y(n_ + k, 0);
    for (std::size_t d = 0; d < count; ++d) field.force_jacobian(k, d) = jacobian(n_ + k, d);
  }
}

/// The states of first order: their rates begin at `rates` of s.
template <class T>
void Flow::fill_first_order(const ValueAndJacobian<T>& s, std::size_t rates, Field<T>& field) const {
  const std::size_t N = entries(), first_order = eom::StateLayout{n_}.first_order_begin();
  for (std::size_t k = 0; first_order + k < N; ++k) {
    field.X(first_order + k, 0) = s.value[rates + k];
    for (std::size_t d = 0; d < N + 1; ++d) field.jacobian(first_order + k, d) = s.jacobian(rates + k, d);
    for (std::size_t u = 0; u < inputs_; ++u)
      field.input_jacobian(first_order + k, u) = s.jacobian(rates + k, N + 1 + u);
  }
}

template <class T>
void Flow::constrain(const ValueAndJacobian<T>& s, const Places& places, const State<T>& z, const Setting<T>& setting,
                     Field<T>& field) const {
  const auto [A0, b0, psi0] = places;
  const std::size_t width = entries() + 1;
  const std::size_t h = holonomic_.size(), rows = position_constraint_count() + m_;
  field.phi = Matrix<T>(rows, 1);
  field.phi_jacobian = Matrix<T>(rows, width);
  for (std::size_t k = 0; k < h; ++k) {
    field.phi(k, 0) = s.value[psi0 + k];
    for (std::size_t d = 0; d < width; ++d) field.phi_jacobian(k, d) = s.jacobian(psi0 + k, d);
  }
  if (!leaf_.empty()) {
    const ValueAndJacobian<T> leaf = value_and_jacobian(*leaf_tape_, z, setting);
    for (std::size_t k = 0; k < leaf_.size(); ++k) {
      field.phi(h + k, 0) = leaf.value[k] - setting.leaf.at(k);
      for (std::size_t d = 0; d < width; ++d) field.phi_jacobian(h + k, d) = leaf.jacobian(k, d);
    }
  }
  for (std::size_t k = 0; k < m_; ++k) {
    const std::size_t row = position_constraint_count() + k;
    field.phi(row, 0) = s.value[b0 + k];
    for (std::size_t d = 0; d < width; ++d) field.phi_jacobian(row, d) = s.jacobian(b0 + k, d);
    for (std::size_t i = 0; i < n_; ++i) {
      field.phi(row, 0) = field.phi(row, 0) + s.value[A0 + k * n_ + i] * z[n_ + i];
      for (std::size_t d = 0; d < width; ++d)
        if (!is_zero(s.jacobian(A0 + k * n_ + i, d)))
          field.phi_jacobian(row, d) = field.phi_jacobian(row, d) + s.jacobian(A0 + k * n_ + i, d) * z[n_ + i];
      field.phi_jacobian(row, n_ + i) = field.phi_jacobian(row, n_ + i) + s.value[A0 + k * n_ + i];
    }
  }
}

template Field<double> Flow::at(const State<double>&, const Setting<double>&) const;
template Field<Precise> Flow::at(const State<Precise>&, const Setting<Precise>&) const;
template Field<double> Flow::constraints_at(const State<double>&, const Setting<double>&) const;
template Field<Precise> Flow::constraints_at(const State<Precise>&, const Setting<Precise>&) const;
template std::vector<double> Flow::leaf(const State<double>&, const Setting<double>&) const;
template std::vector<Precise> Flow::leaf(const State<Precise>&, const Setting<Precise>&) const;
template std::function<double(const Symbol&)> Flow::lookup(const State<double>&, const Setting<double>&) const;
template std::function<Precise(const Symbol&)> Flow::lookup(const State<Precise>&, const Setting<Precise>&) const;

}  // namespace eomgen::linear
