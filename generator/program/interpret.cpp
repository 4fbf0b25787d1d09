// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/interpret.hpp"

#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "symbolic/dag.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::program {
namespace {

using symbolic::Op;
using symbolic::Ref;

/// Functions other than + - * / are left to the evaluation of the Dag, one node at a time: one definition of each.
template <class Real>
Real call(Op op, const std::vector<Real>& arguments, int digits) {
  symbolic::Dag dag;
  std::vector<Ref> refs;
  for (std::uint32_t i = 0; i < arguments.size(); ++i) refs.push_back(dag.symbol({symbolic::SymbolKind::extra, i, 0}));
  Ref root;
  switch (op) {
    case Op::pow: root = dag.pow(refs[0], refs[1]); break;
    case Op::atan2:
    case Op::min:
    case Op::max: root = dag.call(op, refs[0], refs[1]); break;
    case Op::select: root = dag.select(refs[0], refs[1], refs[2], refs[3]); break;
    case Op::div: root = dag.div(refs[0], refs[1]); break;
    default: root = dag.call(op, refs[0]); break;
  }
  const std::function<Real(const symbolic::Symbol&)> lookup = [&](const symbolic::Symbol& s) {
    return arguments[s.index];
  };
  if constexpr (std::is_same_v<Real, double>) {
    return symbolic::evaluate(dag, {root}, lookup)[0];
  } else {
    return symbolic::evaluate(dag, {root}, lookup, digits)[0];
  }
}

template <class Real>
Values<Real> run(const Function& function, const Arguments<Real>& arguments, int digits,
                 const std::function<Real(const symbolic::Rational&)>& number, const Real& pi) {
  std::vector<Real> value;
  value.reserve(function.code.size());
  std::vector<std::string> reasons;            // why values are missing; the branch that is not taken may be
  std::map<std::size_t, std::size_t> missing;  // values, by reason
  const auto why = [&](const Operand& operand) -> std::optional<std::size_t> {
    const auto found = operand.slot == Slot::value ? missing.find(operand.index) : missing.end();
    return found == missing.end() ? std::nullopt : std::optional(found->second);
  };
  const auto read = [&](const Operand& operand) -> Real {
    const Real size = [&]() -> Real {
      switch (operand.slot) {
        case Slot::constant: return number(function.constants[operand.index]);
        case Slot::pi: return pi;
        case Slot::time: return arguments.t;
        case Slot::state: return arguments.x.at(operand.index);
        case Slot::parameter: return arguments.p.at(operand.index);
        case Slot::input: return arguments.u.at(operand.index);
        case Slot::prepared: return arguments.w.at(operand.index);
        case Slot::side: return operand.index < arguments.side.size() ? arguments.side[operand.index] : Real(0);
        case Slot::contact: return Real(eom::contact_leaf(arguments.mode, operand.index));
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
    std::vector<Real> operands;
    for (const Operand& operand : instruction.operands) operands.push_back(read(operand));
    if (instruction.op == Op::add || instruction.op == Op::mul) {
      Real result = operands[0];
      for (std::size_t i = 1; i < operands.size(); ++i) {
        result = instruction.op == Op::add ? Real(result + operands[i]) : Real(result * operands[i]);
      }
      value.push_back(result);
    } else {
      try {
        value.push_back(call(instruction.op, operands, digits));
      } catch (const std::domain_error& outside) {
        missing.emplace(value.size(), reasons.size());
        reasons.emplace_back(outside.what());
        value.emplace_back(0);
      }
    }
  }
  Values<Real> values;
  for (const auto& [name, entries] : function.results) {
    std::vector<Real> list;
    for (const Operand& entry : entries) list.push_back(needed(entry));
    values.results.push_back(std::move(list));
  }
  for (const PivotTest& test : function.pivots) values.pivots.emplace_back(needed(test.pivot), needed(test.scale));
  return values;
}

}  // namespace

Values<cln::cl_R> interpret(const Function& function, const Arguments<cln::cl_R>& arguments, int digits) {
  const cln::float_format_t format = cln::float_format(static_cast<std::uintptr_t>(digits));
  const auto rounded = [format](const cln::cl_R& x) -> cln::cl_R { return cln::cl_float(x, format); };
  Arguments<cln::cl_R> floats{rounded(arguments.t), {}, {}, {}, {}, arguments.side, arguments.mode};
  for (const auto& [from, to] : {std::pair{&arguments.x, &floats.x},
                                 {&arguments.p, &floats.p},
                                 {&arguments.u, &floats.u},
                                 {&arguments.w, &floats.w}}) {
    for (const cln::cl_R& x : *from) to->push_back(rounded(x));
  }
  const std::function<cln::cl_R(const symbolic::Rational&)> number = [&](const symbolic::Rational& x) {
    return rounded(x);
  };
  return run<cln::cl_R>(function, floats, digits, number, cln::pi(format));
}

Values<double> interpret(const Function& function, const Arguments<double>& arguments) {
  const std::function<double(const symbolic::Rational&)> number = [](const symbolic::Rational& x) {
    return cln::double_approx(x);
  };
  return run<double>(function, arguments, 0, number, 3.14159265358979323846);
}

}  // namespace eomgen::program
