// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of XML as text, without end tags: every attribute is escaped.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace eomgen::emit {

/// Text as the value of an attribute or as the content of an element of XML or HTML. Characters that XML cannot
/// contain, and invalid UTF-8, become '?'; line breaks and tabs become blanks.
std::string xml_text(std::string_view text);

using XmlAttributes = std::vector<std::pair<std::string, std::string>>;

/// "<name a="b"/>", or "<name a="b">" if `open`. Attributes with an empty value are left out.
std::string xml_element(const std::string& name, const XmlAttributes& attributes, bool open = false);

}  // namespace eomgen::emit
