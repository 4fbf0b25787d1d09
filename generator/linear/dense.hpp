// SPDX-License-Identifier: GPL-3.0-or-later
// Matrices and elimination under the names that this folder uses.
#pragma once

#include "linear/numbers.hpp"
#include "numeric/elimination.hpp"

namespace eomgen::linear {

using numeric::columns_of;
using numeric::Elimination;
using numeric::Matrix;
using numeric::rows_of;
using numeric::stacked;
using numeric::transposed;

}  // namespace eomgen::linear
