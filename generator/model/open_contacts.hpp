// SPDX-License-Identifier: GPL-3.0-or-later
// The model of a mode in which unilateral constraints are open: without these constraints, their forces are 0.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::model {

/// The model without the unilateral constraints named in `open`. Expressions that name their forces contain 0. Outputs
/// of scenes remain as they are, also those that no longer exist. The copy has no content hash, as it is no file.
std::shared_ptr<const Model> without_open_contacts(const Model& model, const std::vector<std::string>& open);

}  // namespace eomgen::model
