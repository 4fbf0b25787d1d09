// SPDX-License-Identifier: GPL-3.0-or-later
// The parameter that gives an expression its value, for messages that point at the number in place of its name.
#pragma once

#include <optional>

#include "model/model.hpp"

namespace eomgen::model {

/// The parameter that an expression consists of, also through definitions and other parameters; none for all others.
std::optional<std::uint32_t> lone_parameter(const Model& model, NodeId expression);

/// The same for a parameter along a fixed axis, also against it: -g*E2.
std::optional<std::uint32_t> parameter_along_axis(const Model& model, NodeId expression);

/// The place of the value of an expression: at that parameter; for all other expressions, at `span`.
Span origin_of(const Model& model, NodeId expression, const Span& span);

}  // namespace eomgen::model
