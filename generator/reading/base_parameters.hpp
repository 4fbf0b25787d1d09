// SPDX-License-Identifier: GPL-3.0-or-later
// Base parameters of mechanisms whose regressor is too long to be written out. The inertias that bodies share with
// their carriers are formulas. The rank of Y at random states decides whether these relations
// are all. The others, close to the ground, follow from written columns.
#pragma once

#include "reading/regressor.hpp"

namespace eomgen::reading {

/// `columns`: of Y on the Dag. `found` has the parameters, and the columns of Y that are written; the others are empty.
/// Adds the base parameters, or the reason why they are left out.
void find_carried_base(mechanics::Mechanics& mechanics, const std::vector<std::vector<symbolic::Ref>>& columns,
                       Regressor& found);

}  // namespace eomgen::reading
