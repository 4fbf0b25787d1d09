// SPDX-License-Identifier: GPL-3.0-or-later
// Equations of motion in display form (printed formulas) and in compiled form (an expression graph).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "eomgen/results.hpp"

namespace eomgen {

/// When constraints are imposed: eqs. (2.96) to (2.101) of docs/theory.md. Approach I imposes them after the derivation
/// and yields their forces; approach II imposes them before it. `automatic`: I if there is something to eliminate.
enum class Approach { automatic, one, two };

/// Options of Model::equations().
struct EquationsOptions {
  Approach approach = Approach::automatic;
  /// Formula keys, as in `eomgen derive --show`. "all": every key except "kinematics", "regressor", "linear", "routh",
  /// "solved", "forces", "contravariant" and "balance".
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"};
};

/// Result of Model::equations().
struct Equations {
  std::string approach;  // "I" or "II"
  std::vector<Formula> formulas;
  std::vector<LeftOut> left_out;
  std::vector<Multiplier> multipliers;
  bool interrupted = false;  // the result is partial

  /// The formulas of one key, one a line.
  std::string text(const std::string& key = "equations") const { return lines(key, &Formula::text); }
  /// The same as LaTeX.
  std::string latex(const std::string& key = "equations") const { return lines(key, &Formula::latex); }

 private:
  std::string lines(const std::string& key, std::string Formula::*form) const {
    std::string result;
    for (const Formula& formula : formulas) {
      if (formula.key == key) result += formula.*form + "\n";
    }
    return result;
  }
};

/// A node of the expression graph. Values of `op`:
///   "number"                 `text` is an exact integer or fraction;
///   "pi"                     no arguments;
///   "symbol"                 `text` is its name, such as "x", "x_dot", "m", "t";
///   "+" "-" "*" "/" "neg"    arithmetic;
///   "^"                      power; an integer exponent is in `text`, and then there is one argument;
///   "sin", "atan2", "min"..  a function of the model language;
///   "if"                     args[0] < args[1] ? args[2] : args[3].
struct Node {
  std::string op, text;
  std::array<std::uint32_t, 4> args{};  // indices of earlier nodes
  std::size_t arity = 0;
};

/// The equations of motion in compiled form, for n free coordinates and m constraints with multipliers:
///   M qddot = f + A^T lambda,   A qddot + gamma = 0.
/// Every entry is an index into `nodes`. Units are SI, as in the model.
struct Derivation {
  std::string approach, formulation;
  std::vector<std::string> coordinates;  // n
  std::vector<std::string> constraints;  // m, labels
  std::vector<Node> nodes;
  std::vector<std::uint32_t> M;              // n x n, row-major
  std::vector<std::uint32_t> f;              // n
  std::vector<std::uint32_t> A, gamma;       // A: m x n, row-major; gamma: m
  std::uint32_t kinetic = 0, potential = 0;  // energies
};

}  // namespace eomgen
