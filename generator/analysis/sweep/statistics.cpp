// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/sweep/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::analysis {
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
