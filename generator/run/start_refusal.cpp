// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/start_refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "numeric/dense.hpp"
#include "run/scene.hpp"

namespace eomgen::run {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Residuals and derivatives of all rows by the free unknowns, at the current values.
struct Rows {
  VectorXd residual;
  MatrixXd A;
};

Rows rows_at(const StartRows& rows, std::uint8_t order, const std::vector<std::size_t>& free) {
  Rows result;
  MatrixXd all;
  rows.linearise(order, result.residual, all);
  result.A = MatrixXd(all.rows(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    result.A.col(static_cast<Eigen::Index>(i)) = all.col(static_cast<Eigen::Index>(free[i]));
  return result;
}

struct Broken {
  std::size_t row;
  double off, relative;  // violation; the same relative to the terms of the row
};

/// For rates: the first constraint that is incompatible with the given values and the previous constraints, and its
/// violation.
std::optional<Broken> first_broken(const StartRows& rows, const std::vector<std::size_t>& free) {
  const auto [residual, columns] = rows_at(rows, 1, free);
  const std::vector<std::size_t>& bound = rows.of_order(1);
  const std::size_t turns = rows.first_angular_velocity_row();
  std::vector<std::size_t> before;
  for (std::size_t k = 0; k < bound.size(); ++k) {
    if (bound[k] >= turns) before.push_back(k);
  }
  for (std::size_t k = 0; k < bound.size(); ++k) {
    if (bound[k] >= turns) continue;
    const auto count = static_cast<Eigen::Index>(before.size());
    MatrixXd held(count, columns.cols());
    VectorXd wanted(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      held.row(i) = columns.row(static_cast<Eigen::Index>(before[static_cast<std::size_t>(i)]));
      wanted(i) = residual(static_cast<Eigen::Index>(before[static_cast<std::size_t>(i)]));
    }
    const auto row = static_cast<Eigen::Index>(k);
    VectorXd move = VectorXd::Zero(columns.cols());
    VectorXd beside = columns.row(row).transpose();
    if (count > 0 && columns.cols() > 0) {
      move = numeric::least_squares(held, wanted, start_rank_tolerance).x;
      beside -= held.transpose() * numeric::least_squares(held.transpose(), beside).x;
    }
    const double off = residual(row) - columns.row(row).dot(move);
    const double size = std::abs(residual(row)) + columns.row(row).cwiseAbs().dot(move.cwiseAbs());
    if (beside.norm() <= start_rank_tolerance * columns.row(row).norm() && std::abs(off) > start_tolerance * size)
      return Broken{k, off, std::abs(off) / size};
    before.push_back(k);
  }
  return std::nullopt;
}

/// Moves the unknowns to a minimum of the squares of the residuals (K. Levenberg, Quarterly of Applied Mathematics 2
/// (1944) 164-168), and returns the rows there. It leaves the start a little first, which may be a place of symmetry.
Rows least_violation(StartRows& rows, const StartProblem& problem, std::uint8_t order,
                     const std::vector<std::size_t>& free) {
  constexpr int most_steps = 200;
  constexpr double aside = 1e-2, settled = 1e-12;
  const auto count = static_cast<Eigen::Index>(free.size());
  const auto value = [&](std::size_t i) -> double& { return rows.value({problem.system.free[free[i]], order}); };
  for (std::size_t i = 0; i < free.size(); ++i)
    value(i) += aside * (1 + std::abs(value(i))) / static_cast<double>(i + 1);
  Rows here = rows_at(rows, order, free);
  double damping = 1;
  for (int step = 0; step < most_steps && here.residual.allFinite() && here.A.allFinite(); ++step) {
    MatrixXd J(here.A.rows() + count, count);
    VectorXd r = VectorXd::Zero(J.rows());
    r.head(here.A.rows()) = -here.residual;
    J.topRows(here.A.rows()) = here.A;
    J.bottomRows(count) = std::sqrt(damping) * MatrixXd::Identity(count, count);
    const VectorXd move = numeric::least_squares(J, r).x;
    double size = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const double change = move(static_cast<Eigen::Index>(i));
      size = std::max(size, std::abs(change) / (1 + std::abs(value(i))));
      value(i) += change;
    }
    const Rows there = rows_at(rows, order, free);
    if (there.residual.allFinite() && there.residual.norm() <= here.residual.norm()) {
      here = there;
      damping *= 0.1;
    } else {
      for (std::size_t i = 0; i < free.size(); ++i) value(i) -= move(static_cast<Eigen::Index>(i));
      damping *= 10;
    }
    if (size < settled) break;
  }
  return here;
}

/// The constraints that contradict that of `row`: "'a'" or "'a', 'b'". At the least violation the gradients of those
/// that are violated cancel, each times its violation: no unknown lessens one without another. Empty if there are none.
/// Leaves the unknowns there.
std::string contradicting(const StartProblem& problem, StartRows& rows, std::uint8_t order, Eigen::Index row,
                          const std::vector<std::size_t>& free) {
  // Near the least violation: Levenberg's method approaches it by 1/10 in each of its last steps.
  constexpr double cancelled = 1e-6;
  if (free.empty()) return {};
  const Rows least = least_violation(rows, problem, order, free);
  if (!least.residual.allFinite() || !least.A.allFinite()) return {};
  VectorXd sizes(least.A.rows());
  for (Eigen::Index k = 0; k < sizes.size(); ++k) sizes(k) = std::abs(least.residual(k)) * least.A.row(k).norm();
  const double largest = sizes.maxCoeff();
  if (!(sizes(row) > cancelled * largest) || std::abs(least.residual(row)) <= start_tolerance ||
      (least.A.transpose() * least.residual).norm() > cancelled * largest)
    return {};
  const std::vector<std::size_t>& bound = rows.of_order(order);
  std::string names;
  for (Eigen::Index k = 0; k < sizes.size(); ++k) {
    const std::size_t number = bound[static_cast<std::size_t>(k)];
    if (k == row || number >= rows.first_angular_velocity_row() || sizes(k) <= cancelled * largest) continue;
    const std::string& label = problem.mechanics.constraints[rows.constraint_of(number)].label;
    names += (names.empty() ? "" : ", ") + model::quote(label);
  }
  return names;
}

[[noreturn]] void refuse_angular_velocity(const StartProblem& problem, const StartProblem::AngularVelocity& turn,
                                          double off) {
  throw Error("scene", problem.mechanics.model->where(turn.span),
              fmt::format("no rates give '{}' this angular velocity: a component is off by {:.6g}",
                          problem.mechanics.model->frames[turn.frame].name, off),
              "start away from the singular places of its angles, which `check` lists; leave rates that follow from "
              "it out; its constraints may not allow it");
}

}  // namespace

void refuse_start(const StartProblem& problem, StartRows& rows, std::uint8_t order, std::size_t k,
                  const std::vector<std::size_t>& free) {
  const system::EquationSystem& s = problem.system;
  VectorXd residual;
  MatrixXd A;
  rows.linearise(order, residual, A);
  std::optional<Broken> broken;
  if (order == 1 && !problem.angular_velocities.empty()) broken = first_broken(rows, free);
  if (broken) k = broken->row;
  const auto row = static_cast<Eigen::Index>(k);
  const double off = broken ? broken->off : residual(row);
  const double relative = broken ? broken->relative : rows.relative(residual, A, order, row);
  const std::size_t bound = rows.of_order(order)[k], turns = rows.first_angular_velocity_row();
  if (bound >= turns) refuse_angular_velocity(problem, problem.angular_velocities[(bound - turns) / 3], residual(row));
  const mechanics::Constraint& constraint = problem.mechanics.constraints[rows.constraint_of(bound)];
  std::string given, open;
  model::Span span = problem.scene.span;
  for (std::size_t i = 0; i < s.free.size(); ++i) {
    if (A(row, static_cast<Eigen::Index>(i)) == 0) continue;
    const StartProblem::Key key{s.free[i], order};
    const auto found = problem.given.find(key);
    if (std::find(free.begin(), free.end(), i) != free.end()) {
      open += (open.empty() ? "" : ", ") + rows.label(key);
    } else if (found != problem.given.end()) {
      given += (given.empty() ? "\"" : ", \"") + rows.label(key) + "\"";
      span = found->second.span;
    }
  }
  const bool alone =
      open.find(',') == std::string::npos;  // at most one unknown: no other one could satisfy the constraint
  const std::string others = contradicting(problem, rows, order, row, free);
  const bool approaches = constraint.unilateral && order == 1 && off < 0;
  const std::string remedy =
      approaches
          ? "the contact approaches at the start: begin above its surface, however little, or with a speed that does "
            "not approach"
      : !others.empty()
          ? fmt::format(
                "it contradicts {}: no unknown lessens one without the other; leave out or change one of them{}",
                others, given.empty() ? "" : ", or the values given")
      : alone && !(open.empty() && !given.empty())
          ? fmt::format("{}: check its signs{}, or start the search elsewhere with guess = {{ .. }}",
                        open.empty()
                            ? "its gradient vanishes there: it has no real solution, or only ones where it has no force"
                            : fmt::format("no value of {} was found that meets it: it may have no real solution", open),
                        given.empty() ? "" : " and what is given")
      : !given.empty() && open.empty()
          ? fmt::format("give consistent values, or name what may be moved: solve = [one of {}]", given)
          : fmt::format("the constraint does not fix {} by itself: give all but one of them, or name one in solve",
                        open);
  throw Error("scene", problem.mechanics.model->where(span),
              fmt::format("the start breaks constraint '{}'{}: it is off by {:.6g} (relative {:.3g}, allowed {:.0e})",
                          constraint.label, order == 0 || !constraint.holonomic() ? "" : " in its rates", off, relative,
                          start_tolerance),
              broken ? "give consistent values, or leave out rates that follow from the angular velocity" : remedy);
}

void require_tangents(const StartProblem& problem, const StartRows& rows) {
  const model::Model& model = *problem.mechanics.model;
  const auto refuse = [&](const model::Constraint& constraint) {
    throw Error("scene", model.where(constraint.span),
                fmt::format("the contact '{}' has no tangents at the start: its normal is there along the direction "
                            "that tangent 1 is nearest to, which is 'tangent' or E1",
                            constraint.name),
                "give it a direction that the normal never has: tangent = \"E3\" or \"E2\"");
  };
  const auto is_finite = [&](const std::vector<symbolic::Ref>& refs) {
    const std::vector<double> values = rows.evaluate(refs);
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  for (std::size_t j = 0; j < rows.contacts().size(); ++j) {
    const std::optional<std::uint32_t> body_contact = problem.mechanics.contacts[j].body_contact;
    if (body_contact && !is_finite(rows.contacts()[j].slip)) refuse(model.constraints[*body_contact]);
  }
  for (const std::size_t k : rows.of_order(1)) {
    if (k >= rows.first_angular_velocity_row()) continue;
    const mechanics::Constraint& equation = problem.mechanics.constraints[rows.constraint_of(k)];
    if (equation.holonomic() || is_finite({rows.b()[k]})) continue;
    for (const model::Constraint& constraint : model.constraints) {
      if (constraint.name == equation.name && constraint.rolling) refuse(constraint);
    }
  }
}

}  // namespace eomgen::run
