// SPDX-License-Identifier: GPL-3.0-or-later
// All that says the same of a model, held against one another: what `verify` does.
#pragma once

#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

struct VerificationRequest {
  int digits = 50;          // decimal, of the arithmetic; 20 to 300
  std::size_t points = 20;  // random states
  std::uint64_t seed = 1;
  bool compile = true;  // the emitted code too, which needs a C compiler
};

/// Every route, reading form, reduction and form, every function of the optimised program and of the compiled code.
/// Where constraints fix the whole motion: the routes and the reading forms. Where it is interrupted it says so and
/// gives what it has.
verify::Certificate verify_model(std::shared_ptr<const model::Model> model, const VerificationRequest& request);

}  // namespace eomgen::pipeline
