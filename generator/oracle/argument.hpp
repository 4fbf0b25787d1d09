// SPDX-License-Identifier: GPL-3.0-or-later
// Arguments of a force in the model file, by key. The oracle has its own lookup: it is linked without the model stage.
#pragma once

#include <string_view>

#include "model/model.hpp"

namespace eomgen::verify {

/// The argument of a force; nullptr if it is not given.
const model::Argument* argument(const model::Force& force, std::string_view key);

/// The expression of an argument; no_node if it is not given.
model::NodeId argument_expression(const model::Force& force, std::string_view key);

}  // namespace eomgen::verify
