// SPDX-License-Identifier: MIT
// Tolerances of Radau IIA with s stages (collocation.hpp). The estimate has order s, so r is replaced by
// r^((s+1)/(2s))/10. Newton's iteration has its own tolerance. In: options, the start. Out: the tolerances for each s.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "eom/run_types.hpp"

namespace eom::implicit {

class StageTolerances {
 public:
  double rtol = 0, atol = 0;  // of the estimate
  double newton = 0;          // of the iteration, in units of the above

  /// x: the components that count.
  StageTolerances(const Options& options, std::span<const double> x)
      : asked_rtol_(options.rtol), asked_atol_(options.atol) {
    double largest = 0;
    for (const double value : x) largest = std::max(largest, std::abs(value));
    const double of_atol = options.atol > 0 ? options.atol / std::max(largest, 1e-300) : 0;
    tolerance_ = std::clamp(std::max(options.rtol, of_atol), 10 * epsilon, 1e-3);
  }

  void use(std::size_t s) {
    const double power = static_cast<double>(s + 1) / static_cast<double>(2 * s);
    const double loosened = 0.1 * std::pow(tolerance_, power - 1);
    rtol = loosened * asked_rtol_;
    atol = loosened * asked_atol_;
    const double compared = loosened * tolerance_;
    newton = std::max(10 * epsilon / compared, std::min(0.03, std::pow(compared, 1 / power - 1)));
  }

 private:
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  double asked_rtol_, asked_atol_, tolerance_ = 0;
};

}  // namespace eom::implicit
