// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/statistics.hpp"

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

namespace {

/// Compensated summation by Neumaier.
class Sum {
 public:
  void add(double value) {
    const double sum = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0, rest_ = 0;
};

}  // namespace

ColumnStatistics statistics_of(const std::string& name, std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  ColumnStatistics result;
  result.name = name;
  result.count = values.size();
  if (values.empty()) return result;
  const auto count = static_cast<double>(values.size());
  Sum sum, squares;
  for (const double value : values) sum.add(value);
  result.mean = sum.value() / count;
  for (const double value : values) squares.add((value - result.mean) * (value - result.mean));
  result.deviation = values.size() > 1 ? std::sqrt(squares.value() / (count - 1)) : 0;
  result.least = values.front();
  result.greatest = values.back();
  result.histogram.resize(result.least < result.greatest ? histogram_bins : 1);
  for (const double value : values) {
    const double place = value / 2 - result.least / 2,
                 width = result.greatest / 2 - result.least / 2;  // halves, so the range does not overflow
    const std::size_t part = width > 0 ? static_cast<std::size_t>(place / width * histogram_bins) : 0;
    ++result.histogram[std::min(part, result.histogram.size() - 1)];
  }
  for (const double part : quantile_levels) {
    const double place = part * (count - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    result.quantiles.push_back(values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]));
  }
  return result;
}

}  // namespace eomgen::analysis
