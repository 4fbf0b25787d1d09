// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/reversed_speeds.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace eomgen::linear {
namespace {

constexpr std::size_t most_positions = 6;  // 64 choices

/// Whether the turned state moves as the state does, at a point on the constraints.
bool is_turned_motion(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting,
                      const std::vector<std::size_t>& turned, const std::vector<std::size_t>& reversed) {
  const std::size_t n = flow.coordinates();
  State<Precise> other = z;
  for (const std::size_t i : turned) other[i] = z[i] + cln::pi(precise_format());
  for (const std::size_t i : reversed) other[n + i] = -z[n + i];
  const Field<Precise> a = flow.at(z, setting), b = flow.at(other, setting);
  const auto differs = [](const Precise& x, const Precise& y) {
    return magnitude(x - y) > tiny<Precise>(60) * (Precise(1) + magnitude(x));
  };
  for (std::size_t i = 0; i < a.X.a.size(); ++i) {
    const bool is_reversed =
        i < 2 * n && std::find(reversed.begin(), reversed.end(), i < n ? i : i - n) != reversed.end();
    if (differs(a.X.a[i], is_reversed ? -b.X.a[i] : b.X.a[i])) return false;
  }
  return std::none_of(b.phi.a.begin(), b.phi.a.end(), [&](const Precise& gap) { return differs(gap, Precise(0)); });
}

}  // namespace

std::vector<std::size_t> reversed_by_turn(const Flow& flow, const Symmetry& symmetry, const State<Precise>& start,
                                          Setting<Precise> setting, const std::array<std::size_t, 3>& angles,
                                          std::uint64_t seed) {
  std::vector<std::size_t> turned, positions;
  for (const std::size_t i : ignorable_entries(symmetry)) {
    const bool is_angle = std::find(angles.begin(), angles.end(), i) != angles.end();
    if (is_angle)
      turned.push_back(i);
    else if (i < flow.coordinates())
      positions.push_back(i);
  }
  if (turned.empty() || positions.empty() || positions.size() > most_positions) return {};
  try {
    const auto point = nearby_state(flow, start, setting, seed);
    if (!point) return {};
    for (int count = 0; count <= static_cast<int>(positions.size()); ++count) {
      for (unsigned choice = 0; choice < 1u << positions.size(); ++choice) {
        if (std::popcount(choice) != count) continue;
        std::vector<std::size_t> reversed;
        for (std::size_t k = 0; k < positions.size(); ++k) {
          if ((choice >> k & 1u) != 0) reversed.push_back(positions[k]);
        }
        if (is_turned_motion(flow, *point, setting, turned, reversed)) return reversed;
      }
    }
  } catch (const std::domain_error&) {  // the equations have no value there
  }
  return {};
}

}  // namespace eomgen::linear
