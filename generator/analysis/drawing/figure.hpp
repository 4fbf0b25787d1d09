// SPDX-License-Identifier: GPL-3.0-or-later
// Figure of a document: the system in its initial configuration, drawn as in a textbook. It shows rods, edges of
// bodies, springs, dampers, joints and axes; planar systems also get angles and lengths.
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "print/figure.hpp"
#include "run/scene.hpp"

namespace eomgen::analysis {

/// Returns nullopt if the model has no positions. Throws Error if a position is undefined at the start, or if the
/// figure has too many strokes.
std::optional<print::Figure> figure(mechanics::Mechanics& mechanics, const run::Scene& scene);

}  // namespace eomgen::analysis
