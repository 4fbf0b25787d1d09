// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/random_programs.hpp"

#include <random>

namespace test_systems {
namespace {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

constexpr std::uint32_t coordinates = 3, parameters = 5, inputs = 2, prepared = 4, constants = 6, sides = 2,
                        contacts = 4;

class RandomFunction {
 public:
  RandomFunction(std::string name, std::uint64_t seed) : random_(seed) {
    function_.name = std::move(name);
    has_mode_ = function_.name != "mass" && function_.name != "prepare";
    for (const char* text : {"0", "1", "2", "1/3", "271/100", "1/1000"}) function_.constants.emplace_back(text);
  }

  Function run(std::size_t length, const std::vector<std::pair<std::string, std::size_t>>& results) {
    while (function_.code.size() < length) {
      if (number(40) == 0)
        add_group();
      else
        add(operation());
      if (number(30) == 0) function_.pivots.push_back({value(), number(3) == 0 ? zero() : value()});
    }
    for (const auto& [result, entries] : results) {
      program::Result to{result, {}, 0};
      for (std::size_t i = 0; i < entries; ++i) to.entries.push_back(operand());
      function_.results.push_back(std::move(to));
    }
    if (function_.name == "rhs") function_.results.push_back({"", {operand()}, 3});
    return std::move(function_);
  }

 private:
  std::uint32_t number(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  static Operand zero() { return {Slot::constant, 0, false}; }

  Operand leaf() {
    const bool is_prepare = function_.name == "prepare";
    switch (is_prepare ? number(2) : number(has_mode_ ? 9 : 7)) {
      case 0: return {Slot::parameter, number(parameters), false};
      case 1: return {Slot::constant, 1 + number(constants - 1), false};
      case 2: return {Slot::pi, 0, false};
      case 3: return {Slot::time, 0, false};
      case 4:
        if (function_.name == "rhs_prepared") return {Slot::prepared, number(prepared), false};
        [[fallthrough]];
      case 5: return {Slot::state, number(2 * coordinates), false};
      case 6: return {Slot::input, number(inputs), false};
      case 7: return {Slot::side, number(sides), false};
      default: return {Slot::contact, number(contacts), false};
    }
  }
  /// A recent value, an old one, or a leaf.
  Operand value() {
    const auto size = static_cast<std::uint32_t>(function_.code.size());
    if (size == 0 || number(4) == 0) return leaf();
    const std::uint32_t back = number(3) == 0 ? number(size) : number(std::min(size, 12u));
    return {Slot::value, size - 1 - back, false};
  }
  Operand operand() {
    Operand result = value();
    result.negated = number(4) == 0;
    return result;
  }

  Op operation() {
    constexpr std::array<Op, 24> all{Op::add,  Op::add,  Op::add, Op::add, Op::mul,  Op::mul,   Op::mul,  Op::mul,
                                     Op::div,  Op::sqrt, Op::pow, Op::sin, Op::cos,  Op::tan,   Op::asin, Op::atan,
                                     Op::tanh, Op::exp,  Op::log, Op::abs, Op::sign, Op::atan2, Op::min,  Op::select};
    constexpr std::array<Op, 4> rare{Op::max, Op::acos, Op::sinh, Op::cosh};
    return number(12) == 0 ? rare.at(number(rare.size())) : all.at(number(all.size()));
  }

  void add(Op op, std::uint32_t group = 0, std::uint32_t lane = 0, const Operand* angle = nullptr) {
    Instruction instruction;
    instruction.op = op;
    instruction.pack = group;
    instruction.lane = lane;
    const std::size_t count = op == Op::add || op == Op::mul ? 2 + number(3)
                              : op == Op::select             ? 4
                              : op == Op::div || op == Op::pow || op == Op::atan2 || op == Op::min || op == Op::max ? 2
                                                                                                                    : 1;
    for (std::size_t k = 0; k < count; ++k) instruction.operands.push_back(angle != nullptr ? *angle : operand());
    const bool is_called = op != Op::add && op != Op::mul && op != Op::div && op != Op::select;
    // A compiler may compute functions of the few values of `mode` and of signs beforehand, and round them once.
    while (is_called && group == 0 && has_few_values(instruction))
      instruction.operands[0] = {Slot::parameter, number(parameters), false};
    // The graph takes signs out of odd and even functions.
    if (op == Op::sin || op == Op::cos || op == Op::tan || op == Op::atan) instruction.operands[0].negated = false;
    if (count > 1 && number(6) == 0)
      instruction.operands[1].index = instruction.operands[0].index,
      instruction.operands[1].slot = instruction.operands[0].slot;
    of_few_.push_back(op == Op::sign || has_few_values(instruction));
    const auto& o = instruction.operands;
    is_number_.push_back(
        std::all_of(o.begin(), o.end(), [this](const Operand& operand) { return is_number(operand); }));
    function_.code.push_back(std::move(instruction));
  }
  bool is_number(const Operand& operand) const {
    return operand.slot == Slot::constant || operand.slot == Slot::pi ||
           (operand.slot == Slot::value && is_number_[operand.index]);
  }
  bool has_few_values(const Instruction& instruction) const {
    bool depends = false;
    for (const Operand& operand : instruction.operands) {
      const bool is_of_few = operand.slot == Slot::side || operand.slot == Slot::contact ||
                             (operand.slot == Slot::value && of_few_[operand.index]);
      if (!is_number(operand) && !is_of_few) return false;
      depends = depends || is_of_few;
    }
    return depends;
  }
  void add_group() {
    const std::uint32_t angles = 2 + number(4);
    std::vector<Operand> list;
    while (list.size() < angles) {
      const Operand angle = operand();
      if (!is_number(angle)) list.push_back(angle);
    }
    ++groups_;
    for (std::uint32_t k = 0; k < angles; ++k) {
      const std::uint32_t kind = number(3);
      if (kind != 0) add(Op::sin, groups_, k, &list[k]);
      if (kind != 1) add(Op::cos, groups_, k, &list[k]);
    }
  }

  std::mt19937_64 random_;
  Function function_;
  bool has_mode_ = true;
  std::vector<bool> of_few_, is_number_;  // per instruction: made of `mode`, signs and numbers, of numbers
  std::uint32_t groups_ = 0;
};

}  // namespace

Example random_example(std::uint64_t seed, std::size_t length) {
  Example e;
  const auto add = [&](const char* name, std::size_t size,
                       const std::vector<std::pair<std::string, std::size_t>>& results) {
    e.program.functions.push_back(RandomFunction(name, seed * 1000 + e.program.functions.size()).run(size, results));
  };
  constexpr std::size_t states = 2 * coordinates;
  for (std::uint32_t i = 0; i < coordinates; ++i) {
    e.program.free.push_back(i);
    e.context.coordinates.push_back({"q" + std::to_string(i), "m", "", 0});
  }
  add("rhs", 60, {{"dx", states}});
  add("jac", 90, {{"dfdx", states * states}, {"dfdt", states}});
  add("mass", 40, {{"M", coordinates * coordinates}, {"h", coordinates}});
  add("outputs", length, {{"y", 40}});
  add("prepare", 20, {{"w", prepared}});
  add("rhs_prepared", 60, {{"dx", states}});
  for (std::size_t i = 0; i < 40; ++i) e.program.outputs.push_back("y" + std::to_string(i));
  for (std::uint32_t k = 0; k < sides; ++k) e.program.kinks.push_back("abs");
  for (std::uint32_t k = 0; k < contacts / 2; ++k) {
    e.program.contacts.emplace_back();
    e.program.contacts.back().name = "c" + std::to_string(k);
  }
  e.context.id = "random" + std::to_string(seed);
  e.context.content_hash = "0123abcd";
  e.context.verdict = "none";
  for (std::uint32_t i = 0; i < parameters; ++i)
    e.context.parameters.push_back({"p" + std::to_string(i), "kg", "", 0.5 + i});
  for (std::uint32_t i = 0; i < inputs; ++i)
    e.context.inputs.push_back({"u" + std::to_string(i), "N", "", 0.25 - 2 * static_cast<double>(i)});
  e.context.start.assign(states, 0.5);
  return e;
}

}  // namespace test_systems
