// SPDX-License-Identifier: GPL-3.0-or-later
// Construction of the two functions of a Taylor series: `start` for order 0, `next` for the higher orders (taylor.hpp).
// References from `next` to sums and to values of `start` get their index in w at the end.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "program/program.hpp"

namespace eomgen::program {

// Power series of the values of a right-hand side: the building blocks of the recurrences.

inline Operand negate(Operand operand) {
  operand.negated = !operand.negated;
  return operand;
}

/// A value of the right-hand side. `zero`: coefficient of order 0, in `start`; `next`: coefficient of order k, in
/// `next`, if the value depends on time or state.
struct Series {
  bool varies = false;
  Operand zero, next;
};
inline Series negate(Series series) { return {series.varies, negate(series.zero), negate(series.next)}; }

using Key = std::tuple<Slot, std::uint32_t, bool>;
inline Key key(const Operand& o) { return {o.slot, o.index, o.negated}; }
using Keys = std::pair<Key, Key>;
inline Keys keys(const Series& s) { return {key(s.zero), key(s.next)}; }

inline Operand constant(Function& function, const symbolic::Rational& value) {
  auto& list = function.constants;
  const auto found = std::find(list.begin(), list.end(), value);
  const auto index = static_cast<std::uint32_t>(found - list.begin());
  if (found == list.end()) list.push_back(value);
  return {Slot::constant, index, false};
}

inline Operand append_instruction(Function& function, symbolic::Op op, std::vector<Operand> operands,
                                  std::string name = {}) {
  if (operands.size() == 1 && (op == symbolic::Op::add || op == symbolic::Op::mul)) return operands[0];
  Instruction instruction;
  instruction.op = op;
  instruction.operands = std::move(operands);
  instruction.name = std::move(name);
  function.code.push_back(std::move(instruction));
  return {Slot::value, static_cast<std::uint32_t>(function.code.size() - 1), false};
}

class SeriesBuilder {
 public:
  explicit SeriesBuilder(const Function& rhs);

 protected:
  /// The series of an operand of the right-hand side. `values_` contains the series of the instructions so far.
  Series read(const Operand& operand) const;

  Operand at_start(symbolic::Op op, std::vector<Operand> operands, const std::string& name = {}) {
    return append_instruction(start_, op, std::move(operands), name);
  }
  Operand at_next(symbolic::Op op, std::vector<Operand> operands) {
    return append_instruction(next_, op, std::move(operands));
  }
  Operand one() { return constant(start_, 1); }
  /// A value of `start` as an operand of `next`.
  Operand start_value(const Operand& value);

  /// Opens the sum over 0 < j < k of a_j b_(k-j). `close_sum` sets the second factor later.
  Operand open_sum(const Operand& a);
  void close_sum(const Operand& sum, const Operand& b) { factors_[sum.index][1] = b; }
  Operand sum(const Operand& a, const Operand& b);
  /// Sets both factors of an open sum.
  void close_sum(const Operand& sum, const Operand& a, const Operand& b) { factors_[sum.index] = {a, b}; }

  /// k a_k, the coefficient of the derivative.
  Operand times_order(const Series& a);
  /// w/k, the coefficient of the antiderivative of w.
  Operand divide_by_order(const Operand& w);

  /// Adds the results and the pivot tests of the right-hand side. No code may be added afterwards.
  Taylor finished(const Function& rhs);

  Function start_, next_;
  std::vector<Series> values_;

 private:
  void write_results(const Function& rhs);
  void drop_unused_of_next();
  void drop_unused_of_start();
  void write_factors();
  void place(Operand& operand) const;
  void number_packs();

  std::vector<std::array<Operand, 2>> factors_;  // factors of the sums
  std::vector<Operand> zeros_;
  std::map<std::pair<Slot, std::uint32_t>, std::uint32_t> kept_;
  std::map<Key, Operand> times_order_;
};

}  // namespace eomgen::program
