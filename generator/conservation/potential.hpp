// SPDX-License-Identifier: GPL-3.0-or-later
// Potentials of force fields: U with dU/dq_i = -Q_i at fixed t, found by integrating along one coordinate after the
// other or by Euler's formula for homogeneous fields, proven by differentiation; its domain, and whether it is one
// function of the place (docs/theory.md, "Force fields").
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
  std::vector<DomainCondition> domain;  // of U; what is known to be positive is left out
};

/// Nothing where none was found, which does not say that there is none. Q: per coordinate of the model.
std::optional<Potential> find_potential(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& Q);

std::vector<DomainCondition> domain_of(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& expressions);

/// The work of a field whose curl vanishes along closed paths: none on all that were tried, or not.
struct Circulation {
  enum class Answer { none, some, undecided } answer = Answer::none;
  std::string around;                      // of some: "one turn of theta", "a closed path in the plane of x and y"
  std::optional<symbolic::Ref> work = {};  // of one turn, as an expression
};

/// Turns of coordinates that bring `places` back where they were (symbolic, if U is given), and circles in the planes
/// of two other coordinates (by numbers).
Circulation circulation(mechanics::Mechanics& mechanics, const std::vector<symbolic::Ref>& Q,
                        const std::optional<Potential>& potential, const std::vector<mechanics::Vec3>& places);

}  // namespace eomgen::conservation
