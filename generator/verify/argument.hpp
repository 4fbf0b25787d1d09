// SPDX-License-Identifier: GPL-3.0-or-later
// What the author of a force wrote, by key. The judge is linked without the model stage and looks it up on its own.
#pragma once

#include <string_view>

#include "model/model.hpp"

namespace eomgen::verify {

/// The argument of a force; nullptr where it is not given.
const model::Argument* argument(const model::Force& force, std::string_view key);

/// The expression of an argument; no_node where it is not given.
model::NodeId given(const model::Force& force, std::string_view key);

}  // namespace eomgen::verify
