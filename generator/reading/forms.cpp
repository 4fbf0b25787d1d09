// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/forms.hpp"

#include <stdexcept>

#include "mechanics/dependent.hpp"
#include "reading/no_value.hpp"

namespace eomgen::reading {

using system::Approach;

Forms::Forms(const mechanics::Mechanics& mechanics) try
    : m_(mechanics), nothing_imposed_(mechanics::impose_dependent(mechanics).fixed.empty()) {
} catch (const std::domain_error&) {
  throw no_value(mechanics);
}

const DisplayForm& Forms::operator()(Approach approach, Extent extent) {
  for (const Extent enough : {extent, Extent::whole}) {
    if (const auto found = known_.find({approach, enough}); found != known_.end()) return found->second;
  }
  const Approach other = approach == Approach::one ? Approach::two : Approach::one;
  for (const Extent enough : {extent, Extent::whole}) {
    const auto found = known_.find({other, enough});
    if (!nothing_imposed_ || found == known_.end() || !found->second.by_parts) continue;
    DisplayForm same = found->second;
    same.approach = approach;
    return known_.emplace(std::pair(approach, enough), std::move(same)).first->second;
  }
  return known_.emplace(std::pair(approach, extent), derive_reading(m_, approach, extent)).first->second;
}

RouthForm Forms::routh(const std::vector<std::uint32_t>& cyclic) {
  if (cyclic.empty()) return {};
  return routh_form(m_, cyclic, (*this)(Approach::two, Extent::equations));
}

DisplayForm derive_reading(const mechanics::Mechanics& mechanics, Approach approach) {
  return derive_reading(mechanics, approach, Extent::whole);
}

RouthForm routh_form(const mechanics::Mechanics& mechanics, const std::vector<std::uint32_t>& cyclic) {
  return Forms(mechanics).routh(cyclic);
}

LinearForm linear_form(const mechanics::Mechanics& mechanics) { return Forms(mechanics).linear(); }

LinearForm Forms::linear() { return linear_form(m_, (*this)(Approach::two, Extent::equations)); }

}  // namespace eomgen::reading
