// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

// For free length 0, (norm(a - b))^2 is written without the square root, so that it has no singular point.
Kind spring() {
  return {
      .name = "spring",
      .title = "a potential energy of the distance of two points",
      .keys = {{.name = "between", .type = ValueType::ends, .dependency = Dependency::motion},
               {.name = "length", .unit = "m", .optional = true, .default_value = "0"},
               {.name = "stiffness", .unit = "N/m", .required_unless = "energy", .is_stiffness = true},
               {.name = "energy",
                .type = ValueType::energy,
                .unit = "J",
                .optional = true,
                .remedy = "the energy of a spring is an expression of extension, parameters and time"}},
      .rules = {{Rule::Type::not_both, "energy", "stiffness", "has both a stiffness and an energy",
                 "keep one of them"}},
      .terms = {{.formula = "stiffness*dot(a - b, a - b)/2",
                 .conditions = {{Predicate::given, "stiffness"}, {Predicate::zero, "length"}}},
                {.formula = "stiffness*(norm(a - b) - length)^2/2",
                 .conditions = {{Predicate::given, "stiffness"}, {Predicate::nonzero, "length"}}},
                {.formula = "energy",
                 .conditions = {{Predicate::given, "energy"}},
                 .extension = "norm(a - b) - length"}},
      .spring = {"a", "b"},
      .linear_spring = {"stiffness", "length"},
  };
}

}  // namespace eomgen::forces
