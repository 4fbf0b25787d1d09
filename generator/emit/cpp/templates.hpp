// SPDX-License-Identifier: GPL-3.0-or-later
// Functions as templates over the scalar type: what the targets cpp and cuda share.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"
#include "program/taylor.hpp"

namespace eomgen::emit {

inline const std::string template_kernels = "eom_";  // prefix of sines and cosines that are computed together

Dialect template_dialect();

/// Named indices into the arrays: x[State::theta].
std::string index_names(const ModelNames& names, std::size_t prepared, const std::optional<program::Taylor>& taylor);

struct TemplateFunctions {
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;  // purpose, head, body of each
  bool packs = false;                                                       // some need the kernel
};
/// `mark`: before the type of what they return.
TemplateFunctions template_functions(const program::Program& program, const ModelNames& names,
                                     const EmissionContext& context, const Dialect& dialect, const std::string& mark);

}  // namespace eomgen::emit
