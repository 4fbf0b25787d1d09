// SPDX-License-Identifier: GPL-3.0-or-later
// The reading form of a shipped model in a test: equations and tables by the names of coordinates.
#pragma once

#include <stdexcept>
#include <string>

#include "reading/by_name.hpp"

namespace eomgen::test {

struct Read {
  explicit Read(const std::string& name) : s(model::read_model(shipped(name))) {}

  Sum operator()(const std::string& name) { return s.symbol(name); }
  reading::ReadingForm form(system::Approach approach) { return reading::derive_reading(s.mechanics, approach); }
  const reading::Equation& equation(const reading::ReadingForm& form, const std::string& coordinate) const {
    for (const reading::Equation& e : form.equations) {
      if (s.model.coordinates[e.coordinate].name == coordinate) return e;
    }
    throw std::logic_error("no equation of " + coordinate);
  }
  /// The equation as left-hand side minus applied forces; multipliers left out.
  Sum motion(const reading::ReadingForm& form, const std::string& coordinate) const {
    const reading::Equation& e = equation(form, coordinate);
    return e.expanded - e.force;
  }

  System s;
};

/// Components along E1, E2, E3.
inline bool same(const reading::Components& v, const Sum& x, const Sum& y, const Sum& z) {
  return same(v[0], x) && same(v[1], y) && same(v[2], z);
}

}  // namespace eomgen::test
