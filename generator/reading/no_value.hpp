// SPDX-License-Identifier: GPL-3.0-or-later
// The error that this stage throws in place of std::domain_error, when GiNaC or a Sum meets an expression without a
// value. Operations in the model's own text are rejected earlier, with their place (mechanics/domain.hpp).
#pragma once

#include "error.hpp"
#include "mechanics/mechanics.hpp"

namespace eomgen::reading {

inline Error no_value_error(const mechanics::Mechanics& mechanics) {
  return Error("reading", SourceLocation{mechanics.model->file, 0, 0, 1, ""},
               "an expression of this model has no value, at every state and time: a division by 0, a logarithm "
               "of 0, a tangent at its pole, the root of a negative number",
               "check the denominators and the arguments of functions");
}

}  // namespace eomgen::reading
