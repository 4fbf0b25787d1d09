// SPDX-License-Identifier: GPL-3.0-or-later
// Operations of the model that have no value in any state: division by what is 0 everywhere, the logarithm of it, roots
// of negative numbers. In: the operation and its place, which stages after this one do not know.
#pragma once

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// Throws Error {stage "mechanics"} at `place` where `divisor` is 0 whatever the state and the time.
void require_divisor(const Mechanics& mechanics, Ref divisor, const model::Span& place);

/// The same of the length of a vector whose direction is asked for.
void require_direction(const Mechanics& mechanics, Ref length, const model::Span& place);

/// The same where `expression` is a function or a power without a value, or a root of 0 that has no derivative.
void require_value(const Mechanics& mechanics, Ref expression, const model::Span& place);

}  // namespace eomgen::mechanics
