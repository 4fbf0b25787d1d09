// SPDX-License-Identifier: GPL-3.0-or-later
// Construction of the two functions of a Taylor series: `start` for order 0, `next` for the higher orders (taylor.hpp).
// References from `next` to sums and to values of `start` get their index in w at the end.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "program/series_parts.hpp"

namespace eomgen::program {

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
