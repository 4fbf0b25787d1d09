// SPDX-License-Identifier: GPL-3.0-or-later
// What values are called in emitted code.
#pragma once

#include <string>

#include "emit/expressions.hpp"
#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// "{3}_ddot" -> "phi_ddot".
std::string suggested_name(const std::string& pattern, const ModelNames& names);

/// A name that says what a sine or cosine is of: "sin_theta", "cos_theta1_minus_theta2"; empty where there is none.
std::string trig_name(const program::Function& function, const program::Instruction& instruction,
                      const Expressions& expressions);

/// What an entry of a result is; empty where nobody gave it a name.
std::string name_of_entry(const program::Function& function, const ModelNames& names, std::size_t result,
                          std::size_t entry);

}  // namespace eomgen::emit
