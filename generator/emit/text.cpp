// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <eom/output/decimal.hpp>

namespace eomgen::emit {

std::string comment_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const char previous = result.empty() ? ' ' : result.back();
    if (byte < 0x20 || byte >= 0x7f || c == '\\') {
      result += '?';
      if (previous == '?') result.back() = '.';  // breaks trigraphs
    } else if ((c == '/' && previous == '*') || (c == '*' && previous == '/') || (c == '/' && previous == '/')) {
      result += ' ';
      result += c;
    } else if (c == '?' && previous == '?') {
      result += '.';
    } else {
      result += c;
    }
  }
  // The following text must not complete the end of a comment.
  if (!result.empty() && (result.back() == '*' || result.back() == '/')) result += ' ';
  return result;
}

std::string string_literal(const std::string& text, const std::string& indent) {
  constexpr std::size_t line_length = 96;
  std::string result = "\"";
  std::size_t length = 0;
  for (const char c : text) {
    if (length >= line_length) {
      result += "\"\n" + indent + "\"";
      length = 0;
    }
    const auto byte = static_cast<unsigned char>(c);
    std::string piece(1, c);
    if (c == '"' || c == '\\' || c == '?')
      piece = std::string("\\") + c;
    else if (byte < 0x20 || byte >= 0x7f)
      piece = fmt::format("\\{:03o}", byte);
    result += piece;
    length += piece.size();
  }
  return result + "\"";
}

std::string decimal(double value) {
  if (std::isnan(value)) return "(0.0/0.0)";
  if (std::isinf(value)) return value > 0 ? "HUGE_VAL" : "(-HUGE_VAL)";
  char buffer[64];
  const auto end = eom::decimals::write_shortest(buffer, buffer + sizeof buffer, value);
  std::string result(buffer, end);
  if (result.find_first_of(".e") == std::string::npos) result += ".0";
  return result;
}

std::string wrapped(const std::string& line, const std::string& indent, std::size_t width) {
  std::string result, rest = line;
  while (rest.size() > width) {
    const std::size_t blank = rest.rfind(' ', width);
    const std::size_t first = rest.find_first_not_of(' ');
    if (blank == std::string::npos || blank <= first) break;
    const bool in_comment = rest.find("//") < blank;
    if (in_comment && rest.rfind("// ", blank) + 2 == blank) break;  // one word, longer than a line
    result += rest.substr(0, blank) + "\n";
    rest = indent + (in_comment ? "// " : "") + rest.substr(blank + 1);
  }
  return result + rest;
}

}  // namespace eomgen::emit
