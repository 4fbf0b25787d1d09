// SPDX-License-Identifier: GPL-3.0-or-later
// The two pieces of code of a Taylor series while they are written: `start` for the order 0, `next` for the orders
// above (taylor.hpp). What of `next` refers to sums and to values of `start` gets its place in w at the end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "program/series_parts.hpp"

namespace eomgen::program {

class SeriesCode {
 public:
  explicit SeriesCode(const Function& rhs);

 protected:
  /// The series of an operand of the right-hand side, whose instructions so far have those of `values_`.
  Series read(const Operand& operand) const;

  Operand at_start(symbolic::Op op, std::vector<Operand> operands, const std::string& name = {}) {
    return push(start_, op, std::move(operands), name);
  }
  Operand at_next(symbolic::Op op, std::vector<Operand> operands) { return push(next_, op, std::move(operands)); }
  Operand one() { return constant(start_, 1); }
  /// What `start` computed, in `next`.
  Operand kept(const Operand& value);

  /// sum over 0 < j < k of a_j b_(k-j); the second factor may follow with `close`.
  Operand open(const Operand& a);
  void close(const Operand& sum, const Operand& b) { factors_[sum.index][1] = b; }
  Operand sum(const Operand& a, const Operand& b);
  /// A sum of which both factors follow.
  void close(const Operand& sum, const Operand& a, const Operand& b) { factors_[sum.index] = {a, b}; }

  /// k a_k: of the derivative.
  Operand weighted(const Series& a);
  /// w/k: the coefficient of what has the derivative w.
  Operand unweighted(const Operand& w);

  /// With the results and the tests of the right-hand side; nothing may be added afterwards.
  Taylor finished(const Function& rhs);

  Function start_, next_;
  std::vector<Series> values_;

 private:
  void write_results(const Function& rhs);
  void place(Operand& operand) const;
  void number_packs();

  std::vector<std::array<Operand, 2>> factors_;  // of the sums
  std::vector<Operand> zeros_;
  std::map<std::pair<Slot, std::uint32_t>, std::uint32_t> kept_;
  std::map<Key, Operand> weighted_;
};

}  // namespace eomgen::program
