// SPDX-License-Identifier: GPL-3.0-or-later
// The oracle's force law of each kind of force, from the arguments in the model file. It is independent of the formulas
// in the description of the kind. Each kind is one file that defines a function with its name in forces/registry.inc.
#pragma once

#include <string_view>

#include "oracle/forces/virtual_work.hpp"

namespace eomgen::verify::forces {

struct ForceLaw {
  void (*add_virtual_work)(const model::Force&, VirtualWork&) = nullptr;  // its virtual work
  void (*potential)(const model::Force&, Potentials&) = nullptr;          // its potential energy, if it has one
};

#define FORCE(name) ForceLaw name();
#include "forces/registry.inc"
#undef FORCE

/// The force law of a kind. Throws std::out_of_range for an unknown kind.
const ForceLaw& force_law(std::string_view kind);

}  // namespace eomgen::verify::forces
