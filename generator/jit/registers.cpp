// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/registers.hpp"

#include <stdexcept>

namespace eomgen::jit {

UsePositions::UsePositions(std::size_t values, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& uses)
    : begin_(values + 1, 0), positions_(uses.size()) {
  for (const auto& [value, position] : uses) ++begin_[value + 1];
  for (std::size_t i = 0; i < values; ++i) begin_[i + 1] += begin_[i];
  cursor_.assign(begin_.begin(), begin_.end() - 1);
  for (const auto& [value, position] : uses) positions_[cursor_[value]++] = position;
  cursor_.assign(begin_.begin(), begin_.end() - 1);
}

std::uint32_t UsePositions::next(std::uint32_t value, std::uint32_t position) {
  std::uint32_t& at = cursor_[value];
  while (at < begin_[value + 1] && positions_[at] < position) ++at;
  return at < begin_[value + 1] ? positions_[at] : never;
}

bool UsePositions::has_use_after(std::uint32_t value, std::uint32_t position) {
  next(value, position);
  const std::uint32_t end = begin_[value + 1];
  return cursor_[value] < end && positions_[end - 1] > position;
}

Location Registers::location(std::uint32_t value) const {
  const Held& held = value_[value];
  if (held.reg != none) return {Place::register_, held.reg};
  if (held.scratch == nowhere) throw std::logic_error("a value is used that is nowhere");
  return {Place::scratch, held.scratch};
}

std::uint8_t Registers::acquire() {
  std::uint8_t best = none;
  std::uint32_t furthest = 0;
  for (std::uint8_t r = 0; r < register_count; ++r) {
    if (holds_[r] == reserved) continue;
    if (holds_[r] == nothing) {
      holds_[r] = reserved;
      return r;
    }
    const std::uint32_t next = uses_.next(holds_[r], position_);
    // Of equally far ones a value that need not be stored gives way.
    const bool better = best == none || next > furthest || (next == furthest && value_[holds_[r]].scratch != nowhere);
    if (better) best = r, furthest = next;
  }
  if (best == none) throw std::logic_error("no register is left");
  store(holds_[best]);
  value_[holds_[best]].reg = none;
  holds_[best] = reserved;
  return best;
}

std::uint8_t Registers::take(std::uint32_t value) {
  const std::uint8_t reg = value_[value].reg;
  value_[value].reg = none;
  holds_[reg] = reserved;
  return reg;
}

void Registers::assign(std::uint8_t reg, std::uint32_t value) {
  holds_[reg] = value;
  value_[value].reg = reg;
}

void Registers::drop_if_unused(std::uint32_t value) {
  Held& held = value_[value];
  if (!is_last_use(value)) return;
  if (held.reg != none) holds_[held.reg] = nothing;
  if (held.scratch != nowhere) free_scratch(held.scratch);
  held = {};
}

void Registers::store_for_call() {
  for (const std::uint32_t value : holds_) {
    if (value != nothing && value != reserved && !is_last_use(value)) store(value);
  }
}

void Registers::empty_after_call() {
  for (std::uint32_t& value : holds_) {
    if (value == nothing) continue;
    if (value != reserved) value_[value].reg = none;
    value = nothing;
  }
}

void Registers::store(std::uint32_t value) {
  Held& held = value_[value];
  if (held.scratch != nowhere) return;
  held.scratch = new_scratch();
  steps_.push_back({Action::store, held.reg, {Place::scratch, held.scratch}, 0});
}

std::uint32_t Registers::new_scratch() {
  if (free_.empty()) return scratch_size_++;
  const std::uint32_t index = free_.back();
  free_.pop_back();
  return index;
}

std::uint32_t Registers::new_scratch_block(std::uint32_t size) {
  const std::uint32_t first = scratch_size_;
  scratch_size_ += size;
  return first;
}

}  // namespace eomgen::jit
