// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "coordinates/kinds.hpp"
#include "lists.hpp"

namespace eomgen::coordinates {

std::span<const CoordinateSystem> registry() {
#define COORDINATES(name) name(),
  static const std::vector<CoordinateSystem> systems{
#include "coordinates/registry.inc"
  };
#undef COORDINATES
  return systems;
}

const CoordinateSystem* find(std::string_view name) { return find_named(registry(), name); }

}  // namespace eomgen::coordinates
