// SPDX-License-Identifier: GPL-3.0-or-later
// Charts with a singularity that can be exchanged for a second chart there: Euler angles of a body or frame, spherical
// coordinates of a place. In: a Model. Out: the pairs of charts, why some cannot be exchanged, and the Model in second
// charts.
//
// The second chart of the angles i-j-k differs in the third axis only (313: 312, 321: 323). One chart is singular if
// E_i is along e_k, the other if E_i is along another axis of the body, so never both at once. The second spherical
// chart has its pole on E1.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace eomgen::model {

struct ChartPair {
  enum class Kind { rotation, position };
  Kind kind = Kind::rotation;
  std::string of;                     // "B"; "B.position" of a body's centre of mass
  std::string own, second;            // "313", "312"; "spherical about E3", "spherical about E1"
  std::uint32_t index = 0;            // into Model::frames or Model::places
  std::array<std::size_t, 3> axes{};  // 0 to 2, of the own rotation
  std::size_t second_axis = 0;        // in place of axes[2]
  std::vector<std::uint32_t> angles;  // coordinates with a different meaning in the second chart
  std::size_t guarded = 0;            // index of the angle that measures the distance from the singularity
  bool at_sine = true;                // singular at zeros of the sine of that angle; else of the cosine
  std::string refusal;                // why it cannot be exchanged; empty: it can

  /// "sin(theta)": an expression that is 0 where the own chart is singular.
  std::string singularity(const Model& model) const;
};

/// All charts of a model with a singularity, rotations first, including those that cannot be exchanged.
std::vector<ChartPair> charts(const Model& model);

/// "the angles 321 of 'S' are singular at be = 1.5708" and what to do.
struct SingularChart {
  std::string what, remedy;
  explicit operator bool() const { return !what.empty(); }
};
/// The first chart whose guarded sine or cosine is at most `distance` from 0. `value_of`: the value of a coordinate,
/// none if it is not known. Empty if there is none.
SingularChart find_singular_chart(const Model& model,
                                  const std::function<std::optional<double>(std::uint32_t coordinate)>& value_of,
                                  double distance);

/// The model with the second charts of those whose bit in `mask` is set: the same names, other meanings of the angles.
/// Scenes still refer to the own charts.
Model in_second_charts(const Model& model, const std::vector<ChartPair>& charts, unsigned mask);

}  // namespace eomgen::model
