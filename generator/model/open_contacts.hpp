// SPDX-License-Identifier: GPL-3.0-or-later
// The model of a mode in which every unilateral constraint is open: without these constraints, their forces are 0.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::model {

/// The model without its unilateral constraints. Expressions that name their forces contain 0. Outputs of scenes remain
/// as they are, also those that no longer exist. The copy has no content hash, as it is no file.
std::shared_ptr<const Model> without_unilateral_constraints(const Model& model);

}  // namespace eomgen::model
