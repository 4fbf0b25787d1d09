// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/fold.hpp"

#include <cln/dfloat.h>
#include <cln/float.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "numeric/numbers.hpp"
#include "program/parts.hpp"
#include "symbolic/arithmetic.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::jit {
namespace {

using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

constexpr std::uintptr_t digits = 60;

/// The function rounded once; its value in binary64 where it has none among real numbers.
double rounded_once(Op op, const std::vector<double>& arguments) {
  using Binary64 = symbolic::Binary64Arithmetic;
  const auto in_binary64 = [&] {
    return symbolic::value_of(
        op, 0, [&](std::size_t i) { return arguments[i]; }, Binary64{});
  };
  for (const double argument : arguments) {
    if (!std::isfinite(argument)) return in_binary64();
  }
  try {
    const symbolic::ClnArithmetic number{cln::float_format(digits)};
    const cln::cl_R value = symbolic::value_of(
        op, 0, [&](std::size_t i) { return number.constant(numeric::exact(arguments[i])); }, number);
    // The nearest double: of few significant digits, or zero.
    const double near = in_binary64();
    if (near == 0 || !std::isnormal(near)) return near;
    const double result = cln::double_approx(cln::cl_float(value, cln::float_format_dfloat));
    return result == 0 ? near : result;
  } catch (const std::domain_error&) {
    return in_binary64();
  }
}

double folded(Op op, const std::vector<double>& o) {
  switch (op) {
    case Op::add:
    case Op::mul: {
      double result = o[0];
      for (std::size_t i = 1; i < o.size(); ++i) result = op == Op::add ? result + o[i] : result * o[i];
      return result;
    }
    case Op::div: return o[0] / o[1];
    case Op::sqrt: return std::sqrt(o[0]);
    case Op::abs: return std::fabs(o[0]);
    case Op::sign: return o[0] > 0 ? 1 : o[0] < 0 ? -1 : 0;
    case Op::min: return o[1] < o[0] ? o[1] : o[0];
    case Op::max: return o[0] < o[1] ? o[1] : o[0];
    case Op::select: return o[0] < o[1] ? o[2] : o[3];
    default: return rounded_once(op, o);
  }
}

}  // namespace

std::vector<std::optional<double>> fold_constants(const program::Function& function, std::span<const double> constants,
                                                  const std::optional<std::vector<double>>& inputs) {
  std::vector<std::optional<double>> value(function.code.size());
  const std::vector<std::size_t> part = program::assign_parts(function);
  std::vector<double> operands;
  const auto take = [&](const Operand& operand, std::size_t reader) {
    std::optional<double> found;
    switch (operand.slot) {
      case Slot::constant: found = constants[operand.index]; break;
      case Slot::pi: found = symbolic::Binary64Arithmetic::pi(); break;
      case Slot::input:
        if (inputs) found = inputs->at(operand.index);
        break;
      case Slot::value:
        if (part[operand.index] == part[reader]) found = value[operand.index];
        break;
      default: break;
    }
    if (found) operands.push_back(operand.negated ? -*found : *found);
    return found.has_value();
  };
  for (std::size_t i = 0; i < function.code.size(); ++i) {
    const Instruction& instruction = function.code[i];
    operands.clear();
    bool constant = instruction.pack == 0;  // the kernel for several angles has roundings of its own
    for (const Operand& operand : instruction.operands) constant = constant && take(operand, i);
    if (constant) value[i] = folded(instruction.op, operands);
  }
  return value;
}

std::vector<bool> absorbed_arctangents(const program::Function& function) {
  const std::vector<Instruction>& code = function.code;
  const std::vector<std::size_t> part = program::assign_parts(function);
  std::vector<std::uint32_t> uses(code.size(), 0);
  const auto use = [&](const Operand& operand) {
    if (operand.slot == Slot::value) ++uses[operand.index];
  };
  for (const Instruction& instruction : code)
    std::for_each(instruction.operands.begin(), instruction.operands.end(), use);
  for (const program::Result& result : function.results)
    std::for_each(result.entries.begin(), result.entries.end(), use);
  for (const program::PivotTest& test : function.pivots) use(test.pivot), use(test.scale);
  std::vector<bool> absorbed(code.size(), false);
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i].pack != 0 || (code[i].op != Op::sin && code[i].op != Op::cos)) continue;
    const Operand& angle = code[i].operands[0];
    if (angle.slot != Slot::value || code[angle.index].op != Op::atan) continue;
    const bool is_direct = !angle.negated || code[i].op == Op::cos;  // -sin(a) is not written as sin(-a)
    absorbed[angle.index] = is_direct && uses[angle.index] == 1 && part[angle.index] == part[i];
  }
  return absorbed;
}

}  // namespace eomgen::jit
