// SPDX-License-Identifier: GPL-3.0-or-later
// From a model to verified sources.
#pragma once

#include "emit/targets.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

struct EmissionRequest {
  std::string target = "cpp";  // of target_names() (archives.hpp)
  ApproachChoice approach = ApproachChoice::automatic;
  FormChoice form = std::nullopt;
  std::vector<std::string> with;     // of emitted_functions()
  std::vector<std::string> outputs;  // of the function `outputs`, in addition to those of "outputs" in `with`
  std::vector<std::string> fix;      // parameters that become constants
  std::uint64_t seed = 1;
  bool single = false;     // single precision
  int format_version = 0;  // of an archive (Archive::versions); 0: its default
};

/// The possible entries of `with`: functions other than rhs; "energy"; "outputs" of the default scene; "charts", second
/// charts; "run", all functions that a run calls; "start", the start for given parameters and initial values.
const std::vector<std::string>& emitted_functions();

/// Throws Error if the name is neither a target nor one of `beside`.
void require_target(const std::string& target, const std::vector<std::string>& beside = {});

struct Emission {
  std::vector<emit::EmittedFile> files;
  program::Program program;
  verify::Certificate certificate;
  std::optional<double> single_error = {};  // emit::EmissionContext::single_error
  Timings seconds;
};

/// Throws Error{stage "emit"} for an unknown target, function, output or parameter, and Error{ErrorKind::check} if the
/// derivations disagree. Warns (work::warn) if a requested item is empty.
Emission emit_model(std::shared_ptr<const model::Model> model, const EmissionRequest& request);

}  // namespace eomgen::pipeline
