// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a sweep as NumPy's .npz: an archive of one array for each column, which Python reads with numpy.load and
// R and Octave after unpacking. In: the rows. Out: run (int64), outcome (bytes), numbers (float64, no number where a
// field is empty), and of rows that have a detail their run and what it says.
#pragma once

#include <string>

#include "cli/sweep/rows.hpp"

namespace eomgen::cli {

bool is_npz(const std::string& path);

/// `rows` in order. Memory holds some thousand rows at a time. Throws std::system_error; Error where `path` is no
/// regular file.
void write_npz(const std::string& path, const std::string& key, const std::string& header, const Rows& rows);

}  // namespace eomgen::cli
