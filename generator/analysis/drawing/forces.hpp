// SPDX-License-Identifier: GPL-3.0-or-later
// Forces and moments as arrows, for a page that is asked for them. In: a drawing and a system of equations. Out:
// vectors as outputs of that system: gravity and other forces on masses and at points, moments on bodies, what joints,
// contacts, couplings and other constraints exert, friction. What has no such vector (along a coordinate that moves
// several masses, say) is named instead.
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
  bool turns = false;  // a moment
};

class DrawnForces {
 public:
  DrawnForces(mechanics::Mechanics& mechanics, const Drawing& drawing) : mechanics_(mechanics), drawing_(drawing) {}

  /// To each candidate its own; all have them in one order.
  void add_outputs(system::EquationSystem& system);
  const std::vector<std::string>& outputs() const { return names_; }
  const std::vector<DrawnForce>& list() const { return list_; }
  /// Arrows that there would be beyond as many as anybody tells apart.
  std::size_t beyond() const { return beyond_; }
  /// Forces and constraints of which all or a part has no vector.
  const std::vector<std::string>& without_vector() const { return unknown_; }

 private:
  mechanics::Mechanics& mechanics_;
  const Drawing& drawing_;
  std::vector<std::string> names_;
  std::vector<DrawnForce> list_;
  std::size_t beyond_ = 0;
  std::vector<std::string> unknown_;
};

}  // namespace eomgen::analysis
