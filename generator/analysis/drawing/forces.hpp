// SPDX-License-Identifier: GPL-3.0-or-later
// Arrows of forces and moments on a page. In: a drawing and a system of equations. Out: force vectors as outputs of
// that system: gravity and other forces on masses and at points, moments on bodies, friction, and reactions of joints,
// contacts, couplings and other constraints. Some forces have no such vector, for example along a coordinate that moves
// several masses; they are listed by name.
#pragma once

#include <string>
#include <vector>

#include "analysis/drawing/parts.hpp"

namespace eomgen::analysis {

struct DrawnForce {
  std::string name;
  const char* kind;        // "applied", "constraint", "friction"
  std::size_t at;          // index of the point of application among the outputs: first the drawing's, then these
  std::size_t value;       // index of the vector, likewise
  bool is_moment = false;  // a moment
};

class DrawnForces {
 public:
  DrawnForces(mechanics::Mechanics& mechanics, const Drawing& drawing) : mechanics_(mechanics), drawing_(drawing) {}

  /// Adds the outputs to one candidate system. All candidates get the same outputs in the same order.
  void add_outputs(system::EquationSystem& system);
  const std::vector<std::string>& outputs() const { return names_; }
  const std::vector<DrawnForce>& list() const { return list_; }
  /// Number of arrows omitted because the drawing would have too many.
  std::size_t omitted_count() const { return omitted_count_; }
  /// Names of forces and constraints that have no vector, or only for a part.
  const std::vector<std::string>& without_vector() const { return unknown_; }

 private:
  mechanics::Mechanics& mechanics_;
  const Drawing& drawing_;
  std::vector<std::string> names_;
  std::vector<DrawnForce> list_;
  std::size_t omitted_count_ = 0;
  std::vector<std::string> unknown_;
};

}  // namespace eomgen::analysis
