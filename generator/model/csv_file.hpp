// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of numbers in a CSV file beside a model file. The file is untrusted: its rows are bounded, and its bytes
// where it is read (data_file.hpp). In: the text, names of columns. Out: numbers; every error has the file, line and
// column.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "error.hpp"

namespace eomgen::model {

/// Largest CSV file in bytes, and most rows of numbers.
inline constexpr std::size_t max_csv_bytes = std::size_t{1} << 24;
inline constexpr std::size_t max_csv_rows = 100000;

/// Two columns of a CSV file. The first one increases.
struct CsvColumns {
  std::vector<double> first, second;
  std::string content_hash;  // of the bytes of the file
};

/// Columns by their names in the header, the first line that is neither blank nor begins with #. Values are separated
/// by commas, semicolons or tabs. Throws Error with a place in `file` for missing columns, rows of another length,
/// fields that are not finite numbers, values of the first column that do not increase, and more rows than allowed.
CsvColumns read_csv(const std::string& file, const std::string& text, const std::array<std::string, 2>& names);

}  // namespace eomgen::model
