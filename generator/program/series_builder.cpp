// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/series_builder.hpp"

#include "program/taylor.hpp"

namespace eomgen::program {
namespace {

// Operands of `next` whose index in w is known only at the end: {input, i} is sum i; the two constants are {side, 0}
// and {side, 1}.
constexpr Operand time_rate{Slot::side, 0}, one_over_k{Slot::side, 1}, order_k{Slot::time, 0};

/// Entries that are used, and their indices without the others.
class Used {
 public:
  explicit Used(std::size_t count) : used_(count, false) {}

  /// Whether the entry was unused before.
  bool mark(std::size_t i) {
    if (used_[i]) return false;
    return used_[i] = true;
  }
  bool operator[](std::size_t i) const { return used_[i]; }
  /// Removes the unused entries. `renumber` maps indices afterwards.
  template <class T>
  void compact(std::vector<T>& entries) {
    index_.assign(entries.size(), 0);
    std::size_t count = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      index_[i] = static_cast<std::uint32_t>(count);
      if (!used_[i]) continue;
      if (count != i) entries[count] = std::move(entries[i]);
      ++count;
    }
    entries.resize(count);
  }
  void renumber(Operand& operand) const { operand.index = index_[operand.index]; }

 private:
  std::vector<bool> used_;
  std::vector<std::uint32_t> index_;
};

/// The heading of an instruction that goes belongs to the next one of the section.
void keep_sections(std::vector<Instruction>& code, const Used& used) {
  std::string pending;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (!code[i].section.empty()) pending = code[i].section;
    if (!used[i]) continue;
    code[i].section.swap(pending);
    pending.clear();
  }
}

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
}

/// Removes the instructions, sums and values of order 0 on which no coefficient depends. The condition of a branch has
/// such ones: only its value of order 0 counts.
void SeriesBuilder::drop_unused_of_next() {
  Used code(next_.code.size()), sums(factors_.size()), zeros(zeros_.size());
  std::vector<Operand> open;
  for (const Result& result : next_.results) open.insert(open.end(), result.entries.begin(), result.entries.end());
  while (!open.empty()) {
    const Operand operand = open.back();
    open.pop_back();
    if (operand.slot == Slot::value && code.mark(operand.index)) {
      const std::vector<Operand>& operands = next_.code[operand.index].operands;
      open.insert(open.end(), operands.begin(), operands.end());
    }
    if (operand.slot == Slot::input && sums.mark(operand.index))
      open.insert(open.end(), factors_[operand.index].begin(), factors_[operand.index].end());
    if (operand.slot == Slot::prepared) zeros.mark(operand.index);
  }
  code.compact(next_.code);
  sums.compact(factors_);
  zeros.compact(zeros_);
  const auto renumber = [&](Operand& operand) {
    if (operand.slot == Slot::value) code.renumber(operand);
    if (operand.slot == Slot::input) sums.renumber(operand);
    if (operand.slot == Slot::prepared) zeros.renumber(operand);
  };
  for (Instruction& instruction : next_.code)
    std::for_each(instruction.operands.begin(), instruction.operands.end(), renumber);
  for (Result& result : next_.results) std::for_each(result.entries.begin(), result.entries.end(), renumber);
  for (std::array<Operand, 2>& pair : factors_) std::for_each(pair.begin(), pair.end(), renumber);
}

/// The same for `start`, whose values of order 0 are results.
void SeriesBuilder::drop_unused_of_start() {
  const auto each_root = [this](auto&& visit) {
    for (Result& result : start_.results) std::for_each(result.entries.begin(), result.entries.end(), visit);
    for (PivotTest& test : start_.pivots) visit(test.pivot), visit(test.scale);
  };
  Used code(start_.code.size());
  each_root([&code](const Operand& operand) {
    if (operand.slot == Slot::value) code.mark(operand.index);
  });
  for (std::size_t i = start_.code.size(); i-- > 0;) {  // operands stand before
    if (!code[i]) continue;
    for (const Operand& operand : start_.code[i].operands) {
      if (operand.slot == Slot::value) code.mark(operand.index);
    }
  }
  keep_sections(start_.code, code);
  code.compact(start_.code);
  const auto renumber = [&code](Operand& operand) {
    if (operand.slot == Slot::value) code.renumber(operand);
  };
  each_root(renumber);
  for (Instruction& instruction : start_.code)
    std::for_each(instruction.operands.begin(), instruction.operands.end(), renumber);
}

/// The factors of the sums, filled up to whole lanes, as results.
void SeriesBuilder::write_factors() {
  const Operand none = constant(next_, 0);
  while (factors_.empty() || factors_.size() % taylor_lanes != 0) factors_.push_back({none, none});
  std::array<std::vector<Operand>, 2> columns;
  for (const std::array<Operand, 2>& pair : factors_) {
    columns[0].push_back(pair[0]);
    columns[1].push_back(pair[1]);
  }
  next_.results.insert(next_.results.begin(), {{"a", columns[0]}, {"b", columns[1]}});
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
  drop_unused_of_next();
  start_.results.insert(start_.results.begin(), {"z", zeros_});
  drop_unused_of_start();
  write_factors();
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
