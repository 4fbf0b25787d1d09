// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/lost_rank.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>

#include "numeric/dense.hpp"
#include "run/derivative_run.hpp"
#include "run/integration.hpp"

namespace eomgen::run {
namespace {

/// Of A^T. Rows of A are scaled by their longest lengths so far: one that vanishes depends on the others.
numeric::LastPivot measure(const RunRequest& request, double t, const double* x, Eigen::VectorXd& longest) {
  const auto n = static_cast<Eigen::Index>(request.code.free.size()),
             m = static_cast<Eigen::Index>(request.code.active_constraints);
  Eigen::VectorXd psi(m), b(m);
  Eigen::MatrixXd A(m, n);
  if (request.code.constraints(t, x, request.scene.parameters.data(), psi.data(), A.data(), b.data()) != 0 ||
      !A.allFinite())
    return {};
  longest = longest.cwiseMax(A.rowwise().norm());
  for (Eigen::Index i = 0; i < m; ++i)
    if (longest(i) > 0) A.row(i) /= longest(i);
  return numeric::last_pivot(A.transpose());
}

}  // namespace

std::optional<LostRank> find_lost_rank(const RunRequest& request, const RunResult& motion, double until) {
  constexpr double near = 0.05;  // of the largest measure: aligned bars are approached in steps of 1e-2 and less
  const std::size_t m = request.code.active_constraints;
  if (m == 0 || m > request.code.free.size() || request.code.constraints == nullptr) return std::nullopt;
  double largest = 0;
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m));
  std::vector<std::pair<double, numeric::LastPivot>> path;
  Integration integration(request, motion.solver);
  integration.run(derivative_options(request, motion.solver), [&](const eom::StepView& view) {
    path.emplace_back(view.t1, measure(request, view.t1, view.x1.data(), longest));
    largest = std::max(largest, path.back().second.relative);
    return view.t1 < until;
  });
  std::optional<LostRank> found;
  double least = 0;
  bool inside = false;
  for (const auto& [t, at] : path) {
    const bool close = at.relative < near * largest;
    if (close && (!inside || at.relative < least)) {
      least = at.relative;
      found = LostRank{t, request.constraint_names[static_cast<std::size_t>(at.column)]};
    }
    inside = close;
  }
  return found;
}

void require_bounded(const RunRequest& request, const RunResult& motion, eom::Outcome outcome, double until) {
  if (outcome == eom::Outcome::interrupted || outcome == eom::Outcome::max_steps) return;
  const std::optional<LostRank> rank = find_lost_rank(request, motion, until);
  const std::string reason =
      rank ? fmt::format(
                 ": near t = {:.6g} the constraint '{}' follows from the others, and the forces are undetermined",
                 rank->t, rank->constraint)
           : "";
  refuse_derivative(
      fmt::format("their equations end before t = {:.6g} with '{}'{}", motion.t, eom::name(outcome), reason));
}

}  // namespace eomgen::run
