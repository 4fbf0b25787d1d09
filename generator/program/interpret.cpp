// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/interpret.hpp"

#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "lists.hpp"
#include "symbolic/arithmetic.hpp"
#include "work.hpp"

namespace eomgen::program {
namespace {

/// Functions are computed in binary64 and rounded, so that results do not depend on the machine.
struct Binary32 {
  using Number = float;
  using Twice = symbolic::Binary64Arithmetic;
  static float round(float x) { return x; }
  static float constant(const symbolic::Rational& value) { return static_cast<float>(Twice::constant(value)); }
  static float pi() { return static_cast<float>(Twice::pi()); }
  static float divide(float a, float b) { return a / b; }
  static float power(float a, long n) { return static_cast<float>(Twice::power(static_cast<double>(a), n)); }
  static float pow(float a, float b) {
    return static_cast<float>(Twice::pow(static_cast<double>(a), static_cast<double>(b)));
  }
  static float call(Op op, float x) { return static_cast<float>(Twice::call(op, static_cast<double>(x))); }
  static float atan2(float y, float x) {
    return static_cast<float>(Twice::atan2(static_cast<double>(y), static_cast<double>(x)));
  }
  static bool less(float a, float b) { return a < b; }
};

template <class Real, class Arithmetic>
Values<Real> run(const Function& function, const Arguments<Real>& arguments, const Arithmetic& number) {
  work::throw_if_stopped();
  const Real pi = number.pi();
  std::vector<Real> value;
  value.reserve(function.code.size());
  std::vector<std::string> reasons;            // reasons for missing values; branches not taken may lack one
  std::map<std::size_t, std::size_t> missing;  // index of a missing value -> index of its reason
  const auto why = [&](const Operand& operand) -> std::optional<std::size_t> {
    const auto found = operand.slot == Slot::value ? missing.find(operand.index) : missing.end();
    return found == missing.end() ? std::nullopt : std::optional(found->second);
  };
  const auto read = [&](const Operand& operand) -> Real {
    const Real size = [&]() -> Real {
      switch (operand.slot) {
        case Slot::constant: return number.constant(function.constants[operand.index]);
        case Slot::pi: return pi;
        case Slot::time: return arguments.t;
        case Slot::state: return arguments.x.at(operand.index);
        case Slot::parameter: return arguments.p.at(operand.index);
        case Slot::input: return arguments.u.at(operand.index);
        case Slot::prepared: return arguments.w.at(operand.index);
        case Slot::vector: return arguments.v.at(operand.index);
        case Slot::side: return operand.index < arguments.side.size() ? arguments.side[operand.index] : Real(0);
        case Slot::contact: return Real(contact_sign(arguments, operand.index));
        case Slot::value: break;
      }
      return value[operand.index];
    }();
    return operand.negated ? Real(-size) : size;
  };
  const auto needed = [&](const Operand& operand) -> Real {
    if (const std::optional<std::size_t> reason = why(operand)) throw std::domain_error(reasons[*reason]);
    return read(operand);
  };
  const auto gap = [&](const Instruction& instruction) -> std::optional<std::size_t> {
    if (missing.empty()) return std::nullopt;
    const bool select = instruction.op == Op::select;
    for (std::size_t i = 0; i < (select ? 2 : instruction.operands.size()); ++i) {
      if (const std::optional<std::size_t> reason = why(instruction.operands[i])) return reason;
    }
    if (!select) return std::nullopt;
    return why(instruction.operands[read(instruction.operands[0]) < read(instruction.operands[1]) ? 2 : 3]);
  };
  for (const Instruction& instruction : function.code) {
    if (const std::optional<std::size_t> reason = gap(instruction)) {
      missing.emplace(value.size(), *reason);
      value.emplace_back(0);
      continue;
    }
    std::vector<Real> operands = mapped(instruction.operands, [&](const Operand& operand) { return read(operand); });
    if (instruction.op == Op::add || instruction.op == Op::mul) {
      Real result = operands[0];
      for (std::size_t i = 1; i < operands.size(); ++i) {
        result = instruction.op == Op::add ? Real(result + operands[i]) : Real(result * operands[i]);
      }
      value.push_back(result);
    } else {
      try {
        for (Real& operand : operands) operand = number.round(operand);  // mode values are exact up to here
        const auto operand = [&](std::size_t i) -> const Real& { return operands[i]; };
        value.push_back(symbolic::value_of(instruction.op, 0, operand, number));
      } catch (const std::domain_error& outside) {
        missing.emplace(value.size(), reasons.size());
        reasons.emplace_back(outside.what());
        value.emplace_back(0);
      }
    }
  }
  Values<Real> values;
  for (const Result& result : function.results) {
    std::vector<Real> list = mapped(result.entries, [&](const Operand& entry) { return needed(entry); });
    values.results.push_back(std::move(list));
  }
  for (const PivotTest& test : function.pivots) values.pivots.emplace_back(needed(test.pivot), needed(test.scale));
  return values;
}

}  // namespace

Values<cln::cl_R> interpret(const Function& function, const Arguments<cln::cl_R>& arguments, int digits) {
  const symbolic::ClnArithmetic number{cln::float_format(static_cast<std::uintptr_t>(digits))};
  Arguments<cln::cl_R> floats{number.round(arguments.t), {}, {}, {}, {}, arguments.side, arguments.mode, {}};
  for (const auto& [from, to] : {std::pair{&arguments.x, &floats.x},
                                 {&arguments.p, &floats.p},
                                 {&arguments.u, &floats.u},
                                 {&arguments.w, &floats.w},
                                 {&arguments.v, &floats.v}}) {
    for (const cln::cl_R& x : *from) to->push_back(number.round(x));
  }
  return run(function, floats, number);
}

Values<double> interpret(const Function& function, const Arguments<double>& arguments) {
  return run(function, arguments, symbolic::Binary64Arithmetic{});
}

Values<float> interpret(const Function& function, const Arguments<float>& arguments) {
  return run(function, arguments, Binary32{});
}

}  // namespace eomgen::program
