// SPDX-License-Identifier: GPL-3.0-or-later
// Letters and digits of names and numbers in a model file.
#pragma once

#include <cctype>

namespace eomgen::model {

inline bool letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
inline bool digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace eomgen::model
