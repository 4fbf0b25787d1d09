// SPDX-License-Identifier: GPL-3.0-or-later
// JavaScript code of the constraint equations that a page draws as surfaces and curves. It evaluates psi at any values
// of a particle's coordinates, including coordinates that the equations of motion eliminate.
#pragma once

#include <string>

#include "analysis/drawing/parts.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct SurfaceCode {
  std::string script, name;  // as in LiveModel; empty if no surface is drawn
};

/// Generates a function surface_K for the K-th surface, K = 1, 2, ..: it returns psi, then the position. Its state
/// consists of all coordinates of the model, their rates, and the states of first order.
SurfaceCode surface_code(const pipeline::Simulation& simulation, const Drawing& drawing);

}  // namespace eomgen::analysis
