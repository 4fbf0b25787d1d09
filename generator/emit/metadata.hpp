// SPDX-License-Identifier: GPL-3.0-or-later
// Metadata for every target of the C family: banner, JSON, defaults.
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Lines of the banner, safe in any comment.
std::vector<std::string> banner_lines(const program::Program& program, const EmissionContext& context);
/// The banner as one comment: `first` precedes the first line, `next` the others, `last` ends the comment.
std::string banner(const program::Program& program, const EmissionContext& context, const std::string& first,
                   const std::string& next, const std::string& last);

/// NAME_info, as JSON (docs/abi.md).
std::string info_json(const program::Program& program, const EmissionContext& context);

/// Body of NAME_defaults.
std::string defaults_body(const program::Program& program, const EmissionContext& context, const Dialect& dialect);

/// The purpose of a function of the ABI, as a sentence.
std::string function_purpose(const std::string& function);

/// The default values of parameters or inputs.
std::vector<double> values_of(const std::vector<Quantity>& quantities);

/// Fills in a skeleton of templates/. Values are code and are not escaped.
std::string render_template(const std::string& skeleton, const std::vector<std::pair<std::string, std::string>>& values,
                            const std::vector<std::vector<std::pair<std::string, std::string>>>& functions);

/// Throws Error if names and numbers in `context` do not match the program.
void require_consistent(const program::Program& program, const EmissionContext& context);

}  // namespace eomgen::emit
