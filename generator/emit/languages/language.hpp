// SPDX-License-Identifier: GPL-3.0-or-later
// Straight-line code in languages outside the C family. Each target states its syntax as a Language; the statements are
// common.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "emit/straight_line.hpp"
#include "emit/text.hpp"

namespace eomgen::emit {

/// The functions `slides`, `normal_sign` and `side` of an entry of `mode` are part of each target's skeleton.
struct Language {
  Dialect dialect;      // numbers, conditional, element, function names
  std::string comment;  // begins a comment that ends with the line
  std::string (*declaration)(const std::string& name, const std::string& value) = nullptr;
  /// Ends the function with a code if the condition holds.
  std::string (*stop)(const std::string& condition, int code) = nullptr;
  std::string (*negation)(const std::string& condition) = nullptr;
  std::string end;         // the last statement of a function that succeeds
  std::string conversion;  // function that converts an argument to the precision of the code; empty: none
  /// Encloses results that a caller may omit; null: they are always computed.
  std::string (*if_wanted)(const std::string& result) = nullptr;
  std::string end_if;
  bool has_parts = false;                      // long functions are split
  std::span<const std::string_view> reserved;  // words that names must not be
  std::size_t longest_name = static_cast<std::size_t>(-1);
};

/// The statements of a function, without its head (FunctionText::body, or parts if the language has them). Only the
/// last part has the results.
FunctionText print_statements(const program::Function& function, const ModelNames& names,
                              const EmissionContext& context, const Language& language);

/// `text` as a literal between double quotes, in ASCII, with backslashes before quotes, backslashes and `also`.
std::string quoted(const std::string& text, const std::string& also = "");

/// Prints numbers of the code by `number`.
template <std::string (*number)(double)>
void set_numbers(Dialect& dialect, const char* pi) {
  dialect.constant = [](const symbolic::Rational& value) { return number(nearest_double(value)); };
  dialect.value = number;
  dialect.pi = pi;
}

/// A number as decimal, or one of the three words for the others.
std::string number_or(double value, const char* not_a_number, const char* infinity, const char* minus_infinity);

/// Roots and logarithms of negative numbers are not numbers, as in C: functions of the skeletons in languages whose own
/// are errors or complex.
const char* real_function(symbolic::Op op);

/// Throws Error if the function start is requested without a run.
void require_no_start(const EmissionContext& context, const std::string& target, const std::string& remedy);

/// Throws Error if the program has features that only targets in C have: Taylor series, second charts.
void require_plain(const program::Program& program, const std::string& target);

}  // namespace eomgen::emit
