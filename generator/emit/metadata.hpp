// SPDX-License-Identifier: GPL-3.0-or-later
// What every target of the C family says beside the functions: banner, JSON, defaults.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Lines of the banner, fit for any comment.
std::vector<std::string> banner_lines(const program::Program& program, const EmissionContext& context);
/// The same as one comment, `first` before the first line, `next` before the others, `last` at the end.
std::string banner(const program::Program& program, const EmissionContext& context, const std::string& first,
                   const std::string& next, const std::string& last);

/// NAME_info, as JSON (docs/abi.md).
std::string info_json(const program::Program& program, const EmissionContext& context);

/// Body of NAME_defaults.
std::string defaults_body(const program::Program& program, const EmissionContext& context, const Dialect& dialect);

/// What a function of the ABI does, in a sentence.
std::string purpose(const std::string& function);

/// A skeleton of templates/, filled in. Nothing is escaped: values are code.
std::string rendered(const std::string& skeleton, const std::vector<std::pair<std::string, std::string>>& values,
                     const std::vector<std::vector<std::pair<std::string, std::string>>>& functions);

/// Throws Error where names and numbers in `context` do not match the program.
void require_consistent(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
