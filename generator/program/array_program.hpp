// SPDX-License-Identifier: GPL-3.0-or-later
// A function as straight-line code for scalars, followed by loops over arrays (system/array_loops.hpp). C and C++ print
// it in place of the straight-line code of the whole function; all others use that.
#pragma once

#include "program/abi_functions.hpp"
#include "program/program.hpp"
#include "system/array_loops.hpp"

namespace eomgen::program {

enum class ArraySpace : std::uint8_t { scalars, work, result };

/// Copies entries from one array to another. Each has its own distances between entries, and between groups of `count`
/// entries.
struct ArrayRun {
  ArraySpace from_space, to_space;
  std::size_t from, from_step, to, to_step, count;
  std::size_t from_group = 0, to_group = 0, groups = 1;
};

/// For k = 0, .., count - 1: work[outputs[i] + k] is the entry i of the first result of `body`. Its argument v has
/// first work[inputs[j] + k], then scalars[j].
struct ProgramLoop {
  std::size_t count = 0;
  std::vector<std::size_t> inputs, scalars, outputs;
  Function body;
};

struct ProgramStep {
  std::vector<ArrayRun> before;
  std::optional<ProgramLoop> loop;
  std::vector<ArrayRun> after;
};

struct ArrayProgram {
  Function scalars;
  std::size_t work = 0;       // entries of the working memory, which is 0 at first
  bool fills_result = false;  // false: entries that nothing writes are 0
  std::vector<ProgramStep> steps;
  Operations loop_operations;  // of all passes
  std::size_t copies = 0;      // entries

  std::size_t flops() const { return scalars.operations.flops() + loop_operations.flops(); }
  /// The cost of straight-line code that takes as long. Operations in loops take a tenth of the time, because
  /// processors make several passes at once; a copy takes that of two operations.
  std::size_t cost() const { return scalars.operations.cost() + loop_operations.cost() / 10 + 2 * copies; }
};

/// df/dx of n coordinates and their rates, without other states. `complete` adds pivots and labels to the scalars.
ArrayProgram array_program(symbolic::Dag& dag, const system::AccelerationSlopes& slopes, std::size_t n,
                           const std::function<void(FunctionExpressions&)>& complete, const MakeFunction& make);

}  // namespace eomgen::program
