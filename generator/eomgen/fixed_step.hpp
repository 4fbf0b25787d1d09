// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a fixed-step method as a function x1 = step(t, h, x, p, u), with its derivatives: for optimal control,
// shooting, estimation. In: a CompiledModel. Out: the end of the step, and its derivatives by all arguments.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "eomgen/compiled_model.hpp"

namespace eomgen {

/// Derivatives of the end x1 of a step, exact for the method. Matrices are stored by columns. Null pointers are not
/// computed. Arrays must not overlap with arguments.
struct StepDerivatives {
  double* x = nullptr;           // dx1/dx: N x N
  double* parameters = nullptr;  // dx1/dp: N x P, each entry of p by itself; needs "jac_p" (*)
  double* inputs = nullptr;      // dx1/du: N x U; needs "jac_u" (*)
  double* t = nullptr;           // dx1/dt at fixed h and inputs: N
  double* h = nullptr;           // dx1/dh at fixed inputs: N
  // (*) "variational2": "momenta_jac_p" and "momenta_jac_u"
};

/// A step of a method, with its work space. Results depend on the arguments of a call only. A call allocates nothing,
/// except that inputs which vary in the scene are evaluated in a copy. One thread at a time may use an object; objects
/// of one CompiledModel are independent.
///
/// Inputs are held over the step. Contacts and kinks stay in the mode of the arguments, and events are ignored.
/// Constraints with multipliers hold as far as the method conserves them: a Simulation projects, a step does not.
class FixedStep {
 public:
  /// method: one of methods(). All derivatives need "jac", and so does each step of "midpoint". A step of
  /// "variational2" needs "momenta" and "momenta_jac" in its place, and takes models without contacts, constraints with
  /// multipliers and states of first order. Throws Error for an unknown method and what it lacks.
  explicit FixedStep(CompiledModel model, const std::string& method = "rk4");
  FixedStep(FixedStep&&) noexcept;
  FixedStep& operator=(FixedStep&&) noexcept;
  ~FixedStep();

  /// "rk4", "dopri5", "tsit5", "dop853" (explicit, order 4, 5, 5, 8), "midpoint", "variational2" (implicit, order 2,
  /// symplectic).
  static std::vector<std::string> methods();
  /// A step could not be solved: a shorter one may succeed.
  static constexpr int no_convergence = -2;

  /// x1: the state at t + h, N; may be `at.x`. h in s, may be negative. Returns a code as the functions of
  /// CompiledModel do, or no_convergence.
  int operator()(const CompiledModel::Arguments& at, double h, double* x1);
  /// The same, and derivatives. x1 must not be `at.x`. Returns CompiledModel::not_compiled if a function is missing.
  int derivatives(const CompiledModel::Arguments& at, double h, double* x1, const StepDerivatives& to);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace eomgen
