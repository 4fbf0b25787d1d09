// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/xml.hpp"

#include <cstddef>

namespace eomgen::emit {
namespace {

/// The length of the UTF-8 sequence at the start of `text`, 0 if there is none.
std::size_t sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80                    ? 1
                             : first >= 0xc2 && first < 0xe0 ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  unsigned code = length == 1 ? first : first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fU);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool excluded = (code >= 0xd800 && code < 0xe000) || code == 0xfffe || code == 0xffff || code > 0x10ffff;
  return overlong || excluded ? 0 : length;
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence(text.substr(i));
    const char c = text[i];
    if (length > 1)
      result += text.substr(i, length);
    else if (length == 0)
      result += '?';
    else if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else if (c == '\n' || c == '\r' || c == '\t')
      result += ' ';
    else
      result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    i += length == 0 ? 1 : length;
  }
  return result;
}

std::string xml_element(const std::string& name, const XmlAttributes& attributes, bool open) {
  std::string result = "<" + name;
  for (const auto& [key, value] : attributes)
    if (!value.empty()) result += " " + key + "=\"" + xml_text(value) + "\"";
  return result + (open ? ">" : "/>");
}

}  // namespace eomgen::emit
