// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/expressions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "symbolic/functions.hpp"

namespace eomgen::emit {

using Expression = Expressions::Expression;

namespace {

std::string in_parentheses(const Expression& e) { return fmt::format("({})", e.text); }
std::string at_least(const Expression& e, Expression::Precedence precedence) {
  return e.precedence >= precedence && e.text[0] != '-' ? e.text : in_parentheses(e);
}

}  // namespace

bool repeats_operands(Op op) { return op == Op::min || op == Op::max || op == Op::sign || op == Op::select; }

Expressions::Expressions(const Function& function, const ModelNames& names, const Dialect& dialect)
    : function_(function), names_(names), dialect_(dialect), value_(function.code.size()) {}

Expression Expressions::unsigned_value(const Operand& operand) const {
  switch (operand.slot) {
    case Slot::constant: {
      const std::string text = dialect_.constant(function_.constants[operand.index]);
      return {text, text.find('/') == std::string::npos ? Expression::atom : Expression::product};
    }
    case Slot::pi: return {dialect_.pi, Expression::atom};
    case Slot::time: return {names_.time, Expression::atom};
    case Slot::state: return {names_.state[operand.index], Expression::atom};
    case Slot::parameter: return {names_.parameters[operand.index], Expression::atom};
    case Slot::input: return {names_.inputs[operand.index], Expression::atom};
    case Slot::prepared:
      if (!dialect_.lane_prefix.empty()) return {names_.prepared.at(operand.index), Expression::atom};
      if (dialect_.element != nullptr) return {dialect_.element(names_.w, operand.index), Expression::atom};
      return {fmt::format("{}[{}]", names_.w, operand.index), Expression::atom};
    case Slot::vector: return {names_.vector[operand.index], Expression::atom};
    case Slot::side: return {names_.sides[operand.index], Expression::atom};
    case Slot::contact: return {names_.contacts[operand.index], Expression::atom};
    case Slot::value: break;
  }
  return value_[operand.index];
}

Expression Expressions::signed_value(const Operand& operand) const {
  const Expression size = unsigned_value(operand);
  if (!operand.negated) return size;
  return {fmt::format("-{}", at_least(size, Expression::product)), Expression::product};
}

Expression Expressions::in_lanes(const Operand& operand, bool with_sign) const {
  const Expression value = with_sign ? signed_value(operand) : unsigned_value(operand);
  if (dialect_.lane_prefix.empty() || (operand.slot != Slot::constant && operand.slot != Slot::pi)) return value;
  return {fmt::format("{}all({})", dialect_.lane_prefix, value.text), Expression::atom};
}

/// Expressions that differ for lanes.
std::optional<Expression> Expressions::print_lanes(const Instruction& instruction) {
  const auto& o = instruction.operands;
  const auto value = [&](std::size_t i) { return in_lanes(o[i], true).text; };
  const auto select = [&](std::size_t a, std::size_t b, std::size_t x, std::size_t y) {
    return Expression{fmt::format("{0}select(({0}mask)({1} < {2}), {3}, {4})", dialect_.lane_prefix, value(a), value(b),
                                  value(x), value(y)),
                      Expression::atom};
  };
  switch (instruction.op) {
    case Op::abs: return Expression{fmt::format("{}abs({})", dialect_.lane_prefix, value(0)), Expression::atom};
    case Op::sign: return Expression{fmt::format("{}sign({})", dialect_.lane_prefix, value(0)), Expression::atom};
    case Op::min: return select(1, 0, 1, 0);
    case Op::max: return select(0, 1, 1, 0);
    case Op::select: return select(0, 1, 2, 3);
    case Op::add:
    case Op::mul:
    case Op::div: return std::nullopt;
    default: break;
  }
  const std::string name = symbolic::function_of(instruction.op).code;
  library_calls_.insert(name);
  std::string arguments;
  for (std::size_t i = 0; i < o.size(); ++i) arguments += (i == 0 ? "" : ", ") + value(i);
  return Expression{fmt::format("{}{}({})", dialect_.lane_prefix, name, arguments), Expression::atom};
}

Expression Expressions::print(const Instruction& instruction) {
  if (!dialect_.lane_prefix.empty()) {
    if (std::optional<Expression> special = print_lanes(instruction)) return *special;
    const Expression value = print_operation(instruction);
    const auto is_number = [](const Operand& o) { return o.slot == Slot::constant || o.slot == Slot::pi; };
    if (!std::all_of(instruction.operands.begin(), instruction.operands.end(), is_number)) return value;
    return {fmt::format("{}all({})", dialect_.lane_prefix, value.text), Expression::atom};  // such as 2 pi
  }
  return print_operation(instruction);
}

Expression Expressions::print_operation(const Instruction& instruction) {
  const auto& o = instruction.operands;
  const auto name = [&](std::size_t i) { return at_least(signed_value(o[i]), Expression::atom); };
  switch (instruction.op) {
    case Op::add: return sum(o);
    case Op::mul: return product(o);
    case Op::div: return rounded({fmt::format("{}/{}", first_factor(o[0]), name(1)), Expression::product});
    case Op::abs: return call(dialect_.abs_function, o);
    case Op::min: return conditional(name(1), name(0), name(1), name(0));
    case Op::max: return conditional(name(0), name(1), name(1), name(0));
    case Op::select: return conditional(name(0), name(1), name(2), name(3));
    case Op::sign: {
      const std::string zero = dialect_.constant(0), one = dialect_.constant(1);
      if (dialect_.conditional != nullptr)
        return conditional(zero, name(0), one, conditional(name(0), zero, "-" + one, zero).text);
      return {fmt::format("({0} > {1} ? {2} : {0} < {1} ? -{2} : {1})", name(0), zero, one), Expression::atom};
    }
    default: return rounded(call(function_name(instruction.op), o));
  }
}

Expression Expressions::conditional(const std::string& a, const std::string& b, const std::string& x,
                                    const std::string& y) const {
  if (dialect_.conditional != nullptr) return {dialect_.conditional(a, b, x, y), Expression::atom};
  return {fmt::format("({} < {} ? {} : {})", a, b, x, y), Expression::atom};
}

std::string Expressions::function_name(Op op) const {
  return dialect_.function_name != nullptr ? dialect_.function_name(op) : symbolic::function_of(op).code;
}

Expression Expressions::rounded(Expression value) const {
  if (dialect_.rounding_function.empty()) return value;
  return {dialect_.rounded(value.text), Expression::atom};
}

Expression Expressions::call(const std::string& name, const std::vector<Operand>& operands) {
  library_calls_.insert(name);
  std::string arguments;
  for (const Operand& operand : operands)
    arguments += fmt::format("{}{}", arguments.empty() ? "" : ", ", signed_value(operand).text);
  return {fmt::format("{}({})", name, arguments), Expression::atom};
}

std::string Expressions::first_factor(const Operand& operand) const {
  return operand.negated ? signed_value(operand).text : at_least(unsigned_value(operand), Expression::product);
}

Expression Expressions::product(const std::vector<Operand>& operands) const {
  Expression result{first_factor(operands[0]), Expression::product};
  for (std::size_t i = 1; i < operands.size(); ++i) {
    result.text += fmt::format("*{}", at_least(signed_value(operands[i]), Expression::atom));
    result = rounded(std::move(result));
  }
  return result;
}

Expression Expressions::sum(const std::vector<Operand>& operands) const {
  Expression result{first_factor(operands[0]), Expression::sum};
  for (std::size_t i = 1; i < operands.size(); ++i) {
    result.text += operands[i].negated ? " - " : " + ";
    result.text += at_least(unsigned_value(operands[i]), Expression::product);
    result = rounded(std::move(result));
  }
  return result;
}

}  // namespace eomgen::emit
