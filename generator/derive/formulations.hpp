// SPDX-License-Identifier: GPL-3.0-or-later
// The registry of formulations of the equations of motion. Each derives the same EquationSystem in its own way and
// includes no other. All start from Mechanics and end with equations.hpp; lagrange and expanded differentiate energies
// with euler_lagrange.hpp; recursive and articulated find and describe a tree with trees/. docs/architecture.md lists
// the shared files. verify checks the formulations against one another and against the independent oracle, which shares
// nothing with them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "mechanics/mechanics.hpp"
#include "system/equation_system.hpp"

namespace eomgen::derive {

inline constexpr std::size_t unlimited_size = static_cast<std::size_t>(-1);

struct FormulationEntry {
  const char* name;
  const char* title;
  const char* applicability;  // to which models; reported if the formulation is skipped
  /// Empty if the formulation does not apply to the model in this approach.
  std::optional<system::EquationSystem> (*derive)(mechanics::Mechanics&, system::Approach);
  /// The number of coordinates of a tree beyond which a tree formulation with a larger limit is far cheaper.
  std::size_t max_tree_size = unlimited_size;
  bool is_for_trees = false;  // for trees of particles or bodies
};

/// In the order of derive/formulations/registry.inc, NAME() of derive/formulations/NAME.cpp.
std::span<const FormulationEntry> formulations();

namespace formulation {
#define FORMULATION(name) FormulationEntry name();
#include "derive/formulations/registry.inc"
#undef FORMULATION
}  // namespace formulation

/// The equations of a formulation, or why it was skipped.
struct DerivationResult {
  std::optional<system::EquationSystem> system;
  std::string skip_reason;   // empty where there are equations
  bool over_budget = false;  // false: it does not apply, or another one is far cheaper
};

/// Derives the equations within a budget of operations. A formulation is skipped if another is far cheaper on a tree of
/// that size: full matrices serve small systems only (docs/theory.md, "Formulations").
DerivationResult derive_if_worthwhile(const FormulationEntry& formulation, mechanics::Mechanics& mechanics,
                                      system::Approach approach);

}  // namespace eomgen::derive
