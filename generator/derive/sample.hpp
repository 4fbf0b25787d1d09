// SPDX-License-Identifier: GPL-3.0-or-later
// Values for symbols where numbers guide a search; what is found with them is proven or decided in many digits elsewhere.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::derive {

/// In (0.2, 1.2), by symbol and point; the same in every process.
inline double sample_value(const symbolic::Symbol& s, std::uint64_t point) {
  std::uint64_t x = point * 0x9e3779b97f4a7c15ull + (static_cast<std::uint64_t>(s.kind) << 40) + (std::uint64_t{s.order} << 32) + s.index;
  x = (x ^ (x >> 31)) * 0xbf58476d1ce4e5b9ull;
  return 0.2 + static_cast<double>((x ^ (x >> 29)) % 1000003) / 1000003;
}

}  // namespace eomgen::derive
