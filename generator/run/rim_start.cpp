// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/rim_start.hpp"

#include <numbers>

#include "error.hpp"

namespace eomgen::run {

void solve_start_on_rims(StartProblem& problem, const std::vector<double>& lower, const std::vector<double>& upper) {
  constexpr int angles = 8;
  const auto outside = [&](const std::vector<double>& q) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < q.size(); ++i) count += q[i] > lower[i] && q[i] < upper[i] ? 0 : 1;
    return count;
  };
  solve_start(problem);
  const std::vector<model::Coordinate>& coordinates = problem.mechanics.model->coordinates;
  for (std::uint32_t i = 0; i < coordinates.size(); ++i) {
    const StartProblem::Key key{i, 0};
    if (!coordinates[i].is_along_rim || problem.given.contains(key) || problem.guess.contains(key)) continue;
    for (int k = 1; k < angles && outside(problem.q) > 0; ++k) {
      StartProblem other = problem;
      other.solved_notes.clear();
      other.open.clear();
      other.guess[key] = 2 * std::numbers::pi * k / angles;
      try {
        solve_start(other);
      } catch (const Error&) {
        continue;  // no start is near this angle
      }
      if (outside(other.q) >= outside(problem.q)) continue;
      problem.guess = other.guess;
      problem.q = other.q;
      problem.qdot = other.qdot;
      problem.solved_notes = other.solved_notes;
      problem.open = other.open;
    }
  }
}

}  // namespace eomgen::run
