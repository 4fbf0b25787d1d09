// SPDX-License-Identifier: GPL-3.0-or-later
// In: the steps of functions. Out: machine code in memory: for x86-64, with the calling convention of the System V ABI
// (encode.cpp), or WebAssembly, where the program is WebAssembly itself (wasm_encode.cpp). The memory is writable until
// the code is complete, and executable from then on, never both.
#pragma once

#include <cstddef>
#include <eom/modes/mode_array.hpp>
#include <memory>
#include <vector>

#include "jit/steps.hpp"

namespace eomgen::jit {

/// Why this build encodes no machine code; empty if it does.
const char* encoder_refusal();

/// A finished piece of memory with functions.
class ExecutableMemory {
 public:
  ExecutableMemory(const unsigned char* code, std::size_t size);
  ~ExecutableMemory();
  ExecutableMemory(const ExecutableMemory&) = delete;
  ExecutableMemory& operator=(const ExecutableMemory&) = delete;

  const void* at(std::size_t offset) const;
  std::size_t size() const { return size_; }

 private:
  void* start_ = nullptr;
  std::size_t size_ = 0;
};

/// A number of a function of the Encoder.
using FunctionNumber = std::size_t;

/// A case of a function that chooses by the charts of `mode`.
struct ChartCase {
  unsigned charts = 0;  // the set of second charts
  FunctionNumber function = 0;
  std::size_t prepared_offset = 0;  // added to the argument w
  bool without_prepared = false;    // the function has no argument w
};

class Encoder {
 public:
  Encoder();
  ~Encoder();
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// `constants` and `default_inputs` must outlive the code.
  FunctionNumber function(const FunctionSteps& steps, const double* constants, const double* default_inputs);
  /// Goes on in the function for the charts of `mode`; code 2 for other charts. `inputs`: of the function itself.
  /// `has_mode`: whether the functions of the cases have the argument `mode` too.
  FunctionNumber choice(const std::vector<abi::Input>& inputs, std::size_t results, const eom::ModeLayout& layout,
                        const std::vector<ChartCase>& cases, bool has_mode);
  /// Calls `driver` with the same arguments and `context` behind them. `results`: the number of result arrays.
  FunctionNumber with_context(const void* driver, const void* context, const std::vector<abi::Input>& inputs,
                              std::size_t results);

  struct Finished {
    std::unique_ptr<ExecutableMemory> memory;
    std::vector<const void*> entries;  // by number
  };
  Finished finish();

 private:
  struct Assembly;
  std::unique_ptr<Assembly> assembly_;
};

}  // namespace eomgen::jit
