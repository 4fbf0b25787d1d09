// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_taylor and its helper functions, in C and as a template over the scalar type.
#pragma once

#include <string>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

struct TaylorText {
  std::string head;        // "int NAME_taylor(...)" without the body
  std::string definition;  // helpers and the function itself
};

/// Names for taylor_next, in which k replaces the time and x_k has the names of the state.
ModelNames taylor_next_names(const ModelNames& names);

/// Prints NAME_taylor. `prefix`: "NAME_", or "" for the template.
TaylorText print_taylor(const program::Program& program, const ModelNames& names, const EmissionContext& context,
                        const Dialect& dialect, const std::string& prefix);

}  // namespace eomgen::emit
