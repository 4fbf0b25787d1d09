// SPDX-License-Identifier: GPL-3.0-or-later
// A ball above the ground, pulled up by its input: q = z, psi = z. A handwritten model in the form of the C ABI.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <eom/modes/contact_state.hpp>

namespace ball {

using eom::hybrid::Code;
using eom::hybrid::Problem;

inline constexpr double gravity = 10;

/// p[0]: restitution. Outputs: z, z_dot, kinetic, potential, energy, restitution.
inline bool is_open(const int* mode) { return mode[0] >= 3; }
inline int rhs(double, const double* x, const double*, const double* u, const int* mode, double* dx) {
  const double acceleration = is_open(mode) ? u[0] - gravity : 0;
  dx[0] = x[1];
  dx[1] = acceleration;
  return 0;
}
inline int outputs(double, const double* x, const double* p, const double*, const int*, double* y) {
  y[0] = x[0], y[1] = x[1];
  y[2] = x[1] * x[1] / 2, y[3] = gravity * x[0], y[4] = y[2] + y[3], y[5] = p[0];
  return 0;
}
inline int events(double, const double* x, const double*, const double* u, const int* mode, double* g) {
  g[0] = g[1] = g[2] = 0;
  g[3] = is_open(mode) ? x[0] : gravity - u[0];  // the gap; the normal force
  g[4] = 1;
  return 0;
}
inline int mass(double, const double*, const double*, double* M, double* h) {
  M[0] = 1, h[0] = gravity;
  return 0;
}
inline int constraints(double, const double* x, const double*, double* psi, double* A, double* b) {
  psi[0] = x[0], A[0] = 1, b[0] = 0;
  return 0;
}

inline Code code() {
  Code code;
  code.rhs = rhs, code.outputs = outputs, code.events = events, code.mass = mass, code.constraints = constraints;
  code.output_names = {"z", "z_dot", "kinetic", "potential", "energy", "restitution"};
  code.free = {0};
  code.active_constraints = 1;
  code.holonomic = {true};
  code.contacts = {{{0, false, true, false, false}, "ground", 0}};
  return code;
}

inline Problem problem(const Code& code, double restitution) {
  Problem problem;
  problem.code = &code;
  problem.parameters = {restitution};
  problem.t1 = 3;
  problem.start = {1, 0};
  problem.inputs = {{{}, {0}, {0}, {}}};
  problem.solver = "dop853";
  problem.kinetic = 2, problem.potential = 3, problem.energy = 4;
  problem.contacts = {{{}, {}, {}, 0, 5}};
  problem.starts_open = {true};
  problem.state_names = {"z", "z_dot"};
  return problem;
}

}  // namespace ball
