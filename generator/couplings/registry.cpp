// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "couplings/kinds.hpp"
#include "lists.hpp"

namespace eomgen::couplings {

std::span<const Coupling> registry() {
#define COUPLING(name) name(),
  static const std::vector<Coupling> couplings{
#include "couplings/registry.inc"
  };
#undef COUPLING
  return couplings;
}

const Coupling* find(std::string_view name) { return find_named(registry(), name); }

}  // namespace eomgen::couplings
