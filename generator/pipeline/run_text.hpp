// SPDX-License-Identifier: GPL-3.0-or-later
// The data in emitted code with which a program without the generator runs the model as `run` does.
#pragma once

#include <memory>

#include "emit/context.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

/// The default scene in numbers, and the description of the functions of `program`, for NAME_run.hpp. Throws
/// Error{stage "emit"} if the run needs expressions that emitted code does not have.
std::shared_ptr<const emit::RunDescription> run_text(const DerivedModel& derived, const run::Scene& scene,
                                                     const program::Program& program);

}  // namespace eomgen::pipeline
