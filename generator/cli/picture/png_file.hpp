// SPDX-License-Identifier: GPL-3.0-or-later
// PNG encoder (ISO/IEC 15948) without libraries.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace eomgen::cli {

struct Picture {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // height x width x 3, row-major
};

/// Returns the bytes of the file. Uses the filter "up" and run-length matches only, which suits plots.
std::string encode_png(const Picture& picture);

}  // namespace eomgen::cli
