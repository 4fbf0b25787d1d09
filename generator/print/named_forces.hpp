// SPDX-License-Identifier: GPL-3.0-or-later
// Generalised forces that are too long to write out, in terms of named vectors: F . ds/dq of a force F at a point s or
// along a line s between two points, M . domega/dqdot of a moment. Also spring energies in terms of their lines, and
// the definitions of these letters.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/reading.hpp"

namespace eomgen::print {

class NamedForces {
 public:
  /// Callbacks that format parts and collect their definitions.
  struct Callbacks {
    std::function<std::optional<reading::Formula>(symbolic::Ref)> read;  // nothing if it is too long
    /// Returns nothing if constraints must be imposed on the expression.
    std::function<std::optional<reading::Formula>(model::NodeId, symbolic::Ref lowered)> as_written;
    std::function<void(const std::string& role, const std::string& name, reading::Formula)> define;
  };

  NamedForces(mechanics::Mechanics& mechanics, Callbacks callbacks) : m_(mechanics), callbacks_(std::move(callbacks)) {}

  /// Whether all effects of a force are vectors or have a potential.
  static bool has_only_vector_effects(const model::Force& force);

  /// The energy of force j if it is a spring with a stiffness; else nothing.
  std::optional<reading::Formula> spring_energy(std::uint32_t j);

  /// Appends the generalised force of effect k of force j along coordinate i to `terms`. Returns false if it has no
  /// such form.
  bool add_generalised_force(std::uint32_t j, std::uint32_t k, std::uint32_t i, std::vector<reading::Formula>& terms);

 private:
  std::optional<reading::Formula> scalar(model::NodeId node);
  std::optional<reading::Formula> vector(model::NodeId node);
  bool define_point(std::uint32_t place);
  /// Defines a letter for the line s = a - b and returns it.
  std::optional<reading::Formula> line(std::uint32_t j, std::uint32_t k);

  mechanics::Mechanics& m_;
  Callbacks callbacks_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> effects_;  // effects whose letters are defined
  std::vector<std::uint32_t> points_;                             // places whose letters are defined
};

}  // namespace eomgen::print
