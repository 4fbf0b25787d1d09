// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/row_checksum.hpp"

#include <fmt/format.h>

#include "emit/fmu/zip.hpp"

namespace eomgen::cli {

RowChecksum::RowChecksum(std::string_view header) : of_columns_(emit::crc32(header)) {}

std::string RowChecksum::append_to(std::string_view row) const {
  return fmt::format("{},{:08x}", row, emit::crc32(row, of_columns_));
}

bool RowChecksum::holds(std::string_view line) const {
  const std::size_t comma = line.rfind(',');
  return comma != std::string_view::npos && append_to(line.substr(0, comma)) == line;
}

}  // namespace eomgen::cli
