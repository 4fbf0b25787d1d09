// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn of a model, decided once: solids, rods and threads, supports, wheels. In: the parts of its drawing, the
// start of a scene, rows of a motion. Out: a list that the figure of a document, an animation and the page of `report`
// only paint. Lengths are expressions in parameters, so that a page evaluates them for its own parameters.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "analysis/drawing/solids.hpp"
#include "run/scene.hpp"

namespace eomgen::analysis {

/// The solids of a body, or of a particle with a shape in [draw].
struct DrawnSolids {
  std::size_t place;
  std::optional<std::array<std::size_t, 2>> axes;  // vectors: the first two body axes; none: the fixed axes
  std::vector<DrawnSolid> list;
};
/// A line between two places (-1: the origin): a rod, or a thread if their distance changes.
struct DrawnLink {
  long from, to;
  bool is_rod;
};
/// A point that the ground holds.
struct DrawnSupport {
  std::optional<std::size_t> at;  // a vector; none: the origin
  Point toward;                   // the fixed axis along which it holds its part
};
/// Two coupled wheels with parallel axes: pitch circles, and the belt over them. External gears rotate in opposite
/// directions and touch between the centres. A gear in a ring gear, both on a carrier, touches outside the centres.
/// Pulleys take the radii of disks drawn on the two bodies, otherwise a size at which the belt is visible.
struct DrawnWheels {
  std::array<std::size_t, 2> of;     // places
  std::size_t axis;                  // a unit vector
  std::array<std::size_t, 2> radii;  // sizes
  std::optional<std::size_t> belt;   // a size: cosine of the angle between the line of centres and the ends of the belt
};

struct Primitives {
  std::vector<symbolic::Ref> sizes;  // expressions in parameters
  std::vector<double> size_values;   // at the start; -1 if undefined
  std::vector<DrawnSolids> solids;   // of all bodies, then of particles
  std::vector<DrawnLink> links;
  std::vector<DrawnSupport> supports;
  std::vector<DrawnWheels> wheels;
};

/// Values of the vectors of a drawing at coordinates, otherwise at the start of a scene.
std::vector<double> values_at(const Drawing& drawing, const symbolic::Dag& dag, const run::Scene& scene,
                              const std::vector<double>& q);

/// The start of a scene and two other states, which show what moves and which lengths change. They ignore constraints
/// that are not eliminated. `delay`: from one to the next, in s.
std::vector<std::vector<double>> sampled_values(const Drawing& drawing, const symbolic::Dag& dag,
                                                const run::Scene& scene, double delay);

/// `rows`: values of the vectors over a motion, which determine the directions of supports; empty: those of the start.
Primitives primitives(const Drawing& drawing, symbolic::Dag& dag, const run::Scene& scene,
                      const std::vector<std::vector<double>>& rows);

}  // namespace eomgen::analysis
