// SPDX-License-Identifier: GPL-3.0-or-later
// Results that the stages compute and the library returns as they are: plain structs of text and numbers. This header
// is public (eomgen/results.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace eomgen {

/// A result that was skipped, and why: "acceleration of roll.1", "too many terms to be written out".
struct LeftOut {
  std::string what, why;
  bool over_budget = true;  // false: it does not apply
};

/// One printed formula. `key`: its kind, one of "equations" (momentum form, one per coordinate), "explicit"
/// (M qddot + h = Q), "constraints", "reactions", "friction", "energies", "lagrangian", "conserved", "singular",
/// "metric", "christoffel", ...
struct Formula {
  std::string key, name, coordinate;
  std::string text, latex, mathml;
  std::string role;
  std::string left_out = {};  // reason if the formula is omitted, else empty
};

/// A Lagrange multiplier: its name, its constraint and its mechanical meaning.
struct Multiplier {
  std::string name, latex, constraint, meaning;  // "lambda", "\lambda", label of the constraint, a phrase
};

/// Classification of one constraint.
struct ConstraintClass {
  std::string name, kind;                     // "holonomic" or "velocity"
  std::string integrable;                     // "yes", "no", "unknown"
  std::optional<std::string> integral;        // the integrated equation
  bool redundant = false;                     // follows from others and has no multiplier
  std::optional<bool> determined = {};        // whether the motion determines its force; not set for joints
  std::string treatment, reason;              // treatment in the equations; reason for `integrable`
  std::vector<std::string> integral_of = {};  // the constraints that together have this integral
};

/// Classification of one force.
struct ForceClass {
  std::string name, conservative;  // "yes", "no", "unknown"
  std::optional<Formula> potential;
  std::vector<std::string> domain = {};  // conditions under which the potential is valid
  bool many_valued = false, in_energy = false;
  std::string reason;
};

/// A coordinate, a parameter, or an input with its default value.
struct ExaminedQuantity {
  std::string name;
  std::string unit;          // SI; "" if unknown
  std::string value;         // a decimal, or an expression of other parameters; "" of coordinates
  std::string written = {};  // as in the model file; "" of coordinates
};

/// Comparison of two derivations, or of a derivation with code generated from it.
struct Comparison {
  std::string a, b;
  bool shares_code = false;  // false: the two are independent implementations
  double max_relative_difference = 0, tolerance = 0;
  int digits_agreed = 0;  // at most the requested digits
  bool pass = true;
};

/// One generated file.
struct SourceFile {
  std::string name;  // without folder
  std::string text;
};

/// As the options of `eomgen import`.
struct RobotOptions {
  bool floating = false;                    // the root link moves freely
  std::string attitude = "euler";           // of free links: euler, euler_parameters
  std::string friction = "smooth";          // of joints: smooth, dry, none
  std::string actuators = "transmissions";  // joints with an input: transmissions, all, none
  std::vector<std::string> stops;           // joints whose limits are end stops
  bool parameters = false;                  // masses, centres, tensors, damping, friction as parameters
  bool exact_angles = false;                // decimals of multiples of pi/12 stay decimals
};

/// A conserved quantity and its numerical drift.
struct Invariant {
  std::string name;
  double initial = 0, max_relative_drift = 0;
};

/// One run of one solver.
struct BenchmarkRow {
  std::string solver;
  double rtol = 0, step = 0;   // tolerance or fixed step in s; the other is 0
  double error = 0;            // of the final state, relative to the largest value of each component
  double error_along = 0;      // the largest over all times of the reference solution
  std::vector<double> errors;  // per state at the end, absolute
  double seconds = 0;          // median run time, s
  std::size_t repeats = 0, steps = 0, rejected = 0, rhs_evaluations = 0;
  std::string outcome;  // "interrupted": the time limit was exceeded
};

}  // namespace eomgen
