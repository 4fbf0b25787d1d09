// SPDX-License-Identifier: GPL-3.0-or-later
// From a model to verified sources.
#pragma once

#include "emit/targets.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

struct EmissionRequest {
  std::string target = "cpp";  // of emit::targets()
  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  std::vector<std::string> with;     // of emitted_functions()
  std::vector<std::string> outputs;  // of the function outputs, beside what "outputs" in `with` brings
  std::vector<std::string> fix;      // parameters that become numbers
  std::uint64_t seed = 1;
  bool single = false;  // single precision
};

/// What `with` may hold: functions beside rhs; "energy"; "outputs", those of the default scene; "charts", second ones;
/// "run", all that a run calls.
const std::vector<std::string>& emitted_functions();

/// Throws Error where it is neither one of the targets nor one of those `beside` them.
void require_target(const std::string& target, const std::vector<std::string>& beside = {});

struct Emission {
  std::vector<emit::EmittedFile> files;
  program::Program program;
  verify::Certificate certificate;
  std::optional<double> single_error = {};  // emit::EmissionContext::single_error
  Timings seconds;
};

/// Throws Error{stage "emit"}: an unknown target, function, output or parameter; Error{Fault::check} where the
/// derivations disagree. Warns (work::warn) of what was asked for and is empty.
Emission emit_model(std::shared_ptr<const model::Model> model, const EmissionRequest& request);

}  // namespace eomgen::pipeline
