// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted C, compiled and loaded, as `verify` and `run` use it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_model.hpp"
#include "pipeline/pipeline.hpp"
#include "run/runner.hpp"

namespace eomgen::pipeline {

/// What a program says of its functions, which are null.
run::Code described_code(const program::Program& program);

class CompiledCode {
 public:
  CompiledCode(emit::Compiled compiled, const program::Program& program);

  verify::CompiledForm form() const;
  run::Code for_run() const;
  const emit::Compiled& compiled() const { return compiled_; }

 private:
  emit::Compiled compiled_;
  run::Code described_;
  std::map<std::string, std::vector<std::size_t>> arrays_;  // sizes of what each function writes
};

/// Emits C with `context` and compiles it (cached by content).
CompiledCode compile(const program::Program& program, const emit::EmissionContext& context, bool again = false);

/// What the emitted code takes for inputs that it is not given.
std::vector<double> default_inputs(Derived& derived);

/// The same without a certificate, which is being made from it.
CompiledCode compile_for_check(Derived& derived, const program::Program& program);

}  // namespace eomgen::pipeline
