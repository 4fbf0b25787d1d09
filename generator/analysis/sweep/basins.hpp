// SPDX-License-Identifier: GPL-3.0-or-later
// Which equilibrium each run of a sweep came to. In: the equilibria and steady motions that were found, states in which
// runs ended. Out: how many ended at each, and elsewhere.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "analysis/steady_search.hpp"

namespace eomgen::analysis {

class Basins {
 public:
  struct Goal {
    std::vector<std::pair<std::string, double>> values;  // of the coordinates that the equations feel, then their rates
    linear::Stability stability = linear::Stability::unknown;
    std::size_t runs = 0;
  };

  /// A run has come to one where each coordinate (an angle but for turns) and each rate is `within` of it, in SI units.
  Basins(const SteadyMotions& found, double within);

  /// Names of what see() wants, in its order.
  const std::vector<std::string>& names() const { return names_; }
  void see(const std::vector<double>& state);

  const std::vector<Goal>& goals() const { return goals_; }
  std::size_t elsewhere() const { return elsewhere_; }
  double within() const { return within_; }

 private:
  bool is_at(const Goal& goal, const std::vector<double>& state) const;

  double within_;
  std::vector<std::string> names_;
  std::vector<bool> turns_;  // per name
  std::vector<Goal> goals_;
  std::size_t elsewhere_ = 0;
};

}  // namespace eomgen::analysis
