// SPDX-License-Identifier: GPL-3.0-or-later
// Display form of a shipped model for tests: equations and tables by names of coordinates.
#pragma once

#include <string>

#include "reading/by_name.hpp"

namespace eomgen::test {

struct DisplayedModel {
  explicit DisplayedModel(const std::string& name);

  Sum operator()(const std::string& name) { return s.symbol(name); }
  reading::DisplayForm form(system::Approach approach);
  const reading::Equation& equation(const reading::DisplayForm& form, const std::string& coordinate) const;
  /// The equation as left-hand side minus applied forces, without multipliers.
  Sum motion(const reading::DisplayForm& form, const std::string& coordinate) const;

  System s;
};

/// Whether v has these components along E1, E2, E3.
bool same(const reading::Components& v, const Sum& x, const Sum& y, const Sum& z);

}  // namespace eomgen::test
