// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials of force fields: U with dU/dq_i = -Q_i at fixed t. They are found by integration along one coordinate
// after another or by Euler's formula for homogeneous fields, and proven by differentiation. Also their domain, and
// whether they are single-valued (docs/theory.md, "Force fields").
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"

namespace eomgen::conservation {

/// A condition under which an expression has a value: e != 0 or e > 0.
struct DomainCondition {
  symbolic::Ref expression;
  const char* relation;  // "!= 0", "> 0"
};

struct Potential {
  symbolic::Ref U;
  std::vector<DomainCondition> domain;  // of U, without conditions that are known to hold
};

/// Empty if none is found; one may still exist. Q: per coordinate of the model.
std::optional<Potential> find_potential(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& Q);

std::vector<DomainCondition> domain_of(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& expressions);

/// The work of a field of vanishing curl along closed paths: none on all paths tried, or some.
struct Circulation {
  enum class Answer { none, some, undecided } answer = Answer::none;
  std::string path;                        // if some: "one turn of theta", "a closed path in the plane of x and y"
  std::optional<symbolic::Ref> work = {};  // of one turn, as an expression
};

/// Tests turns of coordinates that bring `places` back to their positions (symbolic, if U is given), and circles in the
/// planes of two other coordinates (numerical).
Circulation circulation(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& Q,
                        const std::optional<Potential>& potential, const std::vector<mechanics::Vec3>& places);

}  // namespace eomgen::conservation
