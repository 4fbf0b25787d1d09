// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "forces/kinds.hpp"
#include "lists.hpp"

namespace eomgen::forces {

std::span<const Kind> registry() {
#define FORCE(name) name(),
  static const std::vector<Kind> kinds{
#include "forces/registry.inc"
  };
#undef FORCE
  return kinds;
}

const Kind* find(std::string_view name) { return find_named(registry(), name); }

}  // namespace eomgen::forces
