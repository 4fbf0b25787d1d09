// SPDX-License-Identifier: GPL-3.0-or-later
// The steps between energies and Lagrange's equations, as (2.108), (2.110) have them. In: the energies of a
// ReadingForm. Out: per coordinate dT/dqdot, its rate, dT/dq, dU/dq and the generalised force, before anything is
// imposed that the energies do not have already.
#pragma once

#include "reading/reading.hpp"

namespace eomgen::reading {

struct Partials {
  std::uint32_t coordinate = 0;
  Sum momentum;               // dT/dqdot
  Sum rate;                   // d/dt of it
  Sum kinetic;                // dT/dq
  Sum potential;              // dU/dq
  Sum force;                  // Q
  std::string left_out = {};  // why nothing of this is here
};

/// One entry for each equation of `form`, in its order; none where it is shown by parts. Each has a budget of its own.
std::vector<Partials> partial_derivatives(const mechanics::Mechanics& mechanics, const ReadingForm& form);

}  // namespace eomgen::reading
