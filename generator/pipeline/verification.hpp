// SPDX-License-Identifier: GPL-3.0-or-later
// The command `verify`: compares all equivalent descriptions of a model with one another.
#pragma once

#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

struct VerificationRequest {
  int digits = 50;          // decimal digits of the arithmetic; 20 to 300
  std::size_t points = 20;  // random states
  std::uint64_t seed = 1;
  bool compile = true;  // also verify the emitted code, which needs a C compiler
};

/// Verifies every formulation, display form, reduction and form, and every function of the optimised program and of the
/// compiled code. For a model without degrees of freedom: the formulations and the display forms. After an interruption
/// the certificate is marked and has the results so far.
verify::Certificate verify_model(std::shared_ptr<const model::Model> model, const VerificationRequest& request);

}  // namespace eomgen::pipeline
