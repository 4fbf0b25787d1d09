// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/kinds.hpp"

namespace eomgen::forces {

// Displacements x_i = (rB - rA) . A_i along the axes of A. Rotations p_i = sin(p) n . A_i, for the rotation by p about
// n from the axes of A to those of B. Forces and moments on A and B are opposite; both forces act at the point of B.
Kind bushing() {
  const std::string x1 = "dot(rB - rA, A1)", x2 = "dot(rB - rA, A2)", x3 = "dot(rB - rA, A3)";
  const std::string p1 = "((dot(B2, A3) - dot(B3, A2))/2)", p2 = "((dot(B3, A1) - dot(B1, A3))/2)",
                    p3 = "((dot(B1, A2) - dot(B2, A1))/2)";
  const std::string moment =
      "(rotational_coefficient1*dot(wB - wA, A1)*A1 + rotational_coefficient2*dot(wB - wA, A2)*A2 + "
      "rotational_coefficient3*dot(wB - wA, A3)*A3)";
  const Condition slides{Predicate::given, "coefficient"}, turns{Predicate::given, "rotational_coefficient"};
  return {
      .name = "bushing",
      .title = "springs and dampers along and about the axes of one of two bodies",
      .keys = {{.name = "bodies", .type = ValueType::bodies},
               {.name = "at", .type = ValueType::points, .dependency = Dependency::motion},
               {.name = "stiffness", .type = ValueType::triple, .unit = "N/m", .optional = true, .is_stiffness = true},
               {.name = "coefficient",
                .type = ValueType::triple,
                .unit = "N*s/m",
                .dependency = Dependency::state,
                .optional = true},
               {.name = "rotational_stiffness",
                .type = ValueType::triple,
                .unit = "N*m",
                .optional = true,
                .is_stiffness = true},
               {.name = "rotational_coefficient",
                .type = ValueType::triple,
                .unit = "N*m*s",
                .dependency = Dependency::state,
                .optional = true}},
      .rules = {{Rule::Type::one_of,
                 "stiffness",
                 "coefficient",
                 "has neither a stiffness nor a coefficient",
                 "add stiffness = [\"..\", \"..\", \"..\"], along three axes, or another one of its keys",
                 {"rotational_stiffness", "rotational_coefficient"}}},
      .terms = {{.formula = "(stiffness1*" + x1 + "^2 + stiffness2*" + x2 + "^2 + stiffness3*" + x3 + "^2)/2",
                 .conditions = {{Predicate::given, "stiffness"}}},
                {.formula = "(rotational_stiffness1*" + p1 + "^2 + rotational_stiffness2*" + p2 +
                            "^2 + rotational_stiffness3*" + p3 + "^2)/2",
                 .conditions = {{Predicate::given, "rotational_stiffness"}}},
                {.load_type = LoadType::work,
                 .formula = "-(coefficient1*ddt(" + x1 + "))",
                 .at = x1,
                 .conditions = {slides}},
                {.load_type = LoadType::work,
                 .formula = "-(coefficient2*ddt(" + x2 + "))",
                 .at = x2,
                 .conditions = {slides}},
                {.load_type = LoadType::work,
                 .formula = "-(coefficient3*ddt(" + x3 + "))",
                 .at = x3,
                 .conditions = {slides}},
                {.load_type = LoadType::moment, .formula = "-" + moment, .at = "B", .conditions = {turns}},
                {.load_type = LoadType::moment, .formula = moment, .at = "A", .conditions = {turns}}},
      .spring = {"rA", "rB"},
      .damper = {"rA", "rB"},
  };
}

}  // namespace eomgen::forces
