// SPDX-License-Identifier: GPL-3.0-or-later
// Size of a table before it is written.
#pragma once

#include <cstddef>

namespace eomgen::cli {

/// Prints the expected size of tables with more than a million rows. Throws Error if the table is unreasonably large,
/// unless `yes`, and if t + `every` rounds to t. `columns`: without t; 0 if nothing is written to a file.
void require_size(double t0, double t1, double every, std::size_t columns, bool yes);

}  // namespace eomgen::cli
