// SPDX-License-Identifier: GPL-3.0-or-later
// Functions as templates over the scalar type, shared by the targets cpp and cuda.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

inline const std::string template_kernel_prefix = "eom_";  // prefix of grouped sines and cosines

Dialect template_dialect();

/// Enumerations of array indices: x[State::theta].
std::string index_names(const ModelNames& names, const program::Program& program);

struct TemplateFunctions {
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;  // purpose, head and body of each
  bool packs = false;                                                       // whether some need the sincos kernel
};
/// `mark`: text before the return type.
TemplateFunctions template_functions(const program::Program& program, const ModelNames& names,
                                     const EmissionContext& context, const Dialect& dialect, const std::string& mark);

}  // namespace eomgen::emit
