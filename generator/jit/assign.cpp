// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/assign.hpp"

#include <algorithm>
#include <map>

#include "jit/operations.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::jit {
namespace {

using program::Function;
using program::PivotTest;

class Assignment : Operations {
 public:
  Assignment(const Function& function, std::span<const double> default_inputs, std::size_t free_count,
             Constants& constants)
      : Operations(function, default_inputs, constants), free_count_(free_count) {}

  FunctionSteps run() {
    written().inputs = program::inputs_of(function().name);
    std::vector<std::vector<const PivotTest*>> tests(function().code.size() + 1);
    for (const PivotTest& test : function().pivots)
      tests[static_cast<std::size_t>(ready_after(test) + 1)].push_back(&test);
    test_pivots(tests[0]);
    for (std::uint32_t i = 0; i < function().code.size(); ++i) {
      registers().move_to(position_of(i));
      instruction(i);
      registers().move_to(position_of(i) + 1);
      test_pivots(tests[i + 1]);
    }
    registers().move_to(end());
    write_results();
    written().scratch_size = registers().scratch_size();
    return std::move(written());
  }

 private:
  void test_pivots(const std::vector<const PivotTest*>& tests) {
    for (const PivotTest* test : tests) test_pivot(*test);
    for (const PivotTest* test : tests) drop({test->pivot, test->scale});  // several may have the same scale
  }
  void test_pivot(const PivotTest& test) {
    const std::uint8_t pivot = registers().acquire();
    step(Action::load, pivot, location(test.pivot));
    if (test.scale.slot == Slot::constant && *constant_value(test.scale) == 0) {
      step(Action::compare, pivot, constant(0));
      step(Action::return_if_equal, 0, {}, 1);
    } else {
      const std::uint8_t least = registers().acquire();
      step(Action::load, least, location(test.scale));
      step(Action::absolute, least);
      step(Action::multiply, least, constant(program::pivot_tolerance));
      step(Action::absolute, pivot);
      step(Action::compare, least, {Place::register_, pivot});
      step(Action::return_if_above_or_equal, 0, {}, 1);
      registers().release(least);
    }
    registers().release(pivot);
  }

  // Results

  /// Entries that are arguments are copied first: a result array may be an argument array.
  void copy_arguments() {
    for (const program::Result& result : function().results) {
      if (result.is_test()) continue;
      for (const Operand& entry : result.entries) {
        if (!is_argument(entry) || copies_.contains({entry.slot, entry.index})) continue;
        const std::uint8_t reg = registers().acquire();
        const std::uint32_t place = registers().new_scratch();
        step(Action::load, reg, location(entry));
        step(Action::store, reg, {Place::scratch, place});
        registers().release(reg);
        copies_[{entry.slot, entry.index}] = place;
      }
    }
  }
  Location entry_location(const Operand& entry) {
    const auto found = copies_.find({entry.slot, entry.index});
    return found == copies_.end() ? location(entry) : Location{Place::scratch, found->second};
  }

  void write_results() {
    copy_arguments();
    std::uint32_t r = 0;  // among the arrays
    for (std::size_t k = 0; k < function().results.size(); ++k) {
      const program::Result& result = function().results[k];
      if (result.is_test()) {
        test_entries(result);
        continue;
      }
      written().may_be_null.push_back(program::may_be_null(function().name, k));
      step(Action::begin_result, 0, {}, r);
      for (std::uint32_t i = 0; i < result.entries.size(); ++i) {
        const std::uint32_t place = k > 0 || function().result_indices.empty() ? i : function().result_indices[i];
        write(result.entries[i], {Place::result, place});
      }
      step(Action::end_result, 0, {}, r++);
    }
    if (!program::is_right_hand_side(function())) return;
    const auto dx = std::find_if(function().results.begin(), function().results.end(),
                                 [](const program::Result& result) { return !result.is_test(); });
    written().finite_from = static_cast<std::uint32_t>(free_count_);
    written().finite_to = static_cast<std::uint32_t>(dx->entries.size());
  }
  void test_entries(const program::Result& result) {
    for (const Operand& entry : result.entries) {
      const std::uint8_t zero = registers().acquire(), value = copy(entry);
      step(Action::load, zero, constant(0));
      step(Action::compare, zero, {Place::register_, value});
      step(Action::return_if_above, 0, {}, static_cast<std::uint32_t>(result.code));
      registers().release(zero);
      registers().release(value);
    }
  }
  void write(const Operand& entry, Location to) {
    const Location from = entry_location(entry);
    if (from.place == Place::register_ && !entry.negated)
      return step(Action::store, static_cast<std::uint8_t>(from.index), to);
    const std::uint8_t reg = registers().acquire();
    step(Action::load, reg, from);
    if (entry.negated) step(Action::negate, reg);
    step(Action::store, reg, to);
    registers().release(reg);
  }

  std::size_t free_count_;
  std::map<std::pair<Slot, std::uint32_t>, std::uint32_t> copies_;
};

}  // namespace

FunctionSteps assign_registers(const Function& function, std::span<const double> default_inputs, std::size_t free_count,
                               Constants& constants) {
  return Assignment(function, default_inputs, free_count, constants).run();
}

}  // namespace eomgen::jit
