// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of functions of the motion that depend on one another for every motion. Functions of coordinates count as
// independent unless identities of sines and cosines relate them.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "reading/sum.hpp"

namespace eomgen::reading {

/// Column to entry, without zeros.
using ColumnEntries = std::map<std::size_t, Sum>;

/// The reduced row echelon form by pivot: column k is the sum of entry k of pivot b times column b.
using Echelon = std::map<std::size_t, ColumnEntries>;

/// `columns`: equally many entries each. With `of_motion` terms without coordinates, rates and vectors count as 0.
Echelon relate_columns(const std::vector<std::vector<Sum>>& columns, bool of_motion = false);

}  // namespace eomgen::reading
