// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/newton.hpp"

#include <algorithm>
#include <eom/layout.hpp>
#include <utility>

#include "numeric/dense.hpp"

namespace eomgen::linear {
namespace {

constexpr int most_steps = 80;
constexpr double longest_step = 0.7;  // of an entry, relative to 1 and its magnitude
constexpr double settled = 1e-11;
constexpr double most_residual = 1e-3;  // of scaled equations at a root, also at a multiple one
constexpr double turning = 0.5;         // of the last step: a step back over more does not converge
constexpr double opposite = 0.99;       // cosine
constexpr int most_halvings = 5, most_restorations = 40;
constexpr double restored = 1e-9;  // of the last step: the error is its square
constexpr double rank_tolerance = 1e-9;
constexpr double least_row = 1e-6;           // relative to the largest derivative
constexpr std::size_t plain_attitudes = 81;  // Euler parameters of -1, 0, 1

struct Equations {
  std::vector<double> value;
  std::vector<std::vector<double>> jacobian;  // rows
};

void add(Equations& e, const Matrix<double>& value, const Matrix<double>& jacobian, std::size_t row) {
  e.value.push_back(value(row, 0));
  const auto begin = jacobian.a.begin() + static_cast<std::ptrdiff_t>(row * jacobian.cols);
  e.jacobian.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(jacobian.cols) - 1);
}

Equations equations(const Flow& flow, const Symmetry& symmetry, const State<double>& z, const State<double>& start,
                    const Setting<double>& setting, const HeldQuantities& held, const std::vector<double>& targets,
                    SteadyEquations kind) {
  const Field<double> field = flow.at(z, setting);
  Equations e;
  for (std::size_t i = 0; i < field.phi.rows; ++i) add(e, field.phi, field.phi_jacobian, i);
  const std::size_t n = flow.coordinates();
  const auto& constant = symmetry.constant;
  const eom::StateLayout layout{n};
  const auto accelerations =
      std::count_if(constant.begin(), constant.end(), [layout](std::size_t i) { return layout.is_rate(i); });
  const bool all = kind == SteadyEquations::inertia_forces && static_cast<std::size_t>(accelerations) == n;
  for (const std::size_t i : constant) {
    if (!layout.is_rate(i) || !all)
      add(e, field.X, field.jacobian, i);
    else
      add(e, field.inertia_force, field.inertia_force_jacobian, i - n);
  }
  for (const std::size_t i : ignorable_entries(symmetry)) {
    e.value.push_back(z[i] - start[i]);
    e.jacobian.emplace_back(z.size() - 1, 0.0);
    e.jacobian.back()[i] = 1;
  }
  if (targets.empty()) return e;
  const ValueAndJacobian<double> quantities = held.at(z, setting);
  for (std::size_t k = 0; k < targets.size(); ++k) {
    e.value.push_back(quantities.value[k] - targets[k]);
    const auto begin = quantities.jacobian.a.begin() + static_cast<std::ptrdiff_t>(k * quantities.jacobian.cols);
    e.jacobian.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(quantities.jacobian.cols) - 1);
  }
  return e;
}

/// `open`: directions are left along which no derivative is known to differ from 0. `residual`: what the step leaves of
/// the scaled equations.
struct NewtonStep {
  Eigen::VectorXd move;
  bool open;
  double residual;
};

/// The least-norm step, with entries relative to 1 and their magnitude, and rows relative to their largest derivative.
/// A row that nearly vanishes compared with the others is ignored, since scaling would amplify its rounding.
std::optional<NewtonStep> step(const Equations& e, const State<double>& z) {
  const auto rows = static_cast<Eigen::Index>(e.value.size()), columns = static_cast<Eigen::Index>(z.size() - 1);
  Eigen::MatrixXd J(rows, columns);
  Eigen::VectorXd r(rows), scale(columns);
  for (Eigen::Index j = 0; j < columns; ++j) scale(j) = 1 + std::abs(z[static_cast<std::size_t>(j)]);
  for (Eigen::Index i = 0; i < rows; ++i) {
    r(i) = e.value[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < columns; ++j)
      J(i, j) = e.jacobian[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * scale(j);
  }
  const double least = least_row * (rows > 0 ? J.cwiseAbs().maxCoeff() : 0);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double size = std::max(J.row(i).cwiseAbs().maxCoeff(), least);
    if (size > 0) {
      J.row(i) /= size;
      r(i) /= size;
    }
  }
  if (!J.allFinite() || !r.allFinite()) return std::nullopt;
  numeric::LeastSquares found = numeric::least_squares(J, r, rank_tolerance);
  const double residual = rows > 0 ? (r - J * found.x).cwiseAbs().maxCoeff() : 0;
  return NewtonStep{std::move(found.x), found.rank < columns, residual};
}

/// Moves z onto the constraints by least-norm steps. Leaves z as it is if they do not get there. Off the constraints, a
/// closed loop has accelerations that are not determined.
void restore_constraints(const Flow& flow, State<double>& z, const Setting<double>& setting) {
  State<double> moved = z;
  for (int k = 0; k < most_restorations; ++k) {
    const Field<double> field = flow.constraints_at(moved, setting);
    if (field.phi.rows == 0) return;
    Equations e;
    for (std::size_t i = 0; i < field.phi.rows; ++i) add(e, field.phi, field.phi_jacobian, i);
    const auto taken = step(e, moved);
    if (!taken || !taken->move.allFinite()) return;
    const Eigen::VectorXd& move = taken->move;
    const double size = move.cwiseAbs().maxCoeff(), factor = std::min(1.0, longest_step / size);
    for (std::size_t i = 0; i + 1 < moved.size(); ++i)
      moved[i] -= factor * move(static_cast<Eigen::Index>(i)) * (1 + std::abs(moved[i]));
    if (size > restored) continue;
    z = std::move(moved);
    return;
  }
}

/// Whether a Newton step of the accelerations is short. Throws std::domain_error if they have no values at z.
bool is_near_root(const Flow& flow, const Symmetry& symmetry, const State<double>& z, const Setting<double>& setting,
                  const HeldQuantities& held, const std::vector<double>& targets, double nearness) {
  const auto taken = step(equations(flow, symmetry, z, z, setting, held, targets, SteadyEquations::accelerations), z);
  return taken && taken->move.allFinite() && taken->move.cwiseAbs().maxCoeff() < nearness &&
         taken->residual < most_residual;
}

/// The same after a search with inertia forces. They vanish for some accelerations where the coordinates are singular,
/// as beside the pole of Euler angles.
bool has_small_accelerations(const Flow& flow, const Symmetry& symmetry, const State<double>& z,
                             const Setting<double>& setting, const HeldQuantities& held,
                             const std::vector<double>& targets) {
  constexpr double nearness = 0.1;  // beside a multiple root, or where rounding is amplified
  try {
    return is_near_root(flow, symmetry, z, setting, held, targets, nearness);
  } catch (const std::domain_error&) {  // the search in many digits gives the reason
    return true;
  }
}

// All combinations of -1, 0, 1 first: they include the rotations that map axes to axes. Then random ones.
void set_attitude(const SearchRequest& request, const std::array<std::size_t, 4>& e, std::size_t k, State<double>& z) {
  std::size_t code = k;
  bool any = false;
  for (std::size_t j = 0; j < 4; ++j, code /= 3) {
    z[e[j]] = static_cast<double>(code % 3) - 1;
    any = any || code % 3 != 1;
  }
  if (code == 0 && any) return;
  for (std::size_t j = 0; j < 4; ++j) z[e[j]] = random_number(request.seed + 60000, 64 * k + e[j]);
}

}  // namespace

// With m the product of 1 + 1/d_k^2 and the Newton step -J^-1 F = -s, the step of m F is -s/(1 + s . grad m/m).
double KnownPoints::step_factor(const State<double>& z, const Eigen::VectorXd& scaled_step) const {
  double along = 0;  // s . grad m / m
  for (const State<double>& point : points) {
    double distance = 0, rate = 0;  // of the square of the distance, along s
    for (std::size_t i = 0; i + 1 < z.size(); ++i) {
      const double s = scaled_step(static_cast<Eigen::Index>(i)) * (1 + std::abs(z[i])), offset = z[i] - point[i];
      if (i < turns.size() && turns[i]) {
        distance += 2 - 2 * std::cos(offset);
        rate += 2 * std::sin(offset) * s;
      } else {
        distance += offset * offset;
        rate += 2 * offset * s;
      }
    }
    along -= rate / (distance * (1 + distance));
  }
  return 1 / (1 + along);
}

RoughSolution rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& start,
                                 const Setting<double>& setting, const HeldQuantities& held,
                                 const std::vector<double>& targets, SteadyEquations kind, const KnownPoints& known) {
  RoughSolution end{start, false, false, {}};
  State<double>& z = end.z;
  const auto at = [&](const State<double>& point) {
    return equations(flow, symmetry, point, start, setting, held, targets, kind);
  };
  try {
    restore_constraints(flow, z, setting);
    Equations here = at(z);
    // A step that turns back has gone over a root, as in a narrow well such as sqrt(x^2 + 1e-12): then steps are
    // halved.
    Eigen::VectorXd last;
    double longest = longest_step;
    for (int k = 0; k < most_steps; ++k) {
      auto taken = step(here, z);
      if (!taken || !taken->move.allFinite()) return end;
      end.is_slope_missing = taken->open;
      Eigen::VectorXd& move = taken->move;
      move *= known.step_factor(z, move);
      if (!move.allFinite()) return end;
      const double size = move.cwiseAbs().maxCoeff();
      // A minimum of the sum of squares that is no root: steps are short, and the equations stay open.
      if (size < settled && taken->residual > most_residual) return end;
      if (last.size() > 0 && size > turning * last.cwiseAbs().maxCoeff() &&
          move.dot(last) < -opposite * move.norm() * last.norm())
        longest = std::min(longest, last.cwiseAbs().maxCoeff() / 2);
      double factor = std::min(1.0, longest / size);
      last = factor * move;
      for (int halving = 0;; ++halving, factor /= 2) {
        State<double> next = z;
        for (std::size_t i = 0; i + 1 < z.size(); ++i)
          next[i] -= factor * move(static_cast<Eigen::Index>(i)) * (1 + std::abs(z[i]));
        try {
          if (size >= settled) restore_constraints(flow, next, setting);
          here = at(next);
        } catch (const std::domain_error&) {  // no value there: a shorter step
          if (halving == most_halvings) throw;
          continue;
        }
        z = std::move(next);
        break;
      }
      if (size >= settled) continue;
      end.found =
          kind == SteadyEquations::accelerations || has_small_accelerations(flow, symmetry, z, setting, held, targets);
      return end;
    }
  } catch (const std::domain_error& error) {
    end.reason = error.what();
  }
  return end;
}

bool is_rough_steady_state(const Flow& flow, const Symmetry& symmetry, const State<double>& z,
                           const Setting<double>& setting, const HeldQuantities& held,
                           const std::vector<double>& targets) {
  constexpr double nearness = 1e-8;
  try {
    return is_near_root(flow, symmetry, z, setting, held, targets, nearness);
  } catch (const std::domain_error&) {
    return false;
  }
}

State<double> spread_start(const SearchRequest& request, const Symmetry& symmetry, const std::vector<bool>& turns,
                           std::size_t k) {
  const std::size_t n = request.flow.coordinates();
  State<double> z;
  for (const Precise& x : request.start) z.push_back(to_double(x));
  if (k == 0) return z;
  double fastest = 1;
  const eom::StateLayout layout{n};
  for (std::size_t i = n; i < layout.first_order_begin(); ++i) fastest = std::max(fastest, std::abs(z[i]));
  const std::size_t entries = request.flow.entries();
  std::vector<bool> kept(entries, false), ignored(entries, false);
  for (const std::size_t i : symmetry.constant) kept[i] = true;
  for (const std::size_t i : ignorable_entries(symmetry)) ignored[i] = true;
  constexpr double pi = 3.14159265358979323846;
  const bool attitudes_only = !request.euler_parameters.empty() && k < plain_attitudes;
  for (std::size_t i = 0; i < entries; ++i) {
    const double r = random_number(request.seed + 50000, 64 * k + i);
    if (i >= layout.first_order_begin()) {
      if (!ignored[i] && !attitudes_only) z[i] += (1 + std::abs(z[i])) * 2 * r;
      continue;
    }
    if (i >= n) {
      // Entries that are constant in a steady motion have zero rates.
      z[i] = kept[i - n] ? 0 : attitudes_only ? z[i] : std::abs(z[i]) > 0 ? z[i] * (1 + 1.5 * r) : fastest * r;
      continue;
    }
    if (ignored[i] || attitudes_only) continue;
    const Range& range = request.ranges[i];
    const bool below = std::isfinite(range.lower), above = std::isfinite(range.upper);
    if (below && above)
      z[i] = range.lower + (range.upper - range.lower) * (0.5 + 0.49 * r);
    else if (turns[i])
      z[i] = pi * r;
    else if (below)
      z[i] = range.lower + (z[i] - range.lower) * std::exp(r);
    else
      z[i] += (1 + std::abs(z[i])) * 2 * r;
  }
  for (const auto& e : request.euler_parameters) set_attitude(request, e, k, z);
  return z;
}

}  // namespace eomgen::linear
