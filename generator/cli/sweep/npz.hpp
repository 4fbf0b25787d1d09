// SPDX-License-Identifier: GPL-3.0-or-later
// Table of a sweep as NumPy .npz: an archive with one array per column. Python reads it with numpy.load, R and Octave
// after unpacking. In: the rows. Out: run (int64), outcome (bytes), numbers (float64, NaN for an empty field), and the
// runs and texts of the rows that have a detail.
#pragma once

#include <string>

#include "cli/sweep/rows.hpp"

namespace eomgen::cli {

bool is_npz(const std::string& path);

/// Requires sorted `rows`. Keeps 64 MiB of columns in memory at a time and reads the rows once for each. Throws
/// std::system_error, or Error if `path` is not a regular file.
void write_npz(const std::string& path, const std::string& key, const std::string& header, const Rows& rows);

}  // namespace eomgen::cli
