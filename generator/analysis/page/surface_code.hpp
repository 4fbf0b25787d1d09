// SPDX-License-Identifier: GPL-3.0-or-later
// The equations of constraints that a page draws as surfaces and curves, in JavaScript, of any values of a particle's
// coordinates: also of those that the motion has eliminated.
#pragma once

#include <string>

#include "analysis/drawing/parts.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct SurfaceCode {
  std::string script, name;  // as of LiveModel; empty where no surface is drawn
};

/// Function surface_K of the K-th surface, from 1 on: psi, then the position. Its state has all coordinates of the
/// model, their rates, and integrals.
SurfaceCode surface_code(const pipeline::Simulation& simulation, const Drawing& drawing);

}  // namespace eomgen::analysis
