// SPDX-License-Identifier: GPL-3.0-or-later
// Scalar products of vectors along orthonormal axes.
#pragma once

#include "reading/reading.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {

inline Sum dot(const Components& a, const Components& b) { return simplify(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); }

}  // namespace eomgen::reading
