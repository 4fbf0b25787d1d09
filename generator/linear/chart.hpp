// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates of the constraint manifold: some entries of z = (q, v, t) that determine the others, and which of them
// the motion of the rest does not feel.
#pragma once

#include <cstdint>
#include <optional>

#include "linear/flow.hpp"

namespace eomgen::linear {

struct Chart {
  std::vector<std::size_t> independent;  // places in z, ascending: positions, then speeds
  std::vector<std::size_t> dependent;
  std::size_t positions = 0;  // how many of `independent` are positions
};

/// dz/d(y, t) on the constraint manifold, (2n + 1) x (|y| + 1). Throws std::domain_error where the chart fails.
template <class T>
Matrix<T> tangent(const Field<T>& field, const Chart& chart);

/// Slopes of the rates of y by (y, t).
template <class T>
Matrix<T> reduced(const Field<T>& field, const Chart& chart, const Matrix<T>& tangent);

/// What holds identically near a point, told from several points beside it.
struct Symmetry {
  Chart chart;
  std::vector<bool> retained;  // per entry of y: the accelerations feel it, or something does that they feel
  bool autonomous = true;      // nothing that is retained feels the time
  std::vector<std::size_t>
      constant;  // entries of z that a steady motion keeps: the retained ones and what they determine
};

/// Positions among the independent entries that nothing feels.
std::vector<std::size_t> ignored_positions(const Symmetry& symmetry);

/// A state on the constraints, by Newton's iteration in these entries of z; nothing where it finds none.
std::optional<State<Precise>> projected(const Flow& flow, State<Precise> z, const Setting<Precise>& setting,
                                        const std::vector<std::size_t>& moving);
/// All entries but t.
std::optional<State<Precise>> projected(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting);

/// A state beside z on the constraints (and on its leaf: setting.leaf is set to it).
std::optional<State<Precise>> beside(const Flow& flow, const State<Precise>& z, Setting<Precise>& setting,
                                     std::uint64_t seed);

/// The chart at z in which the fewest entries are retained. Throws std::domain_error where there is no field.
Symmetry find_symmetry(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting, std::uint64_t seed);

/// In [-1, 1), the same in every process.
double random_number(std::uint64_t seed, std::uint64_t index);

}  // namespace eomgen::linear
