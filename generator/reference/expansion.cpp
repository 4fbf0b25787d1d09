// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/expansion.hpp"

#include <cln/dfloat.h>

#include <stdexcept>

#include "numeric/numbers.hpp"
#include "program/interpret.hpp"

namespace eomgen::reference {

using program::Operand;
using program::Slot;
using symbolic::Op;

TaylorExpansion::TaylorExpansion(const program::Taylor& taylor, int digits)
    : taylor_(taylor), digits_(digits), format_(cln::float_format(static_cast<std::uintptr_t>(digits))) {
  const program::Function& next = taylor.next;
  states_ = next.results[2].entries.size();
  for (const symbolic::Rational& constant : next.constants) values_.push_back(cln::cl_float(constant, format_));
  values_.push_back(cln::pi(format_));
  at_k_ = values_.size();
  at_x_ = at_k_ + 1;
  at_w_ = at_x_ + states_;
  at_code_ = at_w_ + taylor.workspace_size();
  values_.resize(at_code_ + next.code.size(), cln::cl_float(0, format_));
  for (const program::Instruction& instruction : next.code) {
    if (instruction.op != Op::add && instruction.op != Op::mul && instruction.op != Op::select)
      throw std::logic_error("recurrences are sums, products and branches");
    code_.push_back({instruction.op, {}});
    for (const Operand& operand : instruction.operands) code_.back().operands.push_back(place(operand));
  }
  for (const Operand& entry : next.results[0].entries) a_.push_back(place(entry));
  for (const Operand& entry : next.results[1].entries) b_.push_back(place(entry));
  for (const Operand& entry : next.results[2].entries) dx_.push_back(place(entry));
  for (std::size_t i = 0; i < a_.size(); ++i) {
    const Operand& factor = next.results[0].entries[i];
    if (factor.slot != Slot::constant || next.constants[factor.index] != 0) sums_ = i + 1;
  }
}

TaylorExpansion::Place TaylorExpansion::place(const Operand& operand) const {
  const auto at = [&](std::size_t first) { return Place{first + operand.index, operand.negated}; };
  switch (operand.slot) {
    case Slot::constant: return at(0);
    case Slot::pi: return {at_k_ - 1, operand.negated};
    case Slot::time: return {at_k_, operand.negated};
    case Slot::state: return at(at_x_);
    case Slot::prepared: return at(at_w_);
    case Slot::value: return at(at_code_);
    default: throw std::logic_error("recurrences read no parameters");
  }
}

Number TaylorExpansion::number(double value) const { return cln::cl_float(numeric::exact(value), format_); }

void TaylorExpansion::run_next() {
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const std::vector<Place>& o = code_[i].operands;
    Number& result = values_[at_code_ + i];
    if (code_[i].op == Op::select) {
      result = read(o[0]) < read(o[1]) ? read(o[2]) : read(o[3]);
      continue;
    }
    result = read(o[0]);
    for (std::size_t k = 1; k < o.size(); ++k) {
      const Number& size = values_[o[k].index];
      if (code_[i].op == Op::mul) {
        result = o[k].negated ? -(result * size) : result * size;
      } else {
        result = o[k].negated ? result - size : result + size;
      }
    }
  }
}

std::vector<std::vector<Number>> TaylorExpansion::operator()(const Number& t, const std::vector<Number>& x,
                                                             const std::vector<double>& p, const std::vector<double>& u,
                                                             int order) {
  program::Arguments<cln::cl_R> at;
  at.t = t;
  at.x.assign(x.begin(), x.end());
  for (const double value : p) at.p.emplace_back(number(value));
  for (const double value : u) at.u.emplace_back(number(value));
  const auto start = program::interpret(taylor_.start, at, digits_).results;
  const auto rounded = [this](const cln::cl_R& value) { return cln::cl_float(value, format_); };
  std::vector<std::vector<Number>> c{x, {}}, a(1), b(1);
  for (const cln::cl_R& value : start[1]) c[1].push_back(rounded(value));
  for (std::size_t i = 0; i < taylor_.order_zero_count; ++i) values_[at_w_ + i] = rounded(start[0][i]);
  const std::size_t at_sums = at_w_ + taylor_.order_zero_count, last = at_w_ + taylor_.workspace_size() - 1;
  for (int k = 1; k < order; ++k) {
    const auto n = static_cast<std::size_t>(k);
    for (std::size_t i = 0; i < sums_; ++i) {
      Number sum = cln::cl_float(0, format_);
      for (std::size_t j = 1; j < n; ++j) sum = sum + a[j][i] * b[n - j][i];
      values_[at_sums + i] = sum;
    }
    values_[at_k_] = cln::cl_float(k, format_);
    values_[last - 1] = cln::cl_float(k == 1 ? 1 : 0, format_);
    values_[last] = cln::cl_float(cln::cl_RA(1) / k, format_);
    for (std::size_t i = 0; i < states_; ++i) values_[at_x_ + i] = c[n][i];
    run_next();
    a.emplace_back();
    b.emplace_back();
    for (std::size_t i = 0; i < sums_; ++i) {
      a.back().push_back(read(a_[i]));
      b.back().push_back(read(b_[i]));
    }
    c.emplace_back();
    for (std::size_t i = 0; i < states_; ++i) c.back().push_back(read(dx_[i]) / cln::cl_float(k + 1, format_));
  }
  return c;
}

}  // namespace eomgen::reference
