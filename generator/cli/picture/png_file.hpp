// SPDX-License-Identifier: GPL-3.0-or-later
// A PNG file of a picture in memory (ISO/IEC 15948), without libraries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eomgen::cli {

struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // by rows, 3 bytes each
};

/// The bytes of the file. Rows are differences to the row above and runs are packed, which suits plots.
std::string png(const Picture& picture);

}  // namespace eomgen::cli
