// SPDX-License-Identifier: GPL-3.0-or-later
#include <vector>

#include "coordinates/kinds.hpp"

namespace eomgen::coordinates {
namespace {

const std::vector<CoordinateSystem>& all() {
#define COORDINATES(name) name(),
  static const std::vector<CoordinateSystem> systems{
#include "coordinates/registry.inc"
  };
#undef COORDINATES
  return systems;
}

}  // namespace

std::span<const CoordinateSystem> registry() { return all(); }

const CoordinateSystem* find(std::string_view name) {
  for (const CoordinateSystem& system : registry()) {
    if (system.name == name) return &system;
  }
  return nullptr;
}

}  // namespace eomgen::coordinates
