// SPDX-License-Identifier: GPL-3.0-or-later
// Emitted C, compiled and loaded for `verify` and `run`.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_model.hpp"
#include "pipeline/pipeline.hpp"
#include "run/runner.hpp"

namespace eomgen::pipeline {

/// The description of a program's code, with null functions.
run::Code describe_code(const program::Program& program);

class CompiledCode {
 public:
  CompiledCode(emit::CompiledModel compiled, const program::Program& program);

  verify::CompiledForm form() const;
  run::Code code_for_run() const;
  const emit::CompiledModel& compiled() const { return compiled_; }

 private:
  emit::CompiledModel compiled_;
  run::Code described_;
  std::map<std::string, std::vector<std::size_t>> arrays_;  // sizes of the output arrays of each function
};

/// Emits C with `context` and compiles it (cached by content).
CompiledCode compile(const program::Program& program, const emit::EmissionContext& context, bool again = false);

/// The values that the emitted code uses for inputs that are not given.
std::vector<double> default_inputs(DerivedModel& derived);

/// The same without a certificate, for the verification that creates the certificate.
CompiledCode compile_for_verification(DerivedModel& derived, const program::Program& program);

}  // namespace eomgen::pipeline
