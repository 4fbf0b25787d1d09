// SPDX-License-Identifier: GPL-3.0-or-later
// Products of x, |x| and sign(x) in one form. In: a sum. Out: the same sum away from x = 0.
#pragma once

#include "reading/sum.hpp"

namespace eomgen::reading {

/// x^2/|x| -> |x|, x/|x| -> sign(x), |x| sign(x) -> x, sign(x)^2 -> 1, for every x that is one factor, such as sin(q).
Sum reduce_signs(const Sum& sum);

}  // namespace eomgen::reading
