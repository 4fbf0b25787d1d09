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
                .type = ValueType::choice,
                .optional = true,
                .choices = {{"0", ""}, {"2", "acts on what a [[body]] has of inertia"}}},
               {.name = "center", .type = ValueType::point, .optional = true, .default_value = "origin"}},
      .terms = {{.formula = "-(GM*m/norm(r - center))", .domain = Domain::masses},
                {.formula = "GM*(3*dJd/norm(d)^2 - trJ)/(2*norm(d)^3)",
                 .conditions = {{Predicate::chosen, "order", "2"}},
                 .domain = Domain::bodies,
                 .arm = "r - center"}},
  };
}

}  // namespace eomgen::forces
