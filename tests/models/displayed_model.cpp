// SPDX-License-Identifier: GPL-3.0-or-later
#include "models/displayed_model.hpp"

#include <stdexcept>

namespace eomgen::test {

DisplayedModel::DisplayedModel(const std::string& name) : s(model::read_model(shipped(name))) {}

reading::DisplayForm DisplayedModel::form(system::Approach approach) {
  return reading::derive_display_form(s.mechanics, approach);
}

const reading::Equation& DisplayedModel::equation(const reading::DisplayForm& form,
                                                  const std::string& coordinate) const {
  for (const reading::Equation& e : form.equations) {
    if (s.model.coordinates[e.coordinate].name == coordinate) return e;
  }
  throw std::logic_error("no equation of " + coordinate);
}

Sum DisplayedModel::motion(const reading::DisplayForm& form, const std::string& coordinate) const {
  const reading::Equation& e = equation(form, coordinate);
  return e.expanded - e.force;
}

bool same(const reading::Components& v, const Sum& x, const Sum& y, const Sum& z) {
  return same(v[0], x) && same(v[1], y) && same(v[2], z);
}

}  // namespace eomgen::test
