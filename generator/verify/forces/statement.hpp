// SPDX-License-Identifier: GPL-3.0-or-later
// The judge's own statement of each kind of force, from what the author wrote; it does not see what the description of
// the kind makes of that. A kind is one file that defines a function with its name, after forces/registry.inc.
#pragma once

#include <string_view>

#include "verify/forces/virtual_work.hpp"

namespace eomgen::verify::forces {

struct Statement {
  void (*act)(const model::Force&, VirtualWork&) = nullptr;       // its virtual work
  void (*potential)(const model::Force&, Potentials&) = nullptr;  // its energy, where it has one
};

#define FORCE(name) Statement name();
#include "forces/registry.inc"
#undef FORCE

/// Throws std::out_of_range for a kind that is none.
const Statement& statement(std::string_view kind);

}  // namespace eomgen::verify::forces
