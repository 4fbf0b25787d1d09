// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/basins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eomgen::analysis {

BasinStatistics::BasinStatistics(const SteadyMotions& found, double within) : tolerance_(within) {
  const std::vector<std::string>& names = found.problem.flow->names();
  const std::vector<std::size_t> ignored = linear::ignorable_entries(found.search.symmetry);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(ignored.begin(), ignored.end(), i) != ignored.end()) continue;
    places.push_back(i);
    names_.push_back(names[i]);
    turns_.push_back(i < found.search.is_angle.size() && found.search.is_angle[i]);
  }
  for (const SteadyMotion& point : found.points) {
    Attractor goal;
    for (std::size_t k = 0; k < places.size(); ++k)
      goal.values.emplace_back(names_[k], display_value(point.l.z[places[k]]));
    goal.stability = point.verdict.stability;
    attractors_.push_back(std::move(goal));
  }
}

void BasinStatistics::classify(const std::vector<double>& state) {
  const auto goal =
      std::find_if(attractors_.begin(), attractors_.end(), [&](const Attractor& g) { return is_at(g, state); });
  ++(goal == attractors_.end() ? unclassified_ : goal->runs);
}

bool BasinStatistics::is_at(const Attractor& goal, const std::vector<double>& state) const {
  for (std::size_t k = 0; k < state.size(); ++k) {
    const double difference = state[k] - goal.values[k].second;
    const double distance = turns_[k] ? std::remainder(difference, 2 * std::numbers::pi) : difference;
    if (!(std::abs(distance) <= tolerance_)) return false;
  }
  return true;
}

}  // namespace eomgen::analysis
