// SPDX-License-Identifier: GPL-3.0-or-later
// Names of values in emitted code.
#pragma once

#include <string>

#include "emit/expressions.hpp"
#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Expands a name pattern: "{3}_ddot" -> "phi_ddot".
std::string suggested_name(const std::string& pattern, const ModelNames& names);

/// A descriptive name of a sine or cosine: "sin_theta", "cos_theta1_minus_theta2"; empty if there is none.
std::string trig_name(const program::Function& function, const program::Instruction& instruction,
                      const Expressions& expressions);

/// The name of an entry of a result; empty if it has none.
std::string result_entry_name(const program::Function& function, const ModelNames& names, std::size_t result,
                              std::size_t entry);

}  // namespace eomgen::emit
