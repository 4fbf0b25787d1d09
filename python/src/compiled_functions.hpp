// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of eomgen._core.CompiledModel: names, help and shapes. To add one: an entry of `functions`.
#pragma once

#include <array>
#include <cstddef>
#include <eomgen/compiled_model.hpp>
#include <vector>

namespace eomgen::python {

using Arguments = CompiledModel::Arguments;

enum class Size {
  none,
  states,
  states_twice,
  coordinates,
  parameters,
  inputs,
  constraints,
  reactions,
  outputs,
  events,
  energies,        // T, U
  slopes,          // by q, then by qdot
  poses,           // 12 of each frame
  twist,           // linear and angular
  twists,          // of each frame
  frame_tangents,  // of each frame by each coordinate
  inertial,        // inertial parameters
  momentum,        // of a model with masses, else 0
  position,        // of a model with masses, else 0
};

inline std::size_t value_of(Size size, const CompiledModel& model) {
  switch (size) {
    case Size::states: return model.states().size();
    case Size::states_twice: return 2 * model.states().size();
    case Size::coordinates: return model.coordinate_count();
    case Size::parameters: return model.parameters().size();
    case Size::inputs: return model.inputs().size();
    case Size::constraints: return model.constraints().size();
    case Size::reactions: return model.reactions().size();
    case Size::outputs: return model.outputs().size();
    case Size::events: return model.event_count();
    case Size::energies: return 2;
    case Size::slopes: return 2 * model.coordinate_count();
    case Size::poses: return 12 * model.frames().size();
    case Size::twist: return 6;
    case Size::twists: return 6 * model.frames().size();
    case Size::frame_tangents: return model.coordinate_count() * model.frames().size();
    case Size::inertial: return model.inertial_parameters().size();
    case Size::momentum: return model.has_masses() ? 6 : 0;
    case Size::position: return model.has_masses() ? 3 : 0;
    case Size::none: break;
  }
  return 1;
}

/// A vector, or a matrix that the library stores by columns.
struct ResultShape {
  Size rows = Size::none, columns = Size::none;
};

inline constexpr std::size_t most_results = 3;

struct Function {
  const char* name;      // of the method
  const char* compiled;  // of the function that has to be compiled
  const char* doc;
  std::size_t count;  // of results
  std::array<ResultShape, most_results> results;
  int (*evaluate)(const CompiledModel& model, const Arguments& at, double* const* results);
  Size vector = Size::none;  // length of the argument v, if the function takes it
};

/// The derivatives by time, which come with those by the state.
inline int outputs_jac_t(const CompiledModel& model, const Arguments& at, double* const* results) {
  thread_local std::vector<double> dydx;
  dydx.resize(model.outputs().size() * model.states().size());
  return model.outputs_jac(at, dydx.data(), results[0]);
}
inline int reactions_jac_t(const CompiledModel& model, const Arguments& at, double* const* results) {
  thread_local std::vector<double> dldx;
  dldx.resize(model.reactions().size() * model.states().size());
  return model.reactions_jac(at, dldx.data(), results[0]);
}
inline int momenta_jac_t(const CompiledModel& model, const Arguments& at, double* const* results) {
  thread_local std::vector<double> dmdx;
  dmdx.resize(2 * model.coordinate_count() * model.states().size());
  return model.momenta_jac(at, dmdx.data(), results[0]);
}

inline int jac_t(const CompiledModel& model, const Arguments& at, double* const* results) {
  thread_local std::vector<double> dfdx;
  dfdx.resize(model.states().size() * model.states().size());
  return model.jac(at, dfdx.data(), results[0]);
}

#define EOMGEN_VECTOR_ARGUMENTS "(t, x, v, inputs=None, parameters=None, mode=None)\n--\n\n"
#define EOMGEN_ARGUMENTS "(t, x, inputs=None, parameters=None, mode=None)\n--\n\n"

inline constexpr std::array functions{
    Function{
        "rhs",
        "rhs",
        "rhs" EOMGEN_ARGUMENTS "dx/dt: (N,), or (K, N) of K states.\n\n"
        "t in s: a number or (K,). x: (N,) or (K, N). inputs: (U,), (K, U), or a function of (t, x) that returns\n"
        "them; None: those of the scene. parameters: (P,) or (K, P); None: those of the scene. mode: states of\n"
        "contacts and kinks (docs/abi.md), integers; None: all are 0. One singular state raises Error; among many\n"
        "states it gives NaN.",
        1,
        {{{Size::states}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.rhs(at, r[0]); }},
    Function{"jac",
             "jac",
             "jac" EOMGEN_ARGUMENTS "d(dx/dt)/dx at fixed inputs: (N, N), or (K, N, N). Arguments as of rhs.",
             1,
             {{{Size::states, Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac(at, r[0], nullptr); }},
    Function{"jac_t",
             "jac",
             "jac_t" EOMGEN_ARGUMENTS "d(dx/dt)/dt at fixed x and inputs: (N,), or (K, N). Arguments as of rhs.",
             1,
             {{{Size::states}}},
             jac_t},
    Function{"jac_p",
             "jac_p",
             "jac_p" EOMGEN_ARGUMENTS "d(dx/dt)/d(parameters): (N, P), or (K, N, P). Arguments as of rhs.",
             1,
             {{{Size::states, Size::parameters}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac_p(at, r[0]); }},
    Function{"jac_u",
             "jac_u",
             "jac_u" EOMGEN_ARGUMENTS "d(dx/dt)/d(inputs): (N, U), or (K, N, U). Arguments as of rhs.",
             1,
             {{{Size::states, Size::inputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac_u(at, r[0]); }},
    Function{"jvp",
             "jvp",
             "jvp" EOMGEN_VECTOR_ARGUMENTS "jac(t, x) v without the matrix: (N,), or (K, N).\n\n"
             "v: (N,), or (K, N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jvp(at, r[0]); },
             Size::states},
    Function{"vjp",
             "vjp",
             "vjp" EOMGEN_VECTOR_ARGUMENTS "v^T jac(t, x) without the matrix: (N,), or (K, N).\n\n"
             "v: (N,), or (K, N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.vjp(at, r[0]); },
             Size::states},
    Function{
        "adjoint",
        "adjoint",
        "adjoint" EOMGEN_VECTOR_ARGUMENTS
        "(v^T jac, v^T jac_p, v^T jac_u) at once: (N,), (P,), (U,), or with K in front.\n\n"
        "v: (N,), or (K, N). Other arguments as of rhs.",
        3,
        {{{Size::states}, {Size::parameters}, {Size::inputs}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.adjoint(at, r[0], r[1], r[2]); },
        Size::states},
    Function{"hvp",
             "hvp",
             "hvp" EOMGEN_VECTOR_ARGUMENTS "d^2(c^T dx/dt)/dx^2 d: (N,), or (K, N).\n\n"
             "v: c, then d: (2 N,), or (K, 2 N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.hvp(at, r[0]); },
             Size::states_twice},
    Function{"inverse",
             "inverse",
             "inverse" EOMGEN_VECTOR_ARGUMENTS
             "Inverse dynamics: M v + h, the forces that the accelerations v need besides those of the model and its\n"
             "inputs, without reactions: (n,), or (K, n).\n\nv: (n,), or (K, n). Other arguments as of rhs.",
             1,
             {{{Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.inverse(at, r[0]); },
             Size::coordinates},
    Function{
        "regressor",
        "regressor",
        "regressor" EOMGEN_VECTOR_ARGUMENTS
        "(Y, inertial): Y inertial are the forces of inertia and uniform gravity at the accelerations v, (n, I), and\n"
        "the inertial parameters in the order of inertial_parameter_names, (I,); or with K in front.\n\n"
        "v: (n,), or (K, n). Other arguments as of rhs.",
        2,
        {{{Size::coordinates, Size::inertial}, {Size::inertial}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.regressor(at, r[0], r[1]); },
        Size::coordinates},
    Function{"coriolis",
             "coriolis",
             "coriolis" EOMGEN_ARGUMENTS
             "C of C qdot by Christoffel symbols of M, so that dM/dt - 2 C is skew: (n, n), or (K, n, n).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::coordinates, Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.coriolis(at, r[0]); }},
    Function{"gravity",
             "gravity",
             "gravity" EOMGEN_ARGUMENTS "dU/dq of the potential energy: (n,), or (K, n). Arguments as of rhs.",
             1,
             {{{Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.gravity(at, r[0]); }},
    Function{
        "mass",
        "mass",
        "mass" EOMGEN_ARGUMENTS
        "(M, h) of M qddot + h = A^T lambda, h with the default inputs: (n, n) and (n,), or (K, n, n) and (K, n).\n"
        "Arguments as of rhs.",
        2,
        {{{Size::coordinates, Size::coordinates}, {Size::coordinates}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.mass(at, r[0], r[1]); }},
    Function{
        "momenta",
        "momenta",
        "momenta" EOMGEN_ARGUMENTS
        "(p, rates): dL/d(qdot) and their rates without constraint forces: (n,) each, or (K, n). Arguments as of rhs.",
        2,
        {{{Size::coordinates}, {Size::coordinates}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momenta(at, r[0], r[1]); }},
    Function{
        "momenta_jac",
        "momenta_jac",
        "momenta_jac" EOMGEN_ARGUMENTS "d(p, rates)/dx at fixed inputs: (2 n, N), or (K, 2 n, N). Arguments as of rhs.",
        1,
        {{{Size::slopes, Size::states}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momenta_jac(at, r[0], nullptr); }},
    Function{"momenta_jac_t",
             "momenta_jac",
             "momenta_jac_t" EOMGEN_ARGUMENTS
             "d(p, rates)/dt at fixed x and inputs: (2 n,), or (K, 2 n). Arguments as of rhs.",
             1,
             {{{Size::slopes}}},
             momenta_jac_t},
    Function{"momenta_jac_p",
             "momenta_jac_p",
             "momenta_jac_p" EOMGEN_ARGUMENTS
             "d(p, rates)/d(parameters): (2 n, P), or (K, 2 n, P). Arguments as of rhs.",
             1,
             {{{Size::slopes, Size::parameters}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momenta_jac_p(at, r[0]); }},
    Function{"momenta_jac_u",
             "momenta_jac_u",
             "momenta_jac_u" EOMGEN_ARGUMENTS "d(p, rates)/d(inputs): (2 n, U), or (K, 2 n, U). Arguments as of rhs.",
             1,
             {{{Size::slopes, Size::inputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momenta_jac_u(at, r[0]); }},
    Function{"constraints",
             "constraints",
             "constraints" EOMGEN_ARGUMENTS
             "(psi, A, b) of psi = 0 and A qdot + b = 0: (m,), (m, n), (m,), or with K in front. Arguments as of rhs.",
             3,
             {{{Size::constraints}, {Size::constraints, Size::coordinates}, {Size::constraints}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) {
               return f.constraints(at, r[0], r[1], r[2]);
             }},
    Function{
        "reactions",
        "reactions",
        "reactions" EOMGEN_ARGUMENTS
        "The multipliers of all constraints, in the order of reaction_names: (R,), or (K, R). Arguments as of rhs.",
        1,
        {{{Size::reactions}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.reactions(at, r[0]); }},
    Function{"reactions_jac",
             "reactions_jac",
             "reactions_jac" EOMGEN_ARGUMENTS
             "d(reactions)/dx at fixed inputs: (R, N), or (K, R, N). Arguments as of rhs.",
             1,
             {{{Size::reactions, Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) {
               return f.reactions_jac(at, r[0], nullptr);
             }},
    Function{"reactions_jac_t",
             "reactions_jac",
             "reactions_jac_t" EOMGEN_ARGUMENTS
             "d(reactions)/dt at fixed x and inputs: (R,), or (K, R). Arguments as of rhs.",
             1,
             {{{Size::reactions}}},
             reactions_jac_t},
    Function{"reactions_jac_p",
             "reactions_jac_p",
             "reactions_jac_p" EOMGEN_ARGUMENTS
             "d(reactions)/d(parameters): (R, P), or (K, R, P). Arguments as of rhs.",
             1,
             {{{Size::reactions, Size::parameters}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.reactions_jac_p(at, r[0]); }},
    Function{"reactions_jac_u",
             "reactions_jac_u",
             "reactions_jac_u" EOMGEN_ARGUMENTS "d(reactions)/d(inputs): (R, U), or (K, R, U). Arguments as of rhs.",
             1,
             {{{Size::reactions, Size::inputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.reactions_jac_u(at, r[0]); }},
    Function{"outputs",
             "outputs",
             "outputs" EOMGEN_ARGUMENTS
             "The outputs, in the order of output_names and in the units of output_units: (Y,), or (K, Y).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::outputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.outputs(at, r[0]); }},
    Function{
        "outputs_jac",
        "outputs_jac",
        "outputs_jac" EOMGEN_ARGUMENTS "d(outputs)/dx at fixed inputs: (Y, N), or (K, Y, N). Arguments as of rhs.",
        1,
        {{{Size::outputs, Size::states}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.outputs_jac(at, r[0], nullptr); }},
    Function{"outputs_jac_t",
             "outputs_jac",
             "outputs_jac_t" EOMGEN_ARGUMENTS
             "d(outputs)/dt at fixed x and inputs: (Y,), or (K, Y). Arguments as of rhs.",
             1,
             {{{Size::outputs}}},
             outputs_jac_t},
    Function{"outputs_jac_p",
             "outputs_jac_p",
             "outputs_jac_p" EOMGEN_ARGUMENTS "d(outputs)/d(parameters): (Y, P), or (K, Y, P). Arguments as of rhs.",
             1,
             {{{Size::outputs, Size::parameters}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.outputs_jac_p(at, r[0]); }},
    Function{"outputs_jac_u",
             "outputs_jac_u",
             "outputs_jac_u" EOMGEN_ARGUMENTS "d(outputs)/d(inputs): (Y, U), or (K, Y, U). Arguments as of rhs.",
             1,
             {{{Size::outputs, Size::inputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.outputs_jac_u(at, r[0]); }},
    Function{"events",
             "events",
             "events" EOMGEN_ARGUMENTS
             "Event functions, then kinks, then five values of each contact (docs/abi.md): (G,), or (K, G).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::events}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.events(at, r[0]); }},
    Function{"energy_gradients",
             "energy_gradients",
             "energy_gradients" EOMGEN_ARGUMENTS
             "(energies, dT, dU): T and U, (2,); dT/dq, then dT/d(qdot), (2 n,); dU/dq, (n,); or with K in front.\n"
             "Arguments as of rhs.",
             3,
             {{{Size::energies}, {Size::slopes}, {Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) {
               return f.energy_gradients(at, r[0], r[1], r[2]);
             }},
    Function{
        "momentum",
        "momentum",
        "momentum" EOMGEN_ARGUMENTS
        "(AG, hG, centre): angular momentum about the centre of mass, then linear momentum, hG = AG qdot + the part\n"
        "of prescribed motions, (6, n) and (6,); the centre of mass, (3,); or with K in front. Arguments as of rhs.",
        3,
        {{{Size::momentum, Size::coordinates}, {Size::momentum}, {Size::position}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momentum(at, r[0], r[1], r[2]); }},
    Function{
        "_frames",
        "frames",
        "_frames" EOMGEN_ARGUMENTS
        "Position and axes of each frame: (12 F,); columns of all Jacobians: (6, F n); biases: (6 F,).",
        3,
        {{{Size::poses}, {Size::twist, Size::frame_tangents}, {Size::twists}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.frames(at, r[0], r[1], r[2]); }},
};

#undef EOMGEN_VECTOR_ARGUMENTS
#undef EOMGEN_ARGUMENTS

}  // namespace eomgen::python
