// SPDX-License-Identifier: GPL-3.0-or-later
// The product of the program stage: optimised straight-line code for each function of the C ABI (docs/abi.md), ready to
// be printed for any target.
#pragma once

#include <cstdint>
#include <eom/contacts/description.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "symbolic/dag.hpp"
#include "system/equation_system.hpp"

namespace eomgen::program {

using symbolic::Op;
using symbolic::Symbol;
using symbolic::SymbolKind;

struct Operations {
  std::size_t add = 0, mul = 0, div = 0, sqrt = 0, trig = 0, other = 0;
  std::size_t flops() const { return add + mul; }
  /// Cost that ranks formulations: add + mul + 8 div + 12 sqrt + 25 trig + 20 other.
  std::size_t cost() const { return add + mul + 8 * div + 12 * sqrt + 25 * trig + 20 * other; }
  /// Adds one instruction with the given number of operands.
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

/// Source of an operand. side (of a kink) and contact (friction) are entries of `mode`; vector is the argument v.
enum class Slot : std::uint8_t { constant, pi, time, state, parameter, input, prepared, vector, side, contact, value };
struct Operand {
  Slot slot = Slot::value;
  std::uint32_t index = 0;  // constant: in Function::constants; value: of the instruction
  bool negated = false;
  friend bool operator==(const Operand&, const Operand&) = default;
};

struct Instruction {
  symbolic::Op op = symbolic::Op::add;  // never symbol, constant, neg
  std::vector<Operand> operands;        // add and mul may have more than two
  long exponent = 0;                    // of Op::power
  std::string name;                     // suggested name or empty; "{3}_ddot": {3} is the name of coordinate 3
  std::string section;                  // heading before this instruction, or empty
  // Sines and cosines whose angles are ready at the same time are adjacent and computed together. `pack`: the number of
  // their group from 1 on (0: computed alone). `lane`: the position of the angle in the group.
  std::uint32_t pack = 0, lane = 0;
};

/// A pivot of the solve that must not vanish relative to a scale; otherwise the function returns 1,
/// singular_mass_matrix. If the scale is the constant 0, the pivot must only be nonzero.
struct PivotTest {
  Operand pivot, scale;
};

/// Relative tolerance of pivots. The subtractions of an elimination leave a rounding error of about 1e-16 of the
/// diagonal entry times the number of rows. Below 1e-13 of the entry at most two or three digits are correct.
inline constexpr double pivot_tolerance = 1e-13;

/// A result argument of the function, or a test that ends it.
struct Result {
  std::string name;              // of the argument; empty for a test
  std::vector<Operand> entries;  // column-major
  int code = 0;                  // for a test: returned if an entry is negative
  bool is_test() const { return code != 0; }
};

/// The shape of a Result: its name, entries and code without operands.
struct ResultShape {
  std::string name;
  std::size_t entries = 0;
  int code = 0;
};

struct ArrayProgram;

struct Function {
  std::string name;  // in the ABI: "rhs", "prepare", "mass", ...
  std::vector<Result> results;
  std::vector<std::uint32_t> result_indices;  // destination of the entries of the first result; empty: in order
  std::vector<symbolic::Rational> constants;
  std::vector<Instruction> code;
  std::vector<PivotTest> pivots;
  bool uses_input = false;
  Operations operations;
  std::shared_ptr<const ArrayProgram> loops;  // the same function for C and C++ (array_program.hpp), or null
};

/// Whether a function writes dx: its values are tested to be finite.
inline bool is_right_hand_side(const Function& function) {
  return function.name == "rhs" || function.name == "rhs_prepared" || function.name == "rhs_open";
}

/// Recurrences of the Taylor series of `rhs` (taylor.hpp). The array w of `next` contains `zeros` values of order 0,
/// the sums S, then 1 if k is 1 and else 0, then 1/k.
struct Taylor {
  Function start;  // "taylor_start": results z (into w), dx
  Function next;  // "taylor_next": time is k, the state x is x_k; results a, b (k-th factors of each sum), dx (its k-th
                  // coefficient)
  std::size_t order_zero_count = 0, product_count = 0;
  std::size_t workspace_size() const { return order_zero_count + product_count + 2; }
};

struct CandidateCost {
  std::string formulation;
  system::Approach approach = system::Approach::two;
  system::Form form = system::Form::multipliers;
  Operations operations;
};

/// A contact with friction, or a unilateral contact: one entry of `mode`.
struct ContactInfo : eom::ContactShape {
  std::string name;
};

/// A chart with an alternative second chart: one entry of `mode`.
struct ChartInfo {
  std::string of, own, second, regular;  // "B", "313", "312", "sin(theta)"
  std::vector<std::uint32_t> angles;     // indices in x
  std::uint32_t guarded = 0;             // index of the angle in `regular`
  bool second_at_sine = true;            // the second chart is singular at zero sine, else cosine
  Function to, back;                     // y (state in the other chart) as a function of x
};

struct Program {
  // Defined in program.cpp; inline definitions would be compiled in every file that uses a Program.
  Program();
  Program(const Program&);
  Program(Program&&) noexcept;
  Program& operator=(const Program&);
  Program& operator=(Program&&) noexcept;
  ~Program();

  std::vector<std::uint32_t> free;       // coordinates of the model; state x = (q_free, qdot_free, states)
  std::vector<symbolic::Symbol> states;  // of first order, then discrete values
  std::size_t discrete = 0;              // how many of them are discrete values
  /// Number of entries of the first result of a function; 0 if the function does not exist.
  std::size_t result_size(std::string_view function_name) const {
    for (const Function& function : functions) {
      if (function.name == function_name) return function.results[0].entries.size();
    }
    return 0;
  }
  std::size_t prepared_count() const {  // length of the array w; one chart after the other
    std::size_t count = result_size("prepare");
    for (const Program& other : chart_variants) count += count > 0 ? other.result_size("prepare") : 0;
    return count;
  }
  /// Whether `rhs_open` exists, and takes less work than the right-hand side with forces of contacts.
  bool open_saves_work() const;
  std::size_t event_count() const { return result_size("events"); }  // length of the array g
  eom::StateLayout layout() const { return {free.size(), states.size() - discrete, discrete}; }
  std::size_t state_count() const { return layout().size(); }
  eom::ModeLayout mode_layout() const {
    return {contacts.size() + contact_set.contacts.size(), kinks.size(), charts.size()};
  }
  std::string formulation;
  system::Approach approach = system::Approach::two;
  system::Form form = system::Form::multipliers;
  std::vector<Function> functions;  // rhs first; `prepare` and `rhs_prepared` last, if they save work
  std::vector<CandidateCost> candidates;
  std::vector<std::string> reactions;  // labels, in the order of the array lambda
  std::vector<std::string> outputs;    // names, in the order of the array y
  std::vector<std::string> events;     // events of the model; they precede others in the array g
  std::vector<std::string> kinks;      // "abs", "if": their surfaces follow in g, then 5 values per contact
  std::size_t active_constraints = 0;
  std::vector<ContactInfo> contacts;
  eom::contacts::Set contact_set;       // contacts whose forces are inputs
  std::optional<Taylor> taylor;         // if requested
  std::vector<bool> holonomic;          // per active constraint; false if it constrains velocities only
  std::vector<ChartInfo> charts;        // exchangeable charts; empty if the code has one chart
  std::vector<Program> chart_variants;  // the same functions with second charts
  unsigned in_charts = 0;               // for a variant in second charts: bit j for chart j
};

}  // namespace eomgen::program
