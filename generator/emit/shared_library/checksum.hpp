// SPDX-License-Identifier: GPL-3.0-or-later
// Names for contents.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace eomgen::emit {

/// Two FNV-1a sums from different starts as 32 hexadecimal digits: against accidents, not against attackers (the cache
/// is the user's own).
inline std::string checksum(std::string_view text) {
  std::string result;
  for (std::uint64_t hash : {14695981039346656037ull, 0x6c62272e07bb0142ull}) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    hash ^= hash >> 29;
    for (int shift = 60; shift >= 0; shift -= 4) result += "0123456789abcdef"[(hash >> shift) & 15u];
  }
  return result;
}

}  // namespace eomgen::emit
