// SPDX-License-Identifier: GPL-3.0-or-later
// Equations of closed loops, by joints or [[constraint]]s, that are redundant where all hold but independent in the
// neighbourhood. docs/theory.md, "Dependent constraints".
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lists.hpp"
#include "mechanics/closure.hpp"
#include "mechanics/small.hpp"
#include "mechanics/stages.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;

constexpr int dependent_digits = 20;  // rows have 50 digits, configurations 38: smaller parts outside the span are 0
constexpr double looks_redundant = 1e-4;  // |psi| of an equation that was meant to be redundant

bool of_joint(const Mechanics& m, std::uint32_t k) { return model_constraint(m, m.constraints[k]).joint.has_value(); }

bool fixes(const Mechanics& m, std::uint32_t k) {
  return std::any_of(m.fixed.begin(), m.fixed.end(), [k](const FixedCoordinate& f) { return f.constraint == k; });
}

bool has_friction(const Mechanics& m, std::uint32_t k) {
  return std::any_of(m.contacts.begin(), m.contacts.end(), [k](const Contact& c) {
    return std::find(c.constraints.begin(), c.constraints.end(), k) != c.constraints.end();
  });
}

SourceLocation where(const Mechanics& m, std::uint32_t k) {
  return m.model->where(m.model->arena[m.constraints[k].model_expression].span);
}

/// Rows of holonomic and velocity constraints that always hold, for all coordinates.
struct ConstraintRows {
  std::vector<std::uint32_t> constraints;
  std::vector<RowPriority>
      priorities;  // joints are dropped first; constraints with friction or that fix a coordinate never
};

ConstraintRows constraint_rows(const Mechanics& m) {
  ConstraintRows result;
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (m.constraints[k].unilateral || !m.is_independent(k)) continue;
    result.constraints.push_back(k);
    result.priorities.push_back(fixes(m, k) || has_friction(m, k) ? RowPriority::always
                                : of_joint(m, k)                  ? RowPriority::last
                                                                  : RowPriority::first);
  }
  return result;
}

std::vector<Row> rows_of(const ClosureSolver& closure, const ConstraintRows& of, const Configuration& at) {
  const std::vector<Row> all = closure.jacobian_rows(at);
  return mapped(of.constraints, [&](std::uint32_t k) { return all[k]; });
}

/// Whether the other rows lie in the span of the selected rows, which are independent, at this configuration too.
bool holds_at(const std::vector<Row>& rows, const RowSelection& chosen) {
  std::vector<RowPriority> priorities(rows.size(), RowPriority::last);
  for (const std::size_t k : chosen.selected) priorities[k] = RowPriority::always;
  return select_independent(rows, priorities, small(dependent_digits)).selected == chosen.selected;
}

[[noreturn]] void throw_inexact(const Mechanics& m, const ClosureSolver& closure) {
  throw Error(
      "mechanics", where(m, closure.inconsistent_constraint()),
      fmt::format("equation '{}' seems to follow from the other constraints, but is off by {:.2g} where they hold",
                  m.constraints[closure.inconsistent_constraint()].label, closure.inconsistency()),
      "a loop with redundant joints closes only if the dimensions are exact: write sqrt(3)/2 or cos(pi/6) instead of "
      "decimals");
}

[[noreturn]] void throw_special_parameters(const Mechanics& m, std::uint32_t k) {
  throw Error("mechanics", where(m, k),
              fmt::format("equation '{}' follows from the other constraints for these values of the parameters only",
                          m.constraints[k].label),
              "state how the values are related: make one parameter an expression of the others, or use one "
              "parameter for both");
}

[[noreturn]] void throw_no_configuration(const Mechanics& m, const ClosureSolver& closure) {
  const bool known = closure.inconsistency() > 0;
  const std::uint32_t k = known ? closure.inconsistent_constraint() : m.active.back();
  throw Error(
      "mechanics", where(m, k),
      fmt::format("there are more constraints than coordinates, and no configuration is found in which all hold{}",
                  known ? fmt::format(": '{}' is off by {:.2g} where the others do", m.constraints[k].label,
                                      closure.inconsistency())
                        : ""),
      "give the default scene a start or a `guess` near one, if constraints repeat one another; else remove one");
}

/// Prescribed motion must be the same in all equations that repeat one another.
void require_same_rates(const Mechanics& m, const ClosureSolver& closure, const ConstraintRows& of,
                        const RowSelection& chosen, const Configuration& at) {
  std::vector<Row> rows = rows_of(closure, of, at);
  const std::vector<cl_R> rates = closure.rates(at);
  std::vector<RowPriority> priorities(rows.size(), RowPriority::last);
  for (const std::size_t k : chosen.selected) priorities[k] = RowPriority::always;
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].push_back(rates[of.constraints[k]]);
  for (const std::size_t k : select_independent(rows, priorities, small(dependent_digits)).selected) {
    if (std::find(chosen.selected.begin(), chosen.selected.end(), k) != chosen.selected.end()) continue;
    const std::uint32_t constraint = of.constraints[k];
    throw Error(
        "mechanics", where(m, constraint),
        fmt::format(
            "constraint '{}' contradicts the others: its velocities are a combination of theirs, the rest is not",
            m.constraints[constraint].label),
        "remove one of them: no motion satisfies them all");
  }
}

/// Whether d . u is the same for all multipliers u with the same forces, so that d is a combination of the columns of
/// A.
class DeterminacyTest {
 public:
  DeterminacyTest(const std::vector<Row>& rows, std::size_t coordinates) {
    for (std::size_t i = 0; i < coordinates; ++i) {
      Row column;
      for (const Row& row : rows) column.push_back(row[i]);
      const cl_R size = length(column);
      Row left = orthogonal_part(orthogonal_part(column));  // twice, for accuracy
      const cl_R rest = length(left);
      if (cln::zerop(size) || rest < size * small(dependent_digits)) continue;
      for (cl_R& x : left) x = x / rest;
      basis_.push_back(std::move(left));
    }
  }
  bool operator()(const Row& component) const {
    const cl_R size = length(component);
    // Entries are directions and lever arms. Entries this many digits smaller are zeros of a configuration that was
    // computed numerically.
    return size < small(dependent_digits) || length(orthogonal_part(component)) < size * small(dependent_digits);
  }

 private:
  static cl_R length(const Row& row) {
    cl_R square = 0;
    for (const cl_R& x : row) square = square + x * x;
    return cln::sqrt(square);
  }
  Row orthogonal_part(Row row) const {
    for (const Row& e : basis_) {
      cl_R part = 0;
      for (std::size_t i = 0; i < row.size(); ++i) part = part + e[i] * row[i];
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = row[i] - part * e[i];
    }
    return row;
  }

  std::vector<Row> basis_;  // orthonormal
};

void find_determined(Mechanics& m, const ClosureSolver& closure, const Configuration& at) {
  const std::vector<Row> rows = closure.jacobian_rows(at);
  const DeterminacyTest determined(rows, m.q.size());
  for (JointReaction& joint : m.joints) {
    for (std::size_t j = 0; j < joint.along.size(); ++j) {
      const std::vector<cl_R> parts = closure.values(joint.along[j], at);
      Row component(rows.size(), cl_R(0));
      std::copy(parts.begin(), parts.end(), component.begin() + joint.first);
      if (joint.determined[j] && !determined(component)) joint.determined[j] = false;
    }
  }
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (!m.constraints[k].determined) continue;
    Row unit(rows.size(), cl_R(0));
    unit[k] = cl_R(1);
    m.constraints[k].determined = determined(unit);
  }
}

/// Friction needs a determined normal force.
void require_normal_forces(const Mechanics& m) {
  for (const Contact& contact : m.contacts) {
    for (const std::uint32_t k : contact.constraints) {
      if (m.constraints[k].determined) continue;
      throw Error("mechanics", where(m, k),
                  fmt::format("the motion does not determine the force of '{}', and its contact needs it",
                              m.constraints[k].label),
                  "remove the constraints that repeat it, or give the bodies coordinates that let them separate");
    }
  }
}

bool is_repeated(const Constraint& c) { return c.redundancy == Redundancy::redundant; }

/// Configurations near the start. The start itself may be singular; the rank elsewhere is that of the mechanism.
std::vector<Configuration> nearby_configurations(ClosureSolver& closure, const Configuration& start) {
  std::vector<Configuration> points;
  for (std::uint64_t seed = 1; seed <= 8 && points.size() < 3; ++seed) {
    if (auto found = closure.nearby_configuration(start, seed, false)) points.push_back(std::move(*found));
  }
  return points;
}

/// Configurations along the motion from the start, in both directions: once around a loop.
std::vector<Configuration> along_motion(ClosureSolver& closure, const Configuration& start,
                                        const Configuration& beside) {
  constexpr int strides = 14;
  std::vector<Configuration> way;
  for (const auto& [from, to] : {std::pair{start, beside}, std::pair{beside, start}}) {
    Configuration before = from, at = to;
    for (int k = 0; k < strides; ++k) {
      std::optional<Configuration> next = closure.extrapolated_configuration(before, at);
      if (!next) break;
      before = std::move(at);
      at = *next;
      way.push_back(std::move(*next));
    }
  }
  return way;
}

/// The volume that these rows span, each in units of its typical length.
double volume(const std::vector<Row>& rows, const std::vector<double>& usual, const std::vector<std::size_t>& of) {
  double result = 1;
  std::vector<std::vector<double>> basis;
  for (const std::size_t k : of) {
    std::vector<double> left = mapped(rows[k], [&](const cl_R& x) { return cln::double_approx(x) / usual[k]; });
    for (const std::vector<double>& e : basis) {
      const double part = std::inner_product(e.begin(), e.end(), left.begin(), 0.0);
      for (std::size_t i = 0; i < left.size(); ++i) left[i] -= part * e[i];
    }
    const double length = std::sqrt(std::inner_product(left.begin(), left.end(), left.begin(), 0.0));
    if (length == 0) return 0;
    for (double& x : left) x /= length;
    basis.push_back(std::move(left));
    result *= length;
  }
  return result;
}

/// An equation chosen at the start may become trivial at a configuration on the way (a length between aligned bars)
/// where one of the dropped equations is not. The two are exchanged.
void exchange_along_motion(const ConstraintRows& of, const std::vector<std::vector<Row>>& way, RowSelection& chosen) {
  constexpr double nearly_nothing = 0.2, plainly_better = 3;
  std::vector<double> usual(of.constraints.size(), 0);
  for (const std::vector<Row>& rows : way) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      double square = 0;
      for (const cl_R& x : rows[k]) square += std::pow(cln::double_approx(x), 2);
      usual[k] = std::max(usual[k], std::sqrt(square));
    }
  }
  for (std::size_t turn = 0; turn < of.constraints.size(); ++turn) {
    std::vector<RowSelection> candidates{chosen};
    for (std::size_t i = 0; i < chosen.selected.size(); ++i) {
      for (std::size_t j = 0; j < chosen.rest.size(); ++j) {
        const RowPriority own = of.priorities[chosen.selected[i]];
        if (own == RowPriority::always || own != of.priorities[chosen.rest[j]] || usual[chosen.rest[j]] == 0) continue;
        RowSelection other = chosen;
        std::swap(other.selected[i], other.rest[j]);
        candidates.push_back(std::move(other));
      }
    }
    if (candidates.size() == 1) return;
    std::vector<double> worst(candidates.size(), 1);
    for (const std::vector<Row>& rows : way) {
      std::vector<double> here;
      for (const RowSelection& candidate : candidates) here.push_back(volume(rows, usual, candidate.selected));
      const double best = *std::max_element(here.begin(), here.end());
      for (std::size_t c = 0; c < candidates.size() && best > 0; ++c) worst[c] = std::min(worst[c], here[c] / best);
    }
    const std::size_t best = static_cast<std::size_t>(std::max_element(worst.begin(), worst.end()) - worst.begin());
    if (worst[0] > nearly_nothing || worst[best] < plainly_better * worst[0]) return;
    chosen = candidates[best];
    std::sort(chosen.selected.begin(), chosen.selected.end());
    std::sort(chosen.rest.begin(), chosen.rest.end());
  }
}

// Drops the equations of a loop that are redundant at every configuration and for all parameters.
void drop_redundant_at(Mechanics& m, ClosureSolver& closure, const Configuration& start,
                       const std::vector<Configuration>& points) {
  const ConstraintRows of = constraint_rows(m);
  RowSelection chosen;
  for (const Configuration& at : points) {
    RowSelection here = select_independent(rows_of(closure, of, at), of.priorities, small(dependent_digits));
    if (here.selected.size() > chosen.selected.size()) chosen = std::move(here);
  }
  // Rows that are independent around the start may be dependent at it, while the same number of others is independent.
  const std::vector<Row> at_start = rows_of(closure, of, start);
  const RowSelection there = select_independent(at_start, of.priorities, small(dependent_digits));
  if (there.selected.size() == chosen.selected.size() && !holds_at(at_start, chosen)) chosen = there;
  std::erase_if(chosen.rest, [&](std::size_t k) {
    return of.priorities[k] == RowPriority::always;
  });  // the start of a run reports it
  if (chosen.rest.empty()) return;
  std::vector<std::vector<Row>> way;
  for (const std::vector<Configuration>& some :
       {std::vector{start}, points, along_motion(closure, start, points.front())}) {
    for (const Configuration& at : some) way.push_back(rows_of(closure, of, at));
  }
  exchange_along_motion(of, way, chosen);
  std::size_t others = 0;
  for (std::uint64_t seed = 11; seed <= 16 && others < 2; ++seed) {
    const std::optional<Configuration> found = closure.nearby_configuration(start, seed, true);
    if (!found) continue;
    if (!holds_at(rows_of(closure, of, *found), chosen))
      throw_special_parameters(m, of.constraints[chosen.rest.front()]);
    ++others;
  }
  if (others == 0)
    throw_special_parameters(
        m, closure.inconsistency() > 0 ? closure.inconsistent_constraint() : of.constraints[chosen.rest.front()]);
  for (const Configuration& at : points) require_same_rates(m, closure, of, chosen, at);
  for (const std::size_t k : chosen.rest) {
    m.constraints[of.constraints[k]].redundancy = Redundancy::redundant;
    std::erase(m.active, of.constraints[k]);
  }
}

bool is_regular_at(const Mechanics& m, const ClosureSolver& closure, const Configuration& start) {
  const ConstraintRows of = constraint_rows(m);
  return select_independent(rows_of(closure, of, start), of.priorities, small(dependent_digits)).rest.empty();
}

}  // namespace

void drop_dependent_equations(Mechanics& m, Lowering& lower) {
  const bool repeated = std::any_of(m.constraints.begin(), m.constraints.end(), is_repeated);
  const bool joints = std::any_of(m.active.begin(), m.active.end(), [&](std::uint32_t k) { return of_joint(m, k); });
  if (!repeated && !joints && m.active.size() < 2) return;
  ClosureSolver closure(m, lower);
  if (!repeated && !joints && closure.is_regular()) return;
  const std::optional<Configuration> start = closure.start_configuration();
  if (!start) {
    const bool exact = joints || m.degrees_of_freedom() <= 0;
    if (exact && closure.inconsistency() > 0 && closure.inconsistency() < looks_redundant) throw_inexact(m, closure);
    if (m.degrees_of_freedom() < 0) throw_no_configuration(m, closure);
    return;  // no configuration: the start of a run reports it
  }
  const bool regular = is_regular_at(m, closure, *start);
  if (regular && !repeated) return;
  const std::vector<Configuration> points = nearby_configurations(closure, *start);
  if (points.empty()) return;
  if (!regular) drop_redundant_at(m, closure, *start, points);
  if (std::none_of(m.constraints.begin(), m.constraints.end(), is_repeated)) return;
  for (const Configuration& at : points) find_determined(m, closure, at);
  require_normal_forces(m);
}

}  // namespace eomgen::mechanics
