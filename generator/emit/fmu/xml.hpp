// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace eomgen::emit {

/// Text as the value of an attribute or as the content of an element of XML or HTML. Characters that XML cannot
/// contain, and invalid UTF-8, become '?'; line breaks and tabs become blanks.
std::string xml_text(std::string_view text);

}  // namespace eomgen::emit
