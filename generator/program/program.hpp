// SPDX-License-Identifier: GPL-3.0-or-later
// The product of the program stage: straight-line code for each function of the C ABI (docs/abi.md), optimised, ready
// for any target to print.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "symbolic/dag.hpp"
#include "system/equation_system.hpp"

namespace eomgen::program {

struct Operations {
  std::size_t add = 0, mul = 0, div = 0, sqrt = 0, trig = 0, other = 0;
  std::size_t flops() const { return add + mul; }
  /// Stated cost by which routes are ranked: add + mul + 8 div + 12 sqrt + 25 trig + 20 other.
  std::size_t cost() const { return add + mul + 8 * div + 12 * sqrt + 25 * trig + 20 * other; }
  /// An instruction of so many operands.
  void count(symbolic::Op op, std::size_t operands) {
    using symbolic::Op;
    switch (op) {
      case Op::add: add += operands - 1; break;
      case Op::mul: mul += operands - 1; break;
      case Op::div: ++div; break;
      case Op::sqrt: ++sqrt; break;
      case Op::sin:
      case Op::cos:
      case Op::tan: ++trig; break;
      default: ++other; break;
    }
  }
};

/// Where an operand comes from; side: of a kink, contact: of friction, both decoded from `mode`.
enum class Slot : std::uint8_t { constant, pi, time, state, parameter, input, prepared, side, contact, value };
struct Operand {
  Slot slot = Slot::value;
  std::uint32_t index = 0;  // constant: into Function::constants; value: of the instruction that made it
  bool negated = false;
  friend bool operator==(const Operand&, const Operand&) = default;
};

struct Instruction {
  symbolic::Op op = symbolic::Op::add;  // no symbol, constant, neg
  std::vector<Operand> operands;        // add and mul may have more than two
  long exponent = 0;                    // of Op::power
  std::string name;                     // a name that means something, or empty; "{3}_ddot": {3} is coordinate 3's
  std::string section;                  // heading that starts here, or empty
  // Sines and cosines that are ready at the same time come one after another and are computed together: the number of
  // their pack, from 1 (0: alone), and the place of the angle in it.
  std::uint32_t pack = 0, lane = 0;
};

/// A value that must not vanish relative to a scale (pivots of the solve): code 1, singular_mass_matrix. Where the
/// scale is the constant 0 the pivot must only differ from zero.
struct PivotTest {
  Operand pivot, scale;
};

/// What is left of a diagonal entry by the subtractions of an elimination carries their rounding, some 1e-16 of the
/// entry times the number of rows: below 1e-13 of it no more than two or three digits are right.
inline constexpr double pivot_tolerance = 1e-13;

/// An argument of the function, or a test that ends it.
struct Result {
  std::string name;              // of the argument; of a test: empty
  std::vector<Operand> entries;  // column-major
  int code = 0;                  // of a test: where an entry is negative the function ends with it
  bool is_test() const { return code != 0; }
};

/// What a function is to give: Result without the operands.
struct ResultShape {
  std::string name;
  std::size_t entries = 0;
  int code = 0;
};

struct Function {
  std::string name;  // of the ABI: "rhs", "prepare", "mass", ...
  std::vector<Result> results;
  std::vector<std::uint32_t> places;  // where the entries of the first result go; none: one after the other
  std::vector<symbolic::Rational> constants;
  std::vector<Instruction> code;
  std::vector<PivotTest> pivots;
  bool uses_input = false;
  Operations operations;
};

/// The recurrences of the Taylor series of `rhs` (taylor.hpp).
/// The array w of `next`: `zeros` values of order 0, then the sums S, then 1 where k is 1 and else 0, then 1/k.
struct Taylor {
  Function start;  // "taylor_start": results z (into w), dx
  Function next;  // "taylor_next": time is k, the state x is x_k; results a, b (k-th factors of each sum), dx (its k-th
                  // coefficient)
  std::size_t zeros = 0, products = 0;
  std::size_t prepared() const { return zeros + products + 2; }
};

struct Tried {
  std::string route;
  system::Approach approach = system::Approach::two;
  system::Form form = system::Form::multipliers;
  Operations operations;
};

/// A contact with friction or that can be left: one digit of the mode.
struct ContactInfo : eom::ContactShape {
  std::string name;
};

/// A chart that can be left for a second one: a bit of `mode` from eom::first_chart_bit on.
struct ChartInfo {
  std::string of, own, second, regular;  // "B", "313", "312", "sin(theta)"
  std::vector<std::uint32_t> angles;     // places in x
  std::uint32_t guarded = 0;             // that of the angle in `regular`
  bool second_at_sine = true;            // where the second chart fails: the sine of that one is 0; else the cosine
  Function to, back;                     // y, the state in the other chart, of x
};

struct Program {
  // Defined once: every file that holds one would compile them anew.
  Program();
  Program(const Program&);
  Program(Program&&) noexcept;
  Program& operator=(const Program&);
  Program& operator=(Program&&) noexcept;
  ~Program();

  std::vector<std::uint32_t> free;       // coordinates of the model; state x = (q_free, qdot_free, integrals)
  std::vector<std::uint32_t> integrals;  // of the model
  /// Entries of the first result of a function; 0: there is no such function.
  std::size_t entries(std::string_view function_name) const {
    for (const Function& function : functions) {
      if (function.name == function_name) return function.results[0].entries.size();
    }
    return 0;
  }
  std::size_t prepared_count() const {  // of the array w: one chart after the other
    std::size_t count = entries("prepare");
    for (const Program& other : second) count += count > 0 ? other.entries("prepare") : 0;
    return count;
  }
  std::size_t event_count() const { return entries("events"); }  // of the array g
  std::size_t state_count() const { return 2 * free.size() + integrals.size(); }
  std::string route;
  system::Approach approach = system::Approach::two;
  system::Form form = system::Form::multipliers;
  std::vector<Function> functions;  // rhs first; last `prepare` and `rhs_prepared` where they save work
  std::vector<Tried> tried;
  std::vector<std::string> reactions;  // labels, in the order of the array lambda
  std::vector<std::string> outputs;    // names, in the order of the array y
  std::vector<std::string> events;     // of the model; first in the array g of the function events
  std::vector<std::string>
      kinks;  // "abs", "if": after them the surfaces whose branches `mode` can hold, then 5 per contact
  std::size_t active_constraints = 0;
  std::vector<ContactInfo> contacts;
  std::optional<Taylor> taylor;   // where it was asked for
  std::vector<bool> holonomic;    // per active constraint: false where it binds velocities only
  std::vector<ChartInfo> charts;  // that can be exchanged; none where the code has one chart only
  std::vector<Program> second;    // the same functions with second charts
  int in_charts = 0;              // of such a program: its bits of `mode`
};

}  // namespace eomgen::program
