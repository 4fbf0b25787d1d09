// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of a program, callable for `verify` and `run`: emitted C that is compiled and loaded, or machine code.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "emit/shared_library/loaded_model.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/tier.hpp"
#include "run/runner.hpp"

namespace eomgen::jit {
class MachineCode;
}

namespace eomgen::pipeline {

/// The description of a program's code, with null functions.
run::Code describe_code(const program::Program& program);

class CompiledCode {
 public:
  CompiledCode(emit::CompiledModel compiled, const program::Program& program);
  CompiledCode(jit::MachineCode code, double seconds, const program::Program& program);

  /// Holds references to the functions.
  verify::CompiledForm form() const;
  /// The functions and their description, as runs need them.
  const run::Code& code_for_run() const { return code_; }
  const abi::CompiledFunctions& functions() const { return *functions_; }
  Tier tier() const { return tier_; }
  double seconds() const { return seconds_; }  // of the compiler, or of the generation of machine code
  bool cached() const { return cached_; }      // the library was compiled earlier

 private:
  std::shared_ptr<const void> owner_;
  const abi::CompiledFunctions* functions_ = nullptr;
  Tier tier_ = Tier::compiled;
  double seconds_ = 0;
  bool cached_ = false;
  run::Code code_;
  std::map<std::string, std::vector<std::size_t>> arrays_;  // sizes of the output arrays of each function
};

/// Emits C with `context` and compiles it (cached by content).
CompiledCode compile(const program::Program& program, const emit::EmissionContext& context, bool again = false);

/// The same functions as machine code in memory; `context` may be a code_context. Throws Error{ErrorKind::tool} if they
/// fail the self test.
CompiledCode assemble(const program::Program& program, const emit::EmissionContext& context);

/// compile or assemble.
CompiledCode make_code(Tier tier, const program::Program& program, const emit::EmissionContext& context,
                       bool again = false);

/// The values that the emitted code uses for inputs that are not given.
std::vector<double> default_inputs(DerivedModel& derived);

/// The same without a certificate, for the verification that creates the certificate.
CompiledCode compile_for_verification(DerivedModel& derived, const program::Program& program);

}  // namespace eomgen::pipeline
