// SPDX-License-Identifier: GPL-3.0-or-later
// Escaping of text for its context, and formatting of numbers.
#pragma once

#include <string>

#include "program/numbers.hpp"

namespace eomgen::emit {

/// Text that is safe inside a /* comment */ or a // line: printable ASCII without comment ends, trigraphs and
/// backslashes.
std::string comment_text(const std::string& text);

/// A C string literal with quotes; long literals are split over lines.
std::string string_literal(const std::string& text, const std::string& indent);

/// The shortest decimal that reads back as this number, with a decimal point or exponent: "9.81", "1e-07", "3.0".
std::string decimal(double value);

using program::nearest_double;

/// The text of each entry, with separators between them.
template <class List, class Text>
std::string joined(const List& list, Text&& text, const char* separator = ", ") {
  std::string result;
  for (const auto& entry : list) {
    if (!result.empty()) result += separator;
    result += text(entry);
  }
  return result;
}

/// Wraps at blanks to lines of at most `width` characters; continuation lines are indented by `indent`. A comment that
/// begins with // stays one on every line.
std::string wrapped(const std::string& line, const std::string& indent, std::size_t width = 110);

}  // namespace eomgen::emit
