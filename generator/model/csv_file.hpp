// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of numbers in a CSV file beside a model file. Both are untrusted: the path stays in the model's folder, and
// bytes and rows are bounded.
// In: folder, path, names of columns. Out: numbers; every error has the file, line and column.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
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

/// Reports an error in the model file: what is wrong with its path, and what to do.
using RefusePath = std::function<void(const std::string& what, const std::string& remedy)>;

/// The bytes of a file that a model names. `refuse` throws if the path is absolute, leaves the folder, or names no
/// regular file of at most `most` bytes.
std::string read_data_file(const std::string& folder, const std::string& path, std::size_t most,
                           const RefusePath& refuse);

/// Columns by their names in the header, the first line that is neither blank nor begins with #. Values are separated
/// by commas, semicolons or tabs. Throws Error with a place in `file` for missing columns, rows of another length,
/// fields that are not finite numbers, values of the first column that do not increase, and more rows than allowed.
CsvColumns read_csv(const std::string& file, const std::string& text, const std::array<std::string, 2>& names);

}  // namespace eomgen::model
