// SPDX-License-Identifier: GPL-3.0-or-later
// Forces as arrows, for a page that is asked for them. In: a drawing and a system of equations. Out: vectors as
// outputs of that system: gravity and other forces on particles and at points, what joints and contacts exert, what all
// constraints exert on a particle, friction. Forces that have no such vector (a moment, a force along an angle of
// several bodies) are left out.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/drawing/parts.hpp"

namespace eomgen::analysis {

struct DrawnForce {
  std::string name;
  const char* kind;  // "applied", "constraint", "friction"
  std::size_t at;    // where it acts, and the force, among the outputs of the drawing and then these
  std::size_t value;
};

class DrawnForces {
 public:
  DrawnForces(mechanics::Mechanics& mechanics, const Drawing& drawing) : mechanics_(mechanics), drawing_(drawing) {}

  /// To each candidate its own; all have them in one order.
  void add_outputs(system::EquationSystem& system);
  const std::vector<std::string>& outputs() const { return names_; }
  const std::vector<DrawnForce>& list() const { return list_; }

 private:
  mechanics::Mechanics& mechanics_;
  const Drawing& drawing_;
  std::vector<std::string> names_;
  std::vector<DrawnForce> list_;
};

}  // namespace eomgen::analysis
