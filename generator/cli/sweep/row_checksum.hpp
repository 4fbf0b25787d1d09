// SPDX-License-Identifier: GPL-3.0-or-later
// Checksums of the rows of a sweep's table. In: the columns and a row. Out: the row with a CRC-32 as its last field,
// which shows whether the row or the columns were changed. It does not depend on the sweep, so that equal rows of
// different sweeps have equal bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace eomgen::cli {

/// Name of the last column.
inline constexpr const char* checksum_column = "checksum";

class RowChecksum {
 public:
  RowChecksum() = default;
  /// `header`: the line of the columns.
  explicit RowChecksum(std::string_view header);

  /// Returns the row with its checksum.
  std::string append_to(std::string_view row) const;
  /// Whether the last field of a line is the checksum of what is before it.
  bool holds(std::string_view line) const;

 private:
  std::uint32_t of_columns_ = 0;
};

}  // namespace eomgen::cli
