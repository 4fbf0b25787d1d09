// SPDX-License-Identifier: GPL-3.0-or-later
// The parameter that gives an expression its value, for messages that point at the number in place of its name.
#pragma once

#include <optional>

#include "model/model.hpp"

namespace eomgen::model {

/// The parameter that an expression consists of, also through definitions and other parameters; none for all others.
std::optional<std::uint32_t> lone_parameter(const Model& model, NodeId expression);

/// Where the value of an expression stands: at that parameter, at `span` of all other expressions.
Span origin_of(const Model& model, NodeId expression, const Span& span);

}  // namespace eomgen::model
