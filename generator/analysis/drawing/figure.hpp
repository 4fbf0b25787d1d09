// SPDX-License-Identifier: GPL-3.0-or-later
// The figure of a document: the system at a start, as a textbook draws it: rods, bodies by their edges, springs,
// dampers, joints, axes; in a plane also the angles from which positions are measured, and the lengths.
#pragma once

#include <optional>

#include "mechanics/mechanics.hpp"
#include "print/figure.hpp"
#include "run/scene.hpp"

namespace eomgen::analysis {

/// Nothing where the model has no positions. Throws Error where one has no value at the start, and where the picture
/// has too many strokes for a page.
std::optional<print::Figure> figure(mechanics::Mechanics& mechanics, const run::Scene& scene);

}  // namespace eomgen::analysis
