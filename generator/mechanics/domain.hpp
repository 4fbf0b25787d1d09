// SPDX-License-Identifier: GPL-3.0-or-later
// Operations of the model that have no value in any state: division by an expression that is identically 0, its
// logarithm, roots of negative numbers, constants above all doubles. In: the operation and its place in the source,
// which later stages do not know.
#pragma once

#include <cstdint>
#include <functional>

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// Throws Error{stage "mechanics"} at `place` if `divisor` is identically 0.
void require_nonzero_divisor(const Mechanics& mechanics, Ref divisor, const model::Span& place);

/// The same for the length of a vector that is normalised.
void require_nonzero_length(const Mechanics& mechanics, Ref length, const model::Span& place);

/// The value of a parameter of the model, by its index. Throws std::domain_error if it has none.
using ParameterValue = std::function<cln::cl_R(std::uint32_t)>;
/// Decimal digits of these values.
inline constexpr int parameter_digits = 40;

/// The same if `expression` is a function or a power without a value, a root of 0 that has no derivative, or above all
/// doubles for the parameters of the model.
void require_value(const Mechanics& mechanics, Ref expression, const model::Span& place,
                   const ParameterValue& parameter);

}  // namespace eomgen::mechanics
