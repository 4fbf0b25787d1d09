// SPDX-License-Identifier: GPL-3.0-or-later
// Hand-made equations of motion for the tests of the program and emit stages, without model reader and formulations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "symbolic/calculus.hpp"
#include "system/equation_system.hpp"

namespace test_systems {

using namespace eomgen;
using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Scalar;
using symbolic::Symbol;
using symbolic::SymbolKind;

/// Symbols of one system under construction.
struct SystemBuilder {
  std::shared_ptr<Dag> dag = std::make_shared<Dag>();

  Scalar s(Ref r) const { return {dag.get(), r}; }
  Scalar t() const { return s(dag->symbol({SymbolKind::time, 0, 0})); }
  Scalar q(std::uint32_t i, std::uint8_t order = 0) const { return s(dag->symbol({SymbolKind::coordinate, i, order})); }
  Scalar p(std::uint32_t i) const { return s(dag->symbol({SymbolKind::parameter, i, 0})); }
  Scalar u(std::uint32_t i) const { return s(dag->symbol({SymbolKind::input, i, 0})); }
  Scalar number(long a, long b = 1) const { return s(dag->constant(symbolic::Rational(a) / b)); }
  Scalar sin(Scalar x) const { return s(dag->call(Op::sin, x.ref)); }
  Scalar cos(Scalar x) const { return s(dag->call(Op::cos, x.ref)); }
  Scalar d(Scalar x, Symbol along) const { return s(symbolic::partial_derivative(*dag, along)(x.ref)); }
  Scalar ddt(Scalar x, std::size_t n) const { return s(symbolic::total_time_derivative(*dag, n, 0, true)(x.ref)); }
};

/// M and f of d/dt dT/dqdot - dT/dq + dV/dq = Q.
inline system::EquationSystem lagrange(const SystemBuilder& k, std::uint32_t n, Scalar T, Scalar V,
                                       std::vector<Scalar> Q) {
  system::EquationSystem system;
  system.dag = k.dag;
  system.formulation = "lagrange";
  for (std::uint32_t i = 0; i < n; ++i) {
    system.free.push_back(i);
    const Scalar momentum = k.d(T, {SymbolKind::coordinate, i, 1});
    for (std::uint32_t j = 0; j < n; ++j) system.M.push_back(k.d(momentum, {SymbolKind::coordinate, j, 1}).ref);
    const Symbol q{SymbolKind::coordinate, i, 0};
    system.f.push_back((Q[i] + k.d(T, q) - k.d(V, q) - k.ddt(momentum, n)).ref);
  }
  system.kinetic = T.ref;
  system.potential = V.ref;
  system.energy = (T + V).ref;
  system.power = k.dag->zero();
  system.outputs = {{"energy", system.energy, system::OutputKind::energy},
                    {"kinetic", T.ref, system::OutputKind::kinetic},
                    {"potential", V.ref, system::OutputKind::potential}};
  return system;
}

/// Adds psi = 0 with its multiplier as constraint `index`.
inline void constrain(system::EquationSystem& system, const SystemBuilder& k, const std::string& label, Scalar psi) {
  const auto n = static_cast<std::uint32_t>(system.free.size());
  const auto index = static_cast<std::uint32_t>(system.active.size());
  const Scalar rate = k.ddt(psi, n);  // A qdot + b
  Scalar b = rate;
  for (std::uint32_t j = 0; j < n; ++j) {
    const Scalar entry = k.d(psi, {SymbolKind::coordinate, j, 0});
    system.A.push_back(entry.ref);
    b = b - entry * k.q(j, 1);
  }
  system.active.push_back(index);
  system.holonomic.push_back(true);
  system.psi.push_back(psi.ref);
  system.b.push_back(k.d(psi, {SymbolKind::time, 0, 0}).ref);
  system.gamma.push_back(k.ddt(rate, n).ref);
  const Ref lambda = k.dag->symbol({SymbolKind::multiplier, index, 0});
  system.reactions.push_back({index, label, lambda});
  system.outputs.push_back({"reaction." + label, lambda, system::OutputKind::constraint_reaction, index});
}

/// Parameters m, l, g; theta from the downward vertical.
inline system::EquationSystem pendulum() {
  const SystemBuilder k;
  const Scalar m = k.p(0), l = k.p(1), g = k.p(2);
  const Scalar T = k.number(1, 2) * m * l * l * k.q(0, 1) * k.q(0, 1);
  return lagrange(k, 1, T, -(m * g * l * k.cos(k.q(0))), {k.number(0)});
}

/// Parameters m1, m2, l1, l2, g; absolute angles; textbook energies.
inline system::EquationSystem double_pendulum() {
  const SystemBuilder k;
  const Scalar m1 = k.p(0), m2 = k.p(1), l1 = k.p(2), l2 = k.p(3), g = k.p(4), w1 = k.q(0, 1), w2 = k.q(1, 1);
  const Scalar half = k.number(1, 2);
  const Scalar T = half * (m1 + m2) * l1 * l1 * w1 * w1 + half * m2 * l2 * l2 * w2 * w2 +
                   m2 * l1 * l2 * w1 * w2 * k.cos(k.q(0) - k.q(1));
  const Scalar V = -((m1 + m2) * g * l1 * k.cos(k.q(0))) - m2 * g * l2 * k.cos(k.q(1));
  return lagrange(k, 2, T, V, {k.number(0), k.number(0)});
}

/// n point masses on massless rods, absolute angles; M = sum J^T m J on velocity Jacobians. Parameters m_1.., l_1.., g.
inline system::EquationSystem chain(std::uint32_t n) {
  const SystemBuilder k;
  Dag& dag = *k.dag;
  const Scalar g = k.p(2 * n);
  system::EquationSystem system;
  system.dag = k.dag;
  system.formulation = "jacobian";
  system.M.assign(n * n, dag.zero());
  system.f.assign(n, dag.zero());
  for (std::uint32_t i = 0; i < n; ++i) system.free.push_back(i);
  Scalar x = k.number(0), y = k.number(0);
  for (std::uint32_t mass = 0; mass < n; ++mass) {
    x = x + k.p(n + mass) * k.sin(k.q(mass));
    y = y - k.p(n + mass) * k.cos(k.q(mass));
    const Scalar m = k.p(mass);
    for (const Scalar& component : {x, y}) {
      std::vector<Scalar> J;
      Scalar bias = k.number(0);
      for (std::uint32_t i = 0; i < n; ++i) {
        J.push_back(k.d(component, {SymbolKind::coordinate, i, 0}));
        bias = bias + k.ddt(J[i], n) * k.q(i, 1);
      }
      const Scalar load = component.ref == y.ref ? -(m * (bias + g)) : -(m * bias);
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          system.M[i * n + j] = dag.add(system.M[i * n + j], (m * J[i] * J[j]).ref);
        }
        system.f[i] = dag.add(system.f[i], (J[i] * load).ref);
      }
    }
  }
  return system;
}

/// A particle on a sphere of radius L(t) = L0 + a sin(w t), Cartesian: parameters m, g, L0, a, w; multiplier "sphere".
inline system::EquationSystem spherical_pendulum() {
  const SystemBuilder k;
  const Scalar m = k.p(0), half = k.number(1, 2);
  Scalar T = k.number(0), square = k.number(0);
  for (std::uint32_t i = 0; i < 3; ++i) {
    T = T + half * m * k.q(i, 1) * k.q(i, 1);
    square = square + k.q(i) * k.q(i);
  }
  auto system = lagrange(k, 3, T, m * k.p(1) * k.q(2), {k.number(0), k.number(0), k.number(0)});
  const Scalar L = k.p(2) + k.p(3) * k.sin(k.p(4) * k.t());
  constrain(system, k, "sphere", k.s(k.dag->call(Op::sqrt, square.ref)) - L);
  return system;
}

/// Cart of mass M with a pendulum (m, l), force F on the cart, damping c. Parameters M, m, l, g, c; input F.
inline system::EquationSystem cart_pendulum() {
  const SystemBuilder k;
  const Scalar M = k.p(0), m = k.p(1), l = k.p(2), g = k.p(3), half = k.number(1, 2), w = k.q(1, 1), v = k.q(0, 1);
  const Scalar T = half * (M + m) * v * v + m * l * v * w * k.cos(k.q(1)) + half * m * l * l * w * w;
  return lagrange(k, 2, T, -(m * g * l * k.cos(k.q(1))), {k.u(0) - k.p(4) * v, k.number(0)});
}

/// Two masses on a line and a massless coordinate z between them that a constraint ties: M alone is singular.
inline system::EquationSystem massless_coordinate() {
  const SystemBuilder k;
  const Scalar m = k.p(0), stiffness = k.p(1), half = k.number(1, 2);
  const Scalar T = half * m * (k.q(0, 1) * k.q(0, 1) + k.q(1, 1) * k.q(1, 1));
  const Scalar z = k.q(2);
  auto system =
      lagrange(k, 3, T, half * stiffness * (z * z + k.q(0) * k.q(0)), {k.number(0), k.number(0), k.number(0)});
  constrain(system, k, "tie", z - k.q(0) * k.q(1));
  return system;
}

}  // namespace test_systems
