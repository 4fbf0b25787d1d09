// SPDX-License-Identifier: GPL-3.0-or-later
// Joints: that their points are fixed in the bodies, their reactions, and which of their equations are not needed: those that hold
// identically (planar pins), and those of closed loops that follow from the others. docs/theory.md, "Joints".
#include <cln/rational.h>
#include <fmt/format.h>

#include <algorithm>

#include "mechanics/closure.hpp"
#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/zero_proof.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;

cl_R small(int exponent) { return cl_R(cln::expt(symbolic::Rational(1) / 10, exponent)); }

constexpr int dependent_digits = 20;  // rows in 50 digits, configurations to 38: parts outside the span below this are 0
constexpr double looks_redundant = 1e-4;  // |psi| of an equation that was meant to follow from the others

bool of_joint(const Mechanics& m, std::uint32_t k) {
  const auto within = [k](const JointReaction& j) { return k >= j.first && k < j.first + j.equations(); };
  return std::any_of(m.joints.begin(), m.joints.end(), within);
}

Where where(const Mechanics& m, std::uint32_t k) { return m.model->where(m.model->arena[m.constraints[k].written].span); }

/// Rows of constraints on positions or velocities that always hold, by all coordinates.
struct Bound {
  std::vector<std::uint32_t> constraints;
  std::vector<bool> first;  // never left out: not of joints, or fixes a coordinate
};

Bound bound(const Mechanics& m) {
  Bound result;
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (m.constraints[k].unilateral || m.constraints[k].need == Need::identity) continue;
    const auto fixes = [k](const FixedCoordinate& f) { return f.constraint == k; };
    result.constraints.push_back(k);
    result.first.push_back(!of_joint(m, k) || std::any_of(m.fixed.begin(), m.fixed.end(), fixes));
  }
  return result;
}

std::vector<Row> rows_of(const Closure& closure, const Bound& of, const Configuration& at) {
  const std::vector<Row> all = closure.rows(at);
  std::vector<Row> rows;
  for (const std::uint32_t k : of.constraints) rows.push_back(all[k]);
  return rows;
}

/// Whether the rest lies in the span of what is kept, which is independent, at this configuration too.
bool holds_at(const std::vector<Row>& rows, const Selection& chosen) {
  std::vector<bool> kept(rows.size(), false);
  for (const std::size_t k : chosen.kept) kept[k] = true;
  return select_independent(rows, kept, small(dependent_digits)).kept == chosen.kept;
}

[[noreturn]] void refuse_inexact(const Mechanics& m, const Closure& closure) {
  throw Error("mechanics", where(m, closure.gap_at()),
              fmt::format("equation '{}' looks as if it followed from the other constraints, but is off by {:.2g} where they hold", m.constraints[closure.gap_at()].label, closure.gap()),
              "a loop with redundant joints closes only if the dimensions are exact: write sqrt(3)/2 or cos(pi/6) instead of decimals");
}

[[noreturn]] void refuse_special(const Mechanics& m, std::uint32_t k) {
  throw Error("mechanics", where(m, k), fmt::format("equation '{}' follows from the other constraints for these values of the parameters only", m.constraints[k].label),
              "write what the values have in common: make one parameter an expression of the others, or use one parameter for both");
}

/// A component of a reaction is determined if it is the same for all multipliers with the same forces: orthogonal to the null
/// space of the transposed rows.
void find_determined(Mechanics& m, const Closure& closure, const Configuration& at) {
  const std::vector<Row> rows = closure.rows(at);
  // d is orthogonal to all u with u A = 0 just if it is a combination of the columns of A.
  std::vector<Row> columns(m.q.size(), Row(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < m.q.size(); ++i) columns[i][k] = rows[k][i];
  }
  for (JointReaction& joint : m.joints) {
    for (std::size_t j = 0; j < joint.along.size(); ++j) {
      const std::vector<cl_R> parts = closure.values(joint.along[j], at);
      Row component(rows.size(), cl_R(0));
      std::copy(parts.begin(), parts.end(), component.begin() + joint.first);
      std::vector<Row> with = columns;
      with.push_back(component);
      std::vector<bool> first(with.size(), true);
      first.back() = false;
      const std::vector<std::size_t> kept = select_independent(with, first, small(dependent_digits)).kept;
      if (std::find(kept.begin(), kept.end(), columns.size()) != kept.end()) joint.determined[j] = false;
    }
  }
}

}  // namespace

const char* name(Need need) {
  switch (need) {
    case Need::holds: return "holds";
    case Need::identity: return "identity";
    default: return "redundant";
  }
}

void add_joints(Mechanics& m, Lowering& lower) {
  Dag& dag = *m.dag;
  for (const model::Joint& joint : m.model->joints) {
    for (const model::NodeId stray : joint.stray) {
      if (stray == model::no_node) continue;
      const Vec3 v = lower.vector(stray);
      if (vanishes(dag, {v[0], v[1], v[2]})) continue;
      throw Error("mechanics", m.model->where(m.model->arena[stray].span), "this point of the joint '" + joint.name + "' is not fixed in its body",
                  "make it of the body, its axes and lengths, such as \"B - L/2*B.e1\", or name a [[point]] with on = \"B\"");
    }
    JointReaction reaction;
    const auto own = [&](const Constraint& c) { return c.name == joint.name; };
    reaction.first = static_cast<std::uint32_t>(std::find_if(m.constraints.begin(), m.constraints.end(), own) - m.constraints.begin());
    const std::size_t last = joint.axes == 0 ? 0 : m.model->frames[joint.axes].stages.size() - 1;
    for (std::size_t j = 0; j < reaction.along.size(); ++j) {
      const Vec3 e = lower.axis(joint.axes, last, j % 3);
      for (std::size_t k = 0; k < joint.force.size(); ++k) {
        const model::NodeId of = j < 3 ? joint.force[k] : joint.moment[k];
        reaction.along[j].push_back(of == model::no_node ? dag.zero() : lower.dot(lower.vector(of), e));
        if (m.constraints[reaction.first + k].need == Need::identity && !vanishes(dag, {reaction.along[j].back()})) reaction.determined[j] = false;
      }
    }
    m.joints.push_back(std::move(reaction));
  }
}

bool holds_identically(Dag& dag, Ref psi) { return vanishes(dag, {psi}) || symbolic::is_proven_zero(dag, psi); }

void drop_redundant_joints(Mechanics& m, Lowering& lower) {
  const auto joint = [&](std::uint32_t k) { return of_joint(m, k); };
  const bool repeated = std::any_of(m.constraints.begin(), m.constraints.end(), [](const Constraint& c) { return c.need == Need::redundant; });
  if (!repeated && std::none_of(m.active.begin(), m.active.end(), joint)) return;
  Closure closure(m, lower);
  const std::optional<Configuration> start = closure.start();
  if (!start) {
    if (closure.gap() > 0 && closure.gap() < looks_redundant) refuse_inexact(m, closure);
    return;  // no configuration: the start of a run will tell
  }
  const Bound of = bound(m);
  if (select_independent(rows_of(closure, of, *start), of.first, small(dependent_digits)).rest.empty()) return;
  // The start may be a singular configuration; elsewhere the rank is that of the mechanism.
  std::vector<Configuration> points;
  for (std::uint64_t seed = 1; seed <= 8 && points.size() < 3; ++seed) {
    if (auto found = closure.near(*start, seed, false)) points.push_back(std::move(*found));
  }
  if (points.empty()) return;
  Selection chosen;
  for (const Configuration& at : points) {
    Selection here = select_independent(rows_of(closure, of, at), of.first, small(dependent_digits));
    if (here.kept.size() > chosen.kept.size()) chosen = std::move(here);
  }
  std::erase_if(chosen.rest, [&](std::size_t k) { return of.first[k]; });  // refused elsewhere
  if (chosen.rest.empty()) return;
  std::size_t others = 0;
  for (std::uint64_t seed = 11; seed <= 16 && others < 2; ++seed) {
    const std::optional<Configuration> found = closure.near(*start, seed, true);
    if (!found) continue;
    if (!holds_at(rows_of(closure, of, *found), chosen)) refuse_special(m, of.constraints[chosen.rest.front()]);
    ++others;
  }
  if (others == 0) refuse_special(m, closure.gap() > 0 ? closure.gap_at() : of.constraints[chosen.rest.front()]);
  for (const std::size_t k : chosen.rest) {
    m.constraints[of.constraints[k]].need = Need::redundant;
    std::erase(m.active, of.constraints[k]);
  }
  for (const Configuration& at : points) find_determined(m, closure, at);
}

}  // namespace eomgen::mechanics
