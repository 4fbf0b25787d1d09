// SPDX-License-Identifier: GPL-3.0-or-later
// Texts from outside as UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace eomgen {

/// The length of the UTF-8 sequence at the start of a text; 0 if there is none (overlong forms, surrogates).
std::size_t utf8_length(std::string_view text);

/// The text with a '?' in place of each byte that belongs to no sequence.
std::string valid_utf8(std::string_view text);

}  // namespace eomgen
