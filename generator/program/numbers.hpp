// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a program in binary64.
#pragma once

#include "symbolic/dag.hpp"

namespace eomgen::program {

/// The double nearest to an exact number.
double nearest_double(const symbolic::Rational& value);

}  // namespace eomgen::program
