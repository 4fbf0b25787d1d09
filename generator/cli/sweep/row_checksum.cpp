// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/row_checksum.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace eomgen::cli {
namespace {

std::uint32_t checksum(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

RowChecksum::RowChecksum(std::string_view header) : of_columns_(checksum(header, 0)) {}

std::string RowChecksum::append_to(std::string_view row) const {
  return fmt::format("{},{:08x}", row, checksum(row, of_columns_));
}

bool RowChecksum::holds(std::string_view line) const {
  const std::size_t comma = line.rfind(',');
  return comma != std::string_view::npos && append_to(line.substr(0, comma)) == line;
}

}  // namespace eomgen::cli
