// SPDX-License-Identifier: GPL-3.0-or-later
// The values of a function in registers and in the scratch array, while its steps are written.
#pragma once

#include <array>
#include <vector>

#include "jit/steps.hpp"

namespace eomgen::jit {

/// Positions at which values are used, ascending for each value.
class UsePositions {
 public:
  /// `uses`: pairs of value and position, by ascending position.
  UsePositions(std::size_t values, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& uses);

  static constexpr std::uint32_t never = ~0u;
  /// The first use at `position` or later. Positions must not decrease from call to call.
  std::uint32_t next(std::uint32_t value, std::uint32_t position);
  /// Whether there is a use after `position`.
  bool has_use_after(std::uint32_t value, std::uint32_t position);

 private:
  std::vector<std::uint32_t> begin_, positions_, cursor_;
};

class Registers {
 public:
  Registers(std::size_t values, UsePositions uses, std::vector<Step>& steps)
      : uses_(std::move(uses)), steps_(steps), value_(values) {
    holds_.fill(nothing);
  }

  /// The current position in the program.
  void move_to(std::uint32_t position) { position_ = position; }

  Location location(std::uint32_t value) const;
  /// The place of a stored value in the scratch array.
  Location memory(std::uint32_t value) const { return {Place::scratch, value_[value].scratch}; }
  bool in_register(std::uint32_t value) const { return value_[value].reg != none; }
  /// Whether nothing after the current position needs the value.
  bool is_last_use(std::uint32_t value) { return !uses_.has_use_after(value, position_); }

  /// A register for a new value; another value may move to the scratch array.
  std::uint8_t acquire();
  /// The register of a value, which is no longer there.
  std::uint8_t take(std::uint32_t value);
  void release(std::uint8_t reg) { holds_[reg] = nothing; }
  /// The register now holds this value.
  void assign(std::uint8_t reg, std::uint32_t value);
  /// The value is in the scratch array.
  void assign_scratch(std::uint32_t index, std::uint32_t value) { value_[value].scratch = index; }
  /// Frees what holds a value without later uses.
  void drop_if_unused(std::uint32_t value);
  /// Stores what is needed later. After a call all registers are empty: the C library preserves none.
  void store_for_call();
  void empty_after_call();
  /// Stores the value in the scratch array if it is not there.
  void store(std::uint32_t value);

  std::uint32_t new_scratch();
  void free_scratch(std::uint32_t index) { free_.push_back(index); }
  std::uint32_t new_scratch_block(std::uint32_t size);
  std::uint32_t scratch_size() const { return scratch_size_; }

 private:
  static constexpr std::uint8_t none = 255;
  static constexpr std::uint32_t nothing = ~0u, reserved = ~0u - 1;
  static constexpr std::uint32_t nowhere = ~0u;
  struct Held {
    std::uint8_t reg = none;
    std::uint32_t scratch = nowhere;
  };

  UsePositions uses_;
  std::vector<Step>& steps_;
  std::vector<Held> value_;
  std::array<std::uint32_t, register_count> holds_{};  // value, nothing, or reserved
  std::vector<std::uint32_t> free_;
  std::uint32_t scratch_size_ = 0, position_ = 0;
};

}  // namespace eomgen::jit
