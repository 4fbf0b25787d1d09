// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

// Order 2 adds the term of the inertia of bodies, eq. (7.71).
Kind central_gravity() {
  return {
      .name = "central_gravity",
      .title = "Newton's attraction by a centre",
      .keys = {{.name = "GM", .unit = "m^3/s^2"},
               {.name = "order",
                .asks = Asks::choice,
                .optional = true,
                .choices = {{"0", ""}, {"2", "acts on what a [[body]] has of inertia"}}},
               {.name = "center", .asks = Asks::point, .optional = true, .fallback = "origin"}},
      .terms = {{.formula = "-(GM*m/norm(r - center))", .over = Over::masses},
                {.formula = "GM*(3*dJd/norm(d)^2 - trJ)/(2*norm(d)^3)",
                 .when = {{Is::chosen, "order", "2"}},
                 .over = Over::bodies,
                 .arm = "r - center"}},
  };
}

}  // namespace eomgen::forces
