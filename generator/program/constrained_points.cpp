// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/constrained_points.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "numeric/dense.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::program {
namespace {

using symbolic::Dag;
using symbolic::Ref;
using symbolic::Symbol;

constexpr std::size_t max_points = 4;
constexpr std::uint64_t tries = 12;
constexpr int max_steps = 40;
constexpr double difference = 6e-6;       // for central differences: the cube root of epsilon
constexpr double longest_step = 0.5;      // for values between 0.2 and 1.2
constexpr double converged_step = 1e-11;  // differences are accurate to about 1e-10; then two steps reach rounding
constexpr double zero = 1e-11;            // for psi, after a step of that length at slopes of about 1
constexpr double shortest_row = 1e-6;     // relative to the same row at the start of the search

Eigen::VectorXd values(const Dag& dag, const std::vector<Ref>& roots, const Point& at) {
  const std::vector<double> result =
      symbolic::evaluate(dag, roots, [&](const Symbol& s) -> double { return at.at(s); });
  return Eigen::Map<const Eigen::VectorXd>(result.data(), static_cast<Eigen::Index>(result.size()));
}

/// Newton's method with minimum-norm steps; returns nothing if it does not converge.
std::optional<Point> project_onto_constraints(const Dag& dag, const std::vector<Ref>& psi,
                                              const std::vector<Symbol>& moved, Point at) {
  Eigen::MatrixXd J(static_cast<Eigen::Index>(psi.size()), static_cast<Eigen::Index>(moved.size()));
  for (int k = 0; k < max_steps; ++k) {
    const Eigen::VectorXd now = values(dag, psi, at);
    for (std::size_t j = 0; j < moved.size(); ++j) {
      Point up = at, down = at;
      up[moved[j]] += difference;
      down[moved[j]] -= difference;
      J.col(static_cast<Eigen::Index>(j)) = (values(dag, psi, up) - values(dag, psi, down)) / (2 * difference);
    }
    if (!now.allFinite() || !J.allFinite()) return std::nullopt;
    Eigen::VectorXd step = numeric::least_squares(J, -now).x;
    const double length = step.norm();
    if (length > longest_step) step *= longest_step / length;
    for (std::size_t j = 0; j < moved.size(); ++j) at[moved[j]] += step[static_cast<Eigen::Index>(j)];
    if (length > converged_step) continue;
    const Eigen::VectorXd left = values(dag, psi, at);
    if (!left.allFinite() || left.lpNorm<Eigen::Infinity>() > zero) return std::nullopt;
    return at;
  }
  return std::nullopt;
}

/// Whether a length shrank to 0 or the point is a common corner, so that no direction is left to choose.
bool is_degenerate(const Dag& dag, const std::vector<Ref>& A, std::size_t n, const Point& from, const Point& at) {
  const Eigen::VectorXd before = values(dag, A, from), after = values(dag, A, at);
  const auto columns = static_cast<Eigen::Index>(n);
  for (Eigen::Index first = 0; first < after.size(); first += columns) {
    const double length = after.segment(first, columns).norm();
    if (!std::isfinite(length) || length < shortest_row * before.segment(first, columns).norm()) return true;
  }
  return false;
}

}  // namespace

std::vector<Point> points_on_constraints(const system::EquationSystem& s, const std::vector<std::size_t>& rows) {
  const Dag& dag = *s.dag;
  const std::size_t n = s.free.size();
  std::vector<Ref> psi, rows_of_A;
  for (const std::size_t k : rows) {
    if (s.holonomic[k]) psi.push_back(s.psi[k]);
    rows_of_A.insert(rows_of_A.end(), s.A.begin() + static_cast<std::ptrdiff_t>(k * n),
                     s.A.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  }
  if (psi.empty()) return {};
  // Redundant constraints that follow from these still distinguish between branches.
  for (const system::RedundantConstraint& watched : s.redundant) {
    bool of_these = true;
    for (std::size_t i = 0; i < n && of_these; ++i) {
      const auto moves = [&](std::size_t k) { return !dag.is_zero(s.A[k * n + i]); };
      of_these = dag.is_zero(watched.A[i]) || std::any_of(rows.begin(), rows.end(), moves);
    }
    if (of_these) psi.push_back(watched.psi);
  }
  std::vector<Ref> all = rows_of_A;
  all.insert(all.end(), psi.begin(), psi.end());
  const std::vector<Symbol> symbols = dag.symbols(all), any = dag.symbols(psi);
  std::vector<Symbol> coordinates;
  std::copy_if(any.begin(), any.end(), std::back_inserter(coordinates),
               [](const Symbol& symbol) { return symbol.kind == symbolic::SymbolKind::coordinate; });
  std::vector<Point> result;
  for (std::uint64_t point = 1; point <= tries && result.size() < max_points; ++point) {
    Point from;
    for (const Symbol& symbol : symbols) from[symbol] = symbolic::sample_double(symbol, point);
    for (const auto* moved : {&std::as_const(coordinates), &any}) {
      std::optional<Point> at = project_onto_constraints(dag, psi, *moved, from);
      if (!at || is_degenerate(dag, rows_of_A, n, from, *at)) continue;
      result.push_back(std::move(*at));
      break;
    }
  }
  return result;
}

}  // namespace eomgen::program
