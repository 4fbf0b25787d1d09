// SPDX-License-Identifier: GPL-3.0-or-later
// The intermediate steps between energies and Lagrange's equations, as in (2.108), (2.110). In: the energies of a
// DisplayForm. Out: per coordinate dT/dqdot, its rate, dT/dq, dU/dq and the generalised force. Constraints are imposed
// only as far as in the energies.
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

struct PartialDerivatives {
  std::uint32_t coordinate = 0;
  Sum momentum;               // dT/dqdot
  Sum rate;                   // d/dt of it
  Sum kinetic;                // dT/dq
  Sum potential;              // dU/dq
  Sum force;                  // Q
  std::string left_out = {};  // why the members above are empty
};

/// One entry for each equation of `form`, in its order; none if is_unexpanded. Each has its own budget.
std::vector<PartialDerivatives> partial_derivatives(const mechanics::Mechanics& mechanics, const DisplayForm& form);

}  // namespace eomgen::reading
