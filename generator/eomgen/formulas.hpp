// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas as they are read, and as data.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace eomgen {

/// By Approach I constraints are imposed after the derivation and give their forces, by II before it; eqs. (2.96) to
/// (2.101) of docs/theory.md. `automatic`: I where there is something to eliminate.
enum class Approach { automatic, one, two };

struct LeftOut {
  std::string what, why;
};

/// One printed formula. `key` says what it is: "equations", "explicit", "constraints", "reactions", "friction",
/// "energies", "lagrangian", "conserved", "singular", "metric", "christoffel", ...
struct Formula {
  std::string key, name, coordinate, role;
  std::string text, latex, mathml;
};

struct Multiplier {
  std::string name, latex, of, meaning;  // "lambda", "\lambda", the constraint, in words
};

struct EquationsOptions {
  Approach approach = Approach::automatic;
  /// Keys, as `eomgen derive --show` has them; "all" for all but "linear" and "routh".
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"};
};

struct Equations {
  std::string approach;  // "I" or "II"
  std::vector<Formula> formulas;
  std::vector<LeftOut> left_out;
  std::vector<Multiplier> multipliers;
  bool interrupted = false;

  /// Those of one key, one in each line.
  std::string text(const std::string& key = "equations") const { return lines(key, &Formula::text); }
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

/// An expression: `op` is "number" (`text`: an integer or a fraction, exactly), "pi", "symbol" (`text`: its name, such
/// as "x", "x_dot", "m", "t"), one of "+" "-" "*" "/" "neg" "^" ("^" with an integer exponent has it in `text` and one
/// argument), or a function of the model language ("sin", "atan2", "min"); "if" is args[0] < args[1] ? args[2] :
/// args[3].
struct Node {
  std::string op, text;
  std::array<std::uint32_t, 4> args{};  // indices of nodes that come before this one
  std::size_t arity = 0;
};

/// The equations of motion as data, in the coordinates that stay (n), with constraints that keep multipliers (m):
///   M qddot = f + A^T lambda,   A qddot + gamma = 0.
/// Every entry is an index into `nodes`. Units are those of the model.
struct Derivation {
  std::string approach, route;
  std::vector<std::string> coordinates;  // n
  std::vector<std::string> constraints;  // m labels
  std::vector<Node> nodes;
  std::vector<std::uint32_t> M;         // n x n, by rows
  std::vector<std::uint32_t> f;         // n
  std::vector<std::uint32_t> A, gamma;  // m x n by rows, m
  std::uint32_t kinetic = 0, potential = 0;
};

}  // namespace eomgen
