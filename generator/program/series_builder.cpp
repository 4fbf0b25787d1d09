// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/series_builder.hpp"

#include <algorithm>

#include "program/taylor.hpp"

namespace eomgen::program {
namespace {

using symbolic::Op;

// Operands of `next` whose index in w is known only at the end: {input, i} is sum i; the two constants are {side, 0}
// and {side, 1}.
constexpr Operand time_rate{Slot::side, 0}, one_over_k{Slot::side, 1}, order_k{Slot::time, 0};

}  // namespace

SeriesBuilder::SeriesBuilder(const Function& rhs) {
  start_.name = "taylor_start";
  next_.name = "taylor_next";
  start_.constants = rhs.constants;
  start_.uses_input = rhs.uses_input;
}

Series SeriesBuilder::read(const Operand& operand) const {
  Series series;
  switch (operand.slot) {
    case Slot::value: series = values_[operand.index]; break;
    case Slot::state: series = {true, {Slot::state, operand.index}, {Slot::state, operand.index}}; break;
    case Slot::time: series = {true, {Slot::time, 0}, time_rate}; break;
    default: series.zero = {operand.slot, operand.index};
  }
  return operand.negated ? negate(series) : series;
}

Operand SeriesBuilder::start_value(const Operand& value) {
  Operand result = value;
  if (value.slot == Slot::constant) {
    result = constant(next_, start_.constants[value.index]);
  } else if (value.slot != Slot::pi) {
    const auto [at, anew] = kept_.try_emplace({value.slot, value.index}, static_cast<std::uint32_t>(zeros_.size()));
    if (anew) zeros_.push_back({value.slot, value.index});
    result = {Slot::prepared, at->second};
  }
  result.negated = value.negated;
  return result;
}

Operand SeriesBuilder::open_sum(const Operand& a) {
  factors_.push_back({a, {}});
  return {Slot::input, static_cast<std::uint32_t>(factors_.size() - 1)};
}

Operand SeriesBuilder::sum(const Operand& a, const Operand& b) {
  const Operand result = open_sum(a);
  close_sum(result, b);
  return result;
}

Operand SeriesBuilder::times_order(const Series& a) {
  const auto [at, anew] = times_order_.try_emplace(key(a.next));
  if (anew) at->second = at_next(Op::mul, {order_k, a.next});
  return at->second;
}

Operand SeriesBuilder::divide_by_order(const Operand& w) { return at_next(Op::mul, {one_over_k, w}); }

void SeriesBuilder::write_results(const Function& rhs) {
  for (const Result& result : rhs.results) {
    std::vector<Operand> zero, next;
    for (const Operand& entry : result.entries) {
      const Series series = read(entry);
      zero.push_back(series.zero);
      next.push_back(series.varies ? series.next : constant(next_, 0));
    }
    start_.results.push_back({result.name, zero, result.code});
    if (!result.is_test()) next_.results.push_back({result.name, next});
  }
  for (const PivotTest& test : rhs.pivots) start_.pivots.push_back({read(test.pivot).zero, read(test.scale).zero});
  const Operand none = constant(next_, 0);
  while (factors_.empty() || factors_.size() % taylor_lanes != 0) factors_.push_back({none, none});
  std::array<std::vector<Operand>, 2> columns;
  for (const std::array<Operand, 2>& pair : factors_) {
    columns[0].push_back(pair[0]);
    columns[1].push_back(pair[1]);
  }
  next_.results.insert(next_.results.begin(), {{"a", columns[0]}, {"b", columns[1]}});
  start_.results.insert(start_.results.begin(), {"z", zeros_});
}

/// Resolves an operand of `next` that was created before the length of w was known.
void SeriesBuilder::place(Operand& o) const {
  const auto zeros = static_cast<std::uint32_t>(zeros_.size()), sums = static_cast<std::uint32_t>(factors_.size());
  if (o.slot == Slot::input) o = {Slot::prepared, zeros + o.index, o.negated};
  if (o.slot == Slot::side) o = {Slot::prepared, zeros + sums + o.index, o.negated};
}

/// Renumbers packs and lanes by adjacency: an added partner may have its angle in another pack.
void SeriesBuilder::number_packs() {
  std::uint32_t packs = 0, before = 0;
  std::vector<Operand> angles;
  for (Instruction& instruction : start_.code) {
    const std::uint32_t pack = instruction.pack;
    if (pack != 0) {
      if (pack != before) angles.clear(), ++packs;
      const auto at = std::find(angles.begin(), angles.end(), instruction.operands[0]);
      instruction.pack = packs;
      instruction.lane = static_cast<std::uint32_t>(at - angles.begin());
      if (at == angles.end()) angles.push_back(instruction.operands[0]);
    }
    before = pack;
  }
}

Taylor SeriesBuilder::finished(const Function& rhs) {
  write_results(rhs);
  number_packs();
  for (Instruction& instruction : next_.code)
    std::for_each(instruction.operands.begin(), instruction.operands.end(), [this](Operand& o) { place(o); });
  for (Result& result : next_.results)
    std::for_each(result.entries.begin(), result.entries.end(), [this](Operand& o) { place(o); });
  for (Function* function : {&start_, &next_}) {
    for (const Instruction& instruction : function->code)
      function->operations.count(instruction.op, instruction.operands.size());
  }
  return {std::move(start_), std::move(next_), zeros_.size(), factors_.size()};
}

}  // namespace eomgen::program
