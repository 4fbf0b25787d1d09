// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/forms.hpp"

#include <stdexcept>

#include "mechanics/dependent_coordinates.hpp"
#include "reading/no_value.hpp"

namespace eomgen::reading {

using system::Approach;

DisplayForms::DisplayForms(const mechanics::Mechanics& mechanics) try
    : m_(mechanics), nothing_imposed_(mechanics::eliminate_dependent_coordinates(mechanics).fixed.empty()) {
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

const DisplayForm& DisplayForms::operator()(Approach approach, Extent extent) {
  for (const Extent enough : {extent, Extent::whole}) {
    if (const auto found = known_.find({approach, enough}); found != known_.end()) return found->second;
  }
  const Approach other = approach == Approach::one ? Approach::two : Approach::one;
  for (const Extent enough : {extent, Extent::whole}) {
    const auto found = known_.find({other, enough});
    if (!nothing_imposed_ || found == known_.end() || !found->second.is_unexpanded) continue;
    DisplayForm same = found->second;
    same.approach = approach;
    return known_.emplace(std::pair(approach, enough), std::move(same)).first->second;
  }
  return known_.emplace(std::pair(approach, extent), derive_display_form(m_, approach, extent)).first->second;
}

RouthForm DisplayForms::routh(const std::vector<std::uint32_t>& cyclic) {
  if (cyclic.empty()) return {};
  return routh_form(m_, cyclic, (*this)(Approach::two, Extent::equations));
}

DisplayForm derive_display_form(const mechanics::Mechanics& mechanics, Approach approach) {
  return derive_display_form(mechanics, approach, Extent::whole);
}

RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic) {
  return DisplayForms(mechanics).routh(cyclic);
}

LinearForm linear_form(const mechanics::Mechanics& mechanics) { return DisplayForms(mechanics).linear(); }

SolvedForm DisplayForms::solved(FrictionMode mode) {
  return solved_form(m_, (*this)(Approach::one, Extent::whole), mode);
}

LinearForm DisplayForms::linear() { return linear_form(m_, (*this)(Approach::two, Extent::equations)); }

}  // namespace eomgen::reading
