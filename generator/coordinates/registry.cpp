// SPDX-License-Identifier: GPL-3.0-or-later
// To add a coordinate system: one file like spherical.cpp, one declaration and one line here.
#include <array>

#include "coordinates/coordinate_system.hpp"

namespace eomgen::coordinates {

extern const CoordinateSystem cartesian;
extern const CoordinateSystem cylindrical;
extern const CoordinateSystem spherical;
extern const CoordinateSystem parabolic;
extern const CoordinateSystem helical;
extern const CoordinateSystem oblique;

namespace {
constexpr std::array<const CoordinateSystem*, 6> systems{
    &cartesian, &cylindrical, &spherical, &parabolic, &helical, &oblique,
};
}  // namespace

std::span<const CoordinateSystem* const> registry() { return systems; }

const CoordinateSystem* find(std::string_view name) {
  for (const CoordinateSystem* system : systems) {
    if (system->name == name) return system;
  }
  return nullptr;
}

}  // namespace eomgen::coordinates
