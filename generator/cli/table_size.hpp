// SPDX-License-Identifier: GPL-3.0-or-later
// How large a table will be, before it is written.
#pragma once

#include <cstddef>
#include <string>

namespace eomgen::cli {

/// Rows from t0 to t1 every `every` seconds, with both ends.
double expected_rows(double t0, double t1, double every);

/// Tells what more than a million rows will take. Throws Error where it is more than anybody asks for by intent, unless
/// `yes`, and where `every` is lost in the rounding of t. `columns`: beside t; 0 where nothing goes to a file.
void require_size(double t0, double t1, double every, std::size_t columns, bool yes);

}  // namespace eomgen::cli
