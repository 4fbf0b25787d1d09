// SPDX-License-Identifier: GPL-3.0-or-later
// Rules for names, and suggestions for misspelt names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/expression.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_name_length = 64;

/// [A-Za-z][A-Za-z0-9_]*
bool is_identifier(std::string_view text);
/// t, pi, origin, ground, E1..E3 and the names of functions.
bool is_reserved(std::string_view name);
/// The reason why a name cannot be declared; nothing if it can.
std::optional<std::string> name_error(std::string_view name);

/// "theta_ddot" -> {"theta", 2}; {"theta", 0} for other names.
struct Derivative {
  std::string_view base;
  std::uint8_t order = 0;
};
Derivative split_derivative(std::string_view name);

/// The number of insertions, deletions, substitutions and transpositions of neighbours between two names; at most
/// `limit` + 1.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit);
/// The candidate nearest to `name`, if it is near enough to be a misspelling.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& candidates);
/// "did you mean 'x'?" or nothing.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);
/// The same, followed by "choose from: ...".
std::string suggest_choice(const std::string& name, const std::vector<std::string>& known);
/// Whether two names, one edit apart, look like one name misspelt (theta1 and theta2, x and y do not).
bool looks_misspelt(std::string_view name, std::string_view known);

/// Untrusted text in quotes, for a message: shortened, with control characters replaced.
std::string quote(std::string_view text);

/// A scalar function of the language with its minimum and maximum number of arguments (SIZE_MAX: unlimited).
struct FunctionSignature {
  std::string_view name;
  Fn fn;
  std::size_t min_arguments, max_arguments;
};
const FunctionSignature* find_function(std::string_view name);
/// The names of all functions, including ddt, dot, position, ...
const std::vector<std::string>& function_names();

/// The reason why a LaTeX string is rejected; nothing if it is harmless and valid.
std::optional<std::string> tex_error(std::string_view tex);
/// Whether it requires the package amssymb.
bool needs_amssymb(std::string_view tex);

}  // namespace eomgen::model
