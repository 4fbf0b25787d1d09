// SPDX-License-Identifier: GPL-3.0-or-later
// Friction along a motion that is prescribed as a whole. In: the equations of a model without free coordinates, whose
// reactions depend on the friction forces phi. Out: phi at a time. The law is that of docs/theory.md, "Friction":
// phi = -mu N slip/|slip|. Slip is a function of time here, so that only N is left to solve for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::analysis {

class PrescribedFriction {
 public:
  using Lookup = std::function<double(const symbolic::Symbol&)>;

  /// `system` must outlive this object. Throws Error if a contact can open.
  PrescribedFriction(const system::EquationSystem& system, const std::string& file);

  struct Forces {
    std::vector<double> phi;           // by index of the symbol
    std::vector<std::string> resting;  // contacts at rest: any friction up to the static limit fits, and phi is 0
  };
  /// The friction forces at a time; `lookup` gives all other symbols. Empty if none that fit the motion were found.
  std::optional<Forces> at(const Lookup& lookup) const;

 private:
  std::vector<double> direction(const system::Contact& contact, const Lookup& lookup) const;

  const system::EquationSystem& system_;
  std::size_t count_ = 0;
};

}  // namespace eomgen::analysis
