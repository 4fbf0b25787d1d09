// SPDX-License-Identifier: GPL-3.0-or-later
// Generalised forces by names, where they are too long to be written out: F . ds/dq of a force F at a point s or
// between the ends of a line s, M . domega/dqdot of a moment; energies of springs by their lines; and what these
// letters stand for.
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
  /// How parts are written, and where their definitions go.
  struct Words {
    std::function<std::optional<reading::Formula>(symbolic::Ref)> read;  // nothing of what is too long
    /// Nothing where constraints have to be built in.
    std::function<std::optional<reading::Formula>(model::NodeId, symbolic::Ref lowered)> as_written;
    std::function<void(const std::string& role, const std::string& name, reading::Formula)> define;
  };

  NamedForces(mechanics::Mechanics& mechanics, Words words) : m_(mechanics), words_(std::move(words)) {}

  /// Whether all that a force does is that of vectors, or has a potential.
  static bool are_vectors(const model::Force& force);

  /// The energy of force j, where it is that of springs with a stiffness; nothing of others.
  std::optional<reading::Formula> spring(std::uint32_t j);

  /// What effect k of force j does along coordinate i, behind `terms`; false where it cannot be written.
  bool work(std::uint32_t j, std::uint32_t k, std::uint32_t i, std::vector<reading::Formula>& terms);

 private:
  std::optional<reading::Formula> scalar(model::NodeId node);
  std::optional<reading::Formula> vector(model::NodeId node);
  bool point(std::uint32_t place);
  /// s = a - b with a letter of its own, which it gives.
  std::optional<reading::Formula> line(std::uint32_t j, std::uint32_t k);

  mechanics::Mechanics& m_;
  Words words_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> effects_;  // of forces, which are defined
  std::vector<std::uint32_t> points_;                             // places, likewise
};

}  // namespace eomgen::print
