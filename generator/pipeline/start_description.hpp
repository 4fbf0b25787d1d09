// SPDX-License-Identifier: GPL-3.0-or-later
// In: a model and one of its scenes. Out: the formulas of the scene and the equations of its start as functions, for
// NAME_start of emitted code (emit/start/start.hpp). The rule is that of run::resolve_scene.
#pragma once

#include <memory>

#include "emit/start/start.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

/// Null if the model declares states of first order, or if the constraints are too many for a function that keeps its
/// matrices on the stack.
std::shared_ptr<const emit::StartDescription> describe_start(DerivedModel& derived, const model::Scene& scene);

}  // namespace eomgen::pipeline
