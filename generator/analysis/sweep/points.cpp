// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/points.hpp"

#include "analysis/shortest_decimal.hpp"
#include "error.hpp"

namespace eomgen::analysis {

std::vector<symbolic::Rational> ListedPoints::point(std::size_t index) const {
  std::vector<symbolic::Rational> result;
  for (std::size_t k = 0; k < names.size(); ++k)
    result.push_back(shortest_decimal(values[index * names.size() + k], names[k]));
  return result;
}

SweepPoints::SweepPoints(std::optional<Grid> grid, std::optional<Sampling> samples, std::optional<ListedPoints> listed)
    : grid_(std::move(grid)), samples_(std::move(samples)), listed_(std::move(listed)) {
  if (grid_) {
    size_ = grid_->size();
    for (const GridAxis& axis : grid_->axes()) {
      names_.push_back(axis.parameter);
      units_.push_back(axis.unit);
    }
  }
  if (samples_) {
    for (const SampledAxis& axis : samples_->axes()) units_.push_back(axis.unit);
  }
  if (listed_) units_.resize(units_.size() + listed_->names.size());
  if (!samples_ && !listed_) return;
  const std::vector<std::string> more = samples_ ? samples_->names() : listed_->names;
  names_.insert(names_.end(), more.begin(), more.end());
  const std::size_t each = samples_ ? samples_->size() : listed_->size();
  if (each > max_points / size_) {
    throw Error("sweep", {}, fmt::format("the grid with its samples has more than {} points", max_points),
                "take fewer");
  }
  size_ *= each;
}

std::map<std::string, symbolic::Rational> SweepPoints::point(std::size_t index) const {
  std::map<std::string, symbolic::Rational> result;
  const std::size_t each = samples_ ? samples_->size() : listed_ ? listed_->size() : 1;
  if (grid_) result = grid_->point(index / each);
  if (!samples_ && !listed_) return result;
  const std::vector<symbolic::Rational> values =
      samples_ ? samples_->point(index % each) : listed_->point(index % each);
  const std::size_t first = names_.size() - values.size();
  for (std::size_t i = 0; i < values.size(); ++i) result[names_[first + i]] = values[i];
  return result;
}

}  // namespace eomgen::analysis
