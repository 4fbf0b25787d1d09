// SPDX-License-Identifier: GPL-3.0-or-later
#include "stress/denominators.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "symbolic/functions.hpp"

namespace eomgen::stress {
namespace {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

constexpr std::size_t longest = 160;  // letters; longer expressions are reported by their size

class Text {
 public:
  Text(const Function& function, const program::Program& program, const mechanics::Mechanics& mechanics)
      : function_(function), program_(program), model_(*mechanics.model), known_(function.code.size()) {}

  std::string of(const Operand& operand) {
    const std::string size = magnitude(operand);
    return operand.negated ? "-" + in_brackets(size) : size;
  }

  std::string zero(const Operand& operand) {
    if (operand.slot == Slot::value) {
      const Instruction& i = function_.code[operand.index];
      if (i.op == Op::sin) return of(i.operands[0]) + " = k pi";
      if (i.op == Op::cos) return of(i.operands[0]) + " = pi/2 + k pi";
    }
    return magnitude(operand) + " = 0";
  }

  std::string magnitude(const Operand& operand) {
    switch (operand.slot) {
      case Slot::constant: return number(function_.constants[operand.index]);
      case Slot::pi: return "pi";
      case Slot::time: return "t";
      case Slot::state: return state(operand.index);
      case Slot::parameter: return model_.parameters[operand.index].name;
      case Slot::input: return model_.inputs[operand.index].name;
      case Slot::prepared: return fmt::format("w[{}]", operand.index);
      case Slot::vector: return fmt::format("v[{}]", operand.index);
      case Slot::side: return fmt::format("side[{}]", operand.index);
      case Slot::contact: return fmt::format("mode[{}]", operand.index);
      case Slot::value: break;
    }
    std::string& text = known_[operand.index];
    if (text.empty()) {
      text = call(function_.code[operand.index]);
      if (text.size() > longest) {
        const std::string& name = function_.code[operand.index].name;
        text = name.empty() || name.find('{') != std::string::npos ? fmt::format("<value {}>", operand.index)
                                                                   : fmt::format("<{}>", name);
      }
    }
    return text;
  }

 private:
  static std::string number(const symbolic::Rational& value) {
    return cln::denominator(value) == 1 ? fmt::format("{:.17g}", cln::double_approx(value))
                                        : fmt::format("{:.17g}/{:.17g}", cln::double_approx(cln::numerator(value)),
                                                      cln::double_approx(cln::denominator(value)));
  }

  std::string state(std::uint32_t i) const {
    const std::size_t n = program_.free.size(), others = program_.layout().first_order_begin();
    if (i >= others) return model_.states[program_.states[i - others].index].name;
    const std::string& name = model_.coordinates[program_.free[i % n]].name;
    return i < n ? name : name + "_dot";
  }

  static bool is_plain(const std::string& text) { return text.find_first_of("+- ") == std::string::npos; }
  static std::string in_brackets(const std::string& text) { return is_plain(text) ? text : "(" + text + ")"; }

  std::string call(const Instruction& i) {
    std::string text;
    switch (i.op) {
      case Op::add:
        for (const Operand& o : i.operands)
          text += (text.empty() ? (o.negated ? "-" : "")
                   : o.negated  ? " - "
                                : " + ") +
                  (o.negated ? in_brackets(magnitude(o)) : magnitude(o));
        return text;
      case Op::mul:
        for (const Operand& o : i.operands) text += (text.empty() ? "" : "*") + in_brackets(of(o));
        return text;
      case Op::div: {
        const std::string below = of(i.operands[1]);
        const bool plain = below.find_first_of("+-*/ ") == std::string::npos;
        return in_brackets(of(i.operands[0])) + "/" + (plain ? below : "(" + below + ")");
      }
      case Op::power: return in_brackets(of(i.operands[0])) + fmt::format("^{}", i.exponent);
      case Op::pow: return in_brackets(of(i.operands[0])) + "^" + in_brackets(of(i.operands[1]));
      default: break;
    }
    for (const Operand& o : i.operands) text += (text.empty() ? "" : ", ") + of(o);
    return symbolic::function_of(i.op).name + ("(" + text + ")");
  }

  const Function& function_;
  const program::Program& program_;
  const model::Model& model_;
  std::vector<std::string> known_;
};

/// Lists the operands whose zeros make the function undefined: factors of a product, arguments of a root or a power.
void factors(const Function& function, const Operand& operand, std::vector<Operand>& list) {
  if (operand.slot == Slot::value) {
    const Instruction& i = function.code[operand.index];
    if (i.op == Op::mul) {
      for (const Operand& o : i.operands) factors(function, o, list);
      return;
    }
    if ((i.op == Op::power && i.exponent > 0) || i.op == Op::sqrt) return factors(function, i.operands[0], list);
  }
  if (operand.slot != Slot::constant && operand.slot != Slot::pi) list.push_back(operand);
}

bool same(const Operand& a, const Operand& b) { return a.slot == b.slot && a.index == b.index; }

/// The message of the emitted code for a zero of this denominator.
std::string test_of(const Function& function, const Operand& denominator) {
  for (const program::PivotTest& test : function.pivots) {
    if (!same(test.pivot, denominator)) continue;
    const bool absolute = test.scale.slot == Slot::constant && cln::zerop(function.constants[test.scale.index]);
    return absolute ? "code 1 where it is 0"
                    : fmt::format("code 1 below {:g} of what it is left of", program::pivot_tolerance);
  }
  return "code 5, since the accelerations are not finite";
}

}  // namespace

std::vector<Divisor> list_divisors(const Function& function, const program::Program& program,
                                   const mechanics::Mechanics& mechanics) {
  std::vector<Operand> whole;
  for (const Instruction& i : function.code) {
    if (i.op == Op::div) whole.push_back(i.operands[1]);
    if (i.op == Op::power && i.exponent < 0) whole.push_back(i.operands[0]);
  }
  for (const program::PivotTest& test : function.pivots) whole.push_back(test.pivot);
  Text text(function, program, mechanics);
  std::vector<Divisor> list;
  for (const Operand& denominator : whole) {
    std::vector<Operand> parts;
    factors(function, denominator, parts);
    for (Operand part : parts) {
      part.negated = false;
      const std::string expression = text.magnitude(part);
      if (std::any_of(list.begin(), list.end(), [&](const Divisor& d) { return d.expression == expression; })) continue;
      list.push_back({part, expression, text.zero(part), test_of(function, parts.size() > 1 ? denominator : part)});
    }
  }
  return list;
}

}  // namespace eomgen::stress
