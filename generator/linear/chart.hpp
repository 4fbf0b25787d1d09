// SPDX-License-Identifier: GPL-3.0-or-later
// Charts of the constraint manifold: entries of z = (q, v, s, t) that determine the others, and the entries that are
// ignorable.
#pragma once

#include <cstdint>
#include <optional>

#include "linear/flow.hpp"

namespace eomgen::linear {

struct Chart {
  std::vector<std::size_t>
      independent;  // indices into z, ascending: positions, then speeds, then states of first order
  std::vector<std::size_t> dependent;
  std::size_t positions = 0;    // how many of `independent` are positions
  std::size_t first_order = 0;  // how many are states of first order
};

/// dz/d(y, t) on the constraint manifold, (N + 1) x (|y| + 1). Throws std::domain_error if the chart is singular.
template <class T>
Matrix<T> tangent(const Field<T>& field, const Chart& chart);

/// The Jacobian of the rates of y with respect to (y, t).
template <class T>
Matrix<T> reduced_jacobian(const Field<T>& field, const Chart& chart, const Matrix<T>& tangent);

/// Symmetries near a point, determined from several nearby points.
struct Symmetry {
  Chart chart;
  std::vector<bool> retained;  // per entry of y: the accelerations depend on it, directly or through other entries
  bool autonomous = true;      // no retained entry depends on time
  std::vector<std::size_t>
      constant;  // entries of z that are constant in a steady motion: retained ones and those they determine
};

/// The ignorable positions and states of first order among the independent entries.
std::vector<std::size_t> ignorable_entries(const Symmetry& symmetry);

/// Moves a state onto the constraints by Newton's method in the entries `moving` of z. Empty if it does not converge.
std::optional<State<Precise>> move_onto_constraints(const Flow& flow, State<Precise> z, const Setting<Precise>& setting,
                                                    const std::vector<std::size_t>& moving);

/// The same. Throws std::domain_error if the field has no value at the result.
std::optional<State<Precise>> project_onto_constraints(const Flow& flow, State<Precise> z,
                                                       const Setting<Precise>& setting,
                                                       const std::vector<std::size_t>& moving);
/// The same in all positions and speeds.
std::optional<State<Precise>> project_onto_constraints(const Flow& flow, const State<Precise>& z,
                                                       const Setting<Precise>& setting);

/// A state near z on the constraints and on its leaf; sets setting.leaf.
std::optional<State<Precise>> nearby_state(const Flow& flow, const State<Precise>& z, Setting<Precise>& setting,
                                           std::uint64_t seed);

/// The chart at z with the fewest retained entries. Throws std::domain_error if the field has no value there.
Symmetry find_symmetry(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting, std::uint64_t seed);

/// A pseudo-random number in [-1, 1), the same in every process.
double random_number(std::uint64_t seed, std::uint64_t index);

}  // namespace eomgen::linear
