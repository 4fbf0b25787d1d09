// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

// For free length 0, (norm(a - b))^2 is written without the square root, so that it has no singular point.
Kind spring() {
  return {
      .name = "spring",
      .title = "a potential energy of the distance of two points",
      .keys = {{.name = "between", .asks = Asks::ends, .on = On::motion},
               {.name = "length", .unit = "m", .optional = true, .fallback = "0"},
               {.name = "stiffness", .unit = "N/m", .unless = "energy"},
               {.name = "energy",
                .asks = Asks::energy,
                .unit = "J",
                .optional = true,
                .remedy = "the energy of a spring is an expression of extension, parameters and time"}},
      .rules = {{Rule::Asks::not_both, "energy", "stiffness", "has both a stiffness and an energy",
                 "keep one of them"}},
      .terms = {{.formula = "stiffness*dot(a - b, a - b)/2", .when = {{Is::given, "stiffness"}, {Is::zero, "length"}}},
                {.formula = "stiffness*(norm(a - b) - length)^2/2",
                 .when = {{Is::given, "stiffness"}, {Is::not_zero, "length"}}},
                {.formula = "energy", .when = {{Is::given, "energy"}}, .extension = "norm(a - b) - length"}},
      .spring = {"a", "b"},
  };
}

}  // namespace eomgen::forces
