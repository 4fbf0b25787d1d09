// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "couplings/kinds.hpp"

namespace eomgen::couplings {
namespace {

const std::vector<Coupling>& all() {
#define COUPLING(name) name(),
  static const std::vector<Coupling> couplings{
#include "couplings/registry.inc"
  };
#undef COUPLING
  return couplings;
}

}  // namespace

std::span<const Coupling> registry() { return all(); }

const Coupling* find(std::string_view name) {
  for (const Coupling& coupling : registry()) {
    if (coupling.name == name) return &coupling;
  }
  return nullptr;
}

}  // namespace eomgen::couplings
