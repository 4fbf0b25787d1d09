// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/xml.hpp"

#include "utf8.hpp"

namespace eomgen::emit {

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : valid_utf8(text)) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      case '\n':
      case '\r':
      case '\t': result += ' '; break;
      default: result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  // XML 1.0, section 2.2: U+FFFE and U+FFFF are no characters.
  for (const std::string_view excluded : {"\xef\xbf\xbe", "\xef\xbf\xbf"}) {
    for (std::size_t at = result.find(excluded); at != std::string::npos; at = result.find(excluded, at))
      result.replace(at, excluded.size(), "?");
  }
  return result;
}

}  // namespace eomgen::emit
