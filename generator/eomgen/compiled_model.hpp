// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled equations of motion as functions of numbers (docs/abi.md). In: a model and one of its scenes. Out: values,
// for any state, parameters and inputs.
//
// Any number of threads may call a CompiledModel at the same time. No call waits for another one, except
// scene_values().
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eomgen/formulas.hpp"

namespace eomgen {

class Model;

/// Options of Model::compile().
struct CompileOptions {
  std::string scene = "default";
  std::map<std::string, double> parameters = {};  // replace the scene's values and initial values; SI units
  Approach approach = Approach::automatic;
  std::string form = "auto";               // see EmitOptions::form
  std::string tier = "auto";               // see RunOptions::tier
  std::optional<std::string> solver = {};  // of simulations, one of solvers(); replaces the scene's
  /// Functions beside rhs and outputs: "jac", "jac_p", "jac_u", "jvp", "vjp", "adjoint", "hvp", "inverse", "regressor",
  /// "coriolis", "gravity", "mass", "momenta", "momentum", "constraints", "reactions", "events", "energy_gradients",
  /// "frames", "taylor", and "momenta_jac", "outputs_jac", "reactions_jac", each also with "_p" and "_u". None given:
  /// jac, mass, and for a model with constraints also constraints and reactions.
  std::optional<std::vector<std::string>> functions = {};
  std::vector<std::string> outputs = {};  // in addition to coordinates; replace the scene's; "all": every output
  bool charts = true;                     // allow simulations to change charts near singularities
  std::uint64_t seed = 1;
};

/// A state, a parameter, an input or an output.
struct Quantity {
  std::string name;
  std::string unit;  // SI, "m/s"; "" if unknown or a pure number
};

/// The numbers of a scene.
struct SceneValues {
  double t_start = 0, t_end = 0;   // s
  std::vector<double> parameters;  // P, with those that depend on others
  std::vector<double> state;       // N, at t_start; satisfies the constraints
};

/// Verified and compiled equations with the numbers of one scene. Immutable; copies share the data.
/// n free coordinates; N = 2 n + integrals states: coordinates, their rates, integrals over time; P parameters;
/// U inputs; m constraints with multipliers; E events.
class CompiledModel {
 public:
  /// Name of the scene that gives the numbers.
  const std::string& scene() const;
  const std::vector<Quantity>& states() const;          // N
  const std::vector<Quantity>& parameters() const;      // P
  const std::vector<Quantity>& inputs() const;          // U
  const std::vector<Quantity>& outputs() const;         // every coordinate and its rate first
  const std::vector<std::string>& constraints() const;  // m, labels of the constraints with multipliers
  const std::vector<std::string>& reactions() const;    // labels of all constraints, in the order of reactions()
  const std::vector<std::string>& events() const;       // names of the model's events, the first of events()
  const std::vector<std::string>& frames() const;       // bodies, particles, points, in the order of frames()
  const std::vector<std::string>& inertial_parameters() const;  // K, in the order of regressor()
  bool has_masses() const;                                      // whether there are bodies or particles
  std::size_t coordinate_count() const;                         // n
  const std::string& certificate() const;                       // summary of the verification
  const std::string& tier() const;                              // "jit" or "compiled"
  bool has(const std::string& function) const;                  // "rhs", "jac", ..

  /// The numbers of the scene: the values of null arguments of the functions below.
  const SceneValues& values() const;
  /// The same with other values of parameters, initial coordinates and rates. Solves the constraints for the start, and
  /// waits for other calls of the library. Throws Error{stage "scene"} if there is no such start.
  SceneValues scene_values(const std::map<std::string, double>& replaced) const;
  /// The scene's inputs at t; at a jump the values after it.
  std::vector<double> input_values(double t) const;

  /// Arguments of the functions below, in SI units.
  struct Arguments {
    double t = 0;
    const double* x = nullptr;           // N
    const double* parameters = nullptr;  // P; null: those of the scene
    const double* inputs = nullptr;      // U; null: those of the scene at t
    const int* mode = nullptr;           // mode_size() (docs/abi.md, "Modes"); null: all entries are 0
    const double* v = nullptr;           // of jvp, vjp, adjoint: N; of hvp: 2 N; of inverse, regressor: n
  };
  // Each function returns a code of docs/abi.md: 0 if the results are valid, 2 at a singular state. A function that was
  // not compiled returns not_compiled. Results must not overlap with arguments.
  static constexpr int not_compiled = -1;
  int rhs(const Arguments& at, double* dx) const;                  // N
  int jac(const Arguments& at, double* dfdx, double* dfdt) const;  // N x N by columns; N, at fixed x, or null
  int jac_p(const Arguments& at, double* dfdp) const;              // N x P by columns
  int jac_u(const Arguments& at, double* dfdu) const;              // N x U by columns
  int jvp(const Arguments& at, double* Jv) const;                  // (df/dx) v: N
  int vjp(const Arguments& at, double* vJ) const;                  // v^T (df/dx): N
  int adjoint(const Arguments& at, double* vJ, double* vP, double* vU) const;  // v^T df/dx, df/dp, df/du: N; P; U
  int hvp(const Arguments& at, double* Hd) const;                              // d(c^T df/dx)/dx d, v = (c, d): N
  int inverse(const Arguments& at, double* tau) const;                         // M v + h with the inputs: n
  int regressor(const Arguments& at, double* Y, double* inertial) const;       // n x K by columns; K
  int coriolis(const Arguments& at, double* C) const;                // by Christoffel symbols: n x n by columns
  int gravity(const Arguments& at, double* g) const;                 // dU/dq: n
  int mass(const Arguments& at, double* M, double* h) const;         // M qddot + h = A^T lambda: n x n by columns; n
  int momenta(const Arguments& at, double* p, double* rates) const;  // dL/d(qdot): n; rates without constraint forces
  // Derivatives of the momenta and their rates, in one array, by states and time (or null), by parameters, by inputs.
  int momenta_jac(const Arguments& at, double* dmdx, double* dmdt) const;         // 2 n x N by columns; 2 n
  int momenta_jac_p(const Arguments& at, double* dmdp) const;                     // 2 n x P
  int momenta_jac_u(const Arguments& at, double* dmdu) const;                     // 2 n x U
  int constraints(const Arguments& at, double* psi, double* A, double* b) const;  // A qdot + b = 0: m; m x n; m
  int reactions(const Arguments& at, double* lambda) const;  // multipliers of all constraints, eliminated ones too
  // Derivatives of the R multipliers by states and time (or null), by parameters, by inputs: by columns.
  int reactions_jac(const Arguments& at, double* dldx, double* dldt) const;  // R x N; R
  int reactions_jac_p(const Arguments& at, double* dldp) const;              // R x P
  int reactions_jac_u(const Arguments& at, double* dldu) const;              // R x U
  int outputs(const Arguments& at, double* y) const;                         // as many as outputs(): Y
  int outputs_jac(const Arguments& at, double* dydx, double* dydt) const;    // Y x N by columns; Y, or null
  int outputs_jac_p(const Arguments& at, double* dydp) const;                // Y x P by columns
  int outputs_jac_u(const Arguments& at, double* dydu) const;                // Y x U by columns
  int events(const Arguments& at, double* g) const;                          // E, then kinks, then five of each contact
  std::size_t event_count() const;                                           // length of g
  std::size_t mode_size() const;                                             // one entry per contact, then per kink
  /// T and U; dT/dq, then dT/d(qdot): 2 n; dU/dq: n.
  int energy_gradients(const Arguments& at, double* energies, double* dT, double* dU) const;
  /// Angular momentum about the centre of mass, then linear momentum: AG qdot + the part of prescribed motions (6), AG:
  /// 6 x n by columns; the centre of mass (3). A model without bodies and particles has none.
  int momentum(const Arguments& at, double* AG, double* hG, double* centre) const;
  /// Per frame: its position and axes e1, e2, e3 (12); the Jacobian of its linear and angular velocity (6 x n by
  /// columns); its linear and angular acceleration at qddot = 0 (6).
  int frames(const Arguments& at, double* pose, double* J, double* bias) const;
  /// coefficients[i + N k]: the k-th derivative of x_i over k!, k = 0 .. order, at constant inputs.
  int taylor(const Arguments& at, int order, double* coefficients) const;

  /// dx/dt of many states: t: count; x, dx: count x N, state after state; codes: count, or null. parameters, inputs: of
  /// all states, or null. Rows with an error are NaN. Returns the first code that is not 0.
  int rhs_batch(std::size_t count, const double* t, const double* x, const double* parameters, const double* inputs,
                double* dx, int* codes = nullptr) const;

  struct State;  // defined within the library

 private:
  friend class Model;
  friend class Simulation;
  friend class FixedStep;
  explicit CompiledModel(std::shared_ptr<const State> state) : state_(std::move(state)) {}
  std::shared_ptr<const State> state_;
};

}  // namespace eomgen
