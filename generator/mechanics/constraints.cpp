// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints: gradients of psi and coefficients of velocities, and the elimination of coordinates that a constraint
// fixes.
#include <cln/float.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/dag.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::mechanics {

using symbolic::Ref;
using symbolic::Symbol;

namespace {

// Constraints written as a square or a higher power, expanded or not. Their gradient vanishes where they hold, so no
// force along it could enforce them. The test is numerical and does not take the expression apart.

enum class Convergence { none, regular, multiple };

// At a root of multiplicity k, a Newton step reduces psi by the factor (1 - 1/k)^k: 1/4 for a square, 1/e at most.
// Convergence to a simple root is quadratic.
constexpr double least_left = 0.2, most_left = 0.4;
constexpr int in_a_row = 12, most_steps = 40;

/// Newton's method in many digits, along the gradient.
class NewtonPath {
 public:
  NewtonPath(const symbolic::Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& of,
             const std::map<Symbol, double>& from, std::uint64_t point)
      : dag_(dag), roots_(roots), of_(of), point_(point) {
    for (const auto& [symbol, value] : from) q_.emplace(symbol, cln::cl_float(numeric::exact(value), format_));
  }

  /// Whether the path ends at a root of which both psi and the gradient vanish. At a root of multiplicity k the steps
  /// shrink by the factor 1 - 1/k, and k times the step converges quadratically. Values that shrink with steps of one
  /// length, as those of exp far from a root, indicate none.
  bool ends_at_multiple_root() {
    evaluate();
    const cln::cl_F least = scaled(size_, tiny), least_gradient = scaled(gradient_, small);
    for (int trial = 0; trial < most_trials; ++trial) {
      if (size_ <= least && gradient_ <= least_gradient) return true;
      if (cln::zerop(size_) || cln::zerop(gradient_)) return cln::zerop(size_) && gradient_ <= least_gradient;
      const std::map<Symbol, cln::cl_F> before = q_;
      const cln::cl_F step = move(cln::cl_float(1, format_));
      evaluate();
      if (cln::zerop(size_) || cln::zerop(gradient_)) return cln::zerop(size_) && gradient_ <= least_gradient;
      const cln::cl_F shrinks = size_ / gradient_ / step;
      if (!(shrinks < most_shrinking)) return false;
      q_ = before;
      evaluate();
      move(cln::recip(cln::cl_float(1, format_) - shrinks));
      evaluate();
    }
    return false;
  }

 private:
  static constexpr int digits = 60, most_trials = 12;
  static constexpr double tiny = 1e-40, small = 1e-10;
  static constexpr double most_shrinking = 0.995;  // multiplicity 200

  cln::cl_F scaled(const cln::cl_F& x, double factor) const {
    return x * cln::cl_float(numeric::exact(factor), format_);
  }

  /// |psi|, and the length of its gradient.
  void evaluate() {
    values_.clear();
    const auto at = [&](const Symbol& symbol) -> cln::cl_R {
      const auto found = q_.find(symbol);
      return found == q_.end() ? cln::cl_R(symbolic::sample(symbol, point_)) : cln::cl_R(found->second);
    };
    for (const cln::cl_R& value : symbolic::evaluate(dag_, roots_, at, digits))
      values_.push_back(cln::cl_float(value, format_));
    cln::cl_F square = cln::cl_float(0, format_);
    for (std::size_t i = 1; i < values_.size(); ++i) square = square + values_[i] * values_[i];
    size_ = cln::abs(values_[0]);
    gradient_ = cln::sqrt(square);
  }

  /// Moves by a multiple of Newton's step; returns the length of the step itself.
  cln::cl_F move(const cln::cl_F& factor) {
    const cln::cl_F scale = values_[0] / (gradient_ * gradient_);
    for (std::size_t i = 0; i < of_.size(); ++i) {
      cln::cl_F& q = q_.at(of_[i]);
      q = q - factor * scale * values_[i + 1];
    }
    return size_ / gradient_;
  }

  const symbolic::Dag& dag_;
  const std::vector<Ref>& roots_;  // psi and its gradient
  const std::vector<Symbol>& of_;
  std::uint64_t point_;
  cln::float_format_t format_ = cln::float_format(digits);
  std::map<Symbol, cln::cl_F> q_;
  std::vector<cln::cl_F> values_;
  cln::cl_F size_ = cln::cl_float(0, format_), gradient_ = size_;
};

Convergence convergence(const symbolic::Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& of,
                        std::uint64_t point) try {
  std::map<Symbol, double> q;
  for (const Symbol& symbol : of) q[symbol] = symbolic::sample_double(symbol, point);
  const std::function<double(const Symbol&)> at = [&](const Symbol& symbol) {
    const auto found = q.find(symbol);
    return found == q.end() ? symbolic::sample_double(symbol, point) : found->second;
  };
  double before = 0, first = 0;
  int row = 0;
  for (int step = 0; step < most_steps; ++step) {
    const std::vector<double> value = symbolic::evaluate(dag, roots, at);
    double square = 0;
    for (std::size_t i = 0; i < of.size(); ++i) square += value[i + 1] * value[i + 1];
    const double size = std::fabs(value[0]);
    if (!std::isfinite(size) || !std::isfinite(square)) return Convergence::none;
    if (step == 0) first = size;
    const double left = size / before;
    row = step > 0 && left > least_left && left < most_left ? row + 1 : 0;
    if (row >= in_a_row) {
      const bool multiple = NewtonPath(dag, roots, of, q, point).ends_at_multiple_root();
      return multiple ? Convergence::multiple : Convergence::none;
    }
    if (size <= 1e-12 * first) return Convergence::regular;
    if (square == 0) return Convergence::none;
    for (std::size_t i = 0; i < of.size(); ++i) q[of[i]] -= value[0] * value[i + 1] / square;
    before = size;
  }
  return Convergence::none;
} catch (const std::domain_error&) {  // a function has no value on the way
  return Convergence::none;
}

/// Runs Newton's method from a few points along the gradient with respect to the coordinates `of`. If all iterations
/// that approach psi = 0 converge only linearly, the roots are multiple. False if no iteration approaches psi = 0.
bool is_degenerate(const symbolic::Dag& dag, Ref psi, const std::vector<Symbol>& of, const std::vector<Ref>& gradient) {
  std::vector<Ref> roots{psi};
  roots.insert(roots.end(), gradient.begin(), gradient.end());
  bool multiple = false;
  for (std::uint64_t point = 1; point <= 4; ++point) {
    const Convergence found = convergence(dag, roots, of, point);
    if (found == Convergence::regular) return false;
    multiple = multiple || found == Convergence::multiple;
  }
  return multiple;
}

std::set<std::uint32_t> coordinates_in(const Dag& dag, Ref expression) {
  std::set<std::uint32_t> result;
  for (const Symbol& symbol : dag.symbols({expression})) {
    if (symbol.kind == SymbolKind::coordinate) result.insert(symbol.index);
  }
  return result;
}

// psi with the coordinates fixed so far replaced by functions of time.
Ref with_fixed(const Mechanics& m, Ref psi) {
  std::map<Symbol, Ref> values;
  for (const FixedCoordinate& fixed : m.fixed) values[{SymbolKind::coordinate, fixed.coordinate, 0}] = fixed.value;
  return symbolic::Substitution(*m.dag, std::move(values))(psi);
}

// The value of the only coordinate of psi, if psi is linear in it with a factor that does not depend on the motion.
bool solve_for_only_coordinate(const Mechanics& m, Ref psi, FixedCoordinate& result) {
  Dag& dag = *m.dag;
  const std::set<std::uint32_t> present = coordinates_in(dag, psi);
  if (present.size() != 1) return false;
  const Symbol symbol{SymbolKind::coordinate, *present.begin(), 0};
  const Ref slope = symbolic::partial_derivative(dag, symbol)(psi);
  if (!coordinates_in(dag, slope).empty() || dag.is_zero(slope)) return false;
  const Ref at_zero = symbolic::Substitution(dag, {{symbol, dag.zero()}})(psi);
  result.coordinate = symbol.index;
  result.value = dag.neg(dag.div(at_zero, slope));
  symbolic::Derivation ddt = symbolic::total_time_derivative(dag, 0, m.model->functions.size());
  result.rate = ddt(result.value);
  result.acceleration = ddt(result.rate);
  return true;
}

/// The constraints that fix the coordinates of psi, and those that these need: 'a', 'b' or 'c'.
std::string constraints_that_fix(const Mechanics& m, Ref psi) {
  std::set<std::uint32_t> present = coordinates_in(*m.dag, psi);
  for (auto fixed = m.fixed.rbegin(); fixed != m.fixed.rend(); ++fixed) {  // each needs only those before it
    if (present.contains(fixed->coordinate))
      present.merge(coordinates_in(*m.dag, m.constraints[fixed->constraint].psi));
  }
  std::string names, last;
  for (const FixedCoordinate& fixed : m.fixed) {
    if (!present.contains(fixed.coordinate)) continue;
    if (!last.empty()) names += (names.empty() ? "" : ", ") + last;
    last = "'" + m.constraints[fixed.constraint].label + "'";
  }
  return names.empty() ? last : names + " or " + last;
}

void refuse_repeated(const Mechanics& m, const Constraint& constraint, Ref reduced) {
  const bool same = vanishes(*m.dag, {reduced});
  const std::string others = constraints_that_fix(m, constraint.psi);
  const std::string what = same ? "constraint '" + constraint.label + "' follows from the constraints before it"
                                : "constraint '" + constraint.label +
                                      "' fixes nothing: the coordinates in it are already fixed, "
                                      "and it does not hold for all times and parameters";
  throw Error("mechanics", m.model->where(model_constraint(m, constraint).span), what,
              same || others.empty() ? "remove it" : "remove it, or " + others + ": they cannot hold together");
}

void add_position_form(const Mechanics& m, Lowering& lower, Constraint& result) {
  result.psi = lower.scalar(result.model_expression);
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    result.gradient.push_back(symbolic::partial_derivative(*m.dag, {SymbolKind::coordinate, i, 0})(result.psi));
  }
  result.rate = lower.explicit_rate(result.psi);
}

// f_i = d e/d qdot_i and b = e at rest, for an expression e that is linear in the velocities.
void add_velocity_form(const Mechanics& m, Lowering& lower, Constraint& result) {
  Dag& dag = *m.dag;
  result.kind = ConstraintKind::velocity;
  result.psi = dag.zero();
  const Ref e = lower.scalar(result.model_expression);
  std::map<Symbol, Ref> zero;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) zero[{SymbolKind::coordinate, i, 1}] = dag.zero();
  symbolic::Substitution at_rest(dag, zero);
  std::vector<Ref> curvature;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    const Ref slope = symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1})(e);
    for (std::uint32_t k = 0; k <= i; ++k)
      curvature.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, k, 1})(slope));
    result.gradient.push_back(slope);
  }
  if (!vanishes(dag, curvature)) {
    throw Error(
        "mechanics", m.model->where(m.model->arena[result.model_expression].span),
        "constraint '" + result.label + "' is not linear in the velocities",
        "write an expression that is linear in them: d'Alembert's principle gives the force of linear constraints "
        "only");
  }
  for (Ref& slope : result.gradient) slope = at_rest(slope);  // velocities that cancel may still occur in it
  result.rate = at_rest(e);
  if (!vanishes(dag, {dag.sub(e, m.velocity_form(result))})) {
    throw Error("mechanics", m.model->where(m.model->arena[result.model_expression].span),
                "constraint '" + result.label + "' divides by a velocity",
                "expand it to the form f*x_dot + g*y_dot + h");
  }
}

// The contact point must stay on both surfaces in any motion. Those of shapes do (model/contact_shapes.hpp).
void check_contact(const Mechanics& m, Lowering& lower, const model::Constraint& constraint) {
  const model::BodyContact& contact = *constraint.contact;
  const auto refuse = [&](const std::string& what, const char* remedy) {
    throw Error("mechanics", m.model->where(constraint.span), what, remedy);
  };
  const bool plane = contact.other_frame == 0;
  for (std::size_t k = 0; k < contact.normal_velocity.size(); ++k) {
    if (vanishes(*m.dag, {lower.scalar(contact.normal_velocity[k])})) continue;
    const std::string& body = m.model->frames[k == 0 ? contact.frame : contact.other_frame].name;
    if (plane)
      refuse("the point of contact of '" + constraint.name + "' leaves the plane as the body turns",
             "give in 'at' the point of the body that is nearest to the plane, or the shape");
    refuse("the point of contact of '" + constraint.name + "' leaves '" + body + "' along the normal as they move",
           "give the vectors to where they touch for all positions (of spheres along unit(A - B)), and in 'normal' the "
           "direction across both surfaces there");
  }
  if (plane || contact.offset == model::no_node) return;
  const Vec3 offset = lower.vector(contact.offset);
  if (!vanishes(*m.dag, {offset[0], offset[1], offset[2]})) {
    refuse("'at' and 'at_b' of '" + constraint.name + "' lead to points that lie beside one another",
           "give the vectors so that their points differ along the normal alone, for all positions");
  }
}

// (r - L)^2 is rejected when it is read. This rejects its expanded form, and 1 - cos(x).
void refuse_power(const Mechanics& m, const Constraint& c) {
  std::vector<Symbol> of;
  std::vector<Ref> slopes;
  for (const std::uint32_t i : coordinates_in(*m.dag, c.psi)) {
    of.push_back({SymbolKind::coordinate, i, 0});
    slopes.push_back(c.gradient[i]);
  }
  if (!is_degenerate(*m.dag, c.psi, of, slopes)) return;
  throw Error("mechanics", m.model->where(m.model->arena[c.model_expression].span),
              "constraint '" + c.label +
                  "' is a square or a higher power: its gradient vanishes where it holds, so that it has no force",
              "write the base of the power (r - L in place of r^2 - 2*L*r + L^2), or one equation for each "
              "coordinate that it fixes");
}

// One equation of a vector or of rolling may be trivial, such as a distance from the plane that no coordinate changes.
bool may_be_identity(const model::Constraint& constraint) {
  const bool several = constraint.joint || constraint.rolling || constraint.psi.size() > (constraint.velocity ? 1 : 2);
  return several && !constraint.friction && !constraint.unilateral;
}

bool is_identity(const Mechanics& m, const Constraint& c) {
  if (c.holonomic()) return holds_identically(*m.dag, c.psi);
  std::vector<Ref> all = c.gradient;
  all.push_back(c.rate);
  return vanishes(*m.dag, all);
}

/// A constraint is superfluous if all its equations are identities.
void require_nontrivial(const Mechanics& m, const model::Constraint& constraint) {
  const auto idle = [&](const Constraint& c) {
    return c.name != constraint.name || c.redundancy == Redundancy::identity;
  };
  if (constraint.joint || !std::all_of(m.constraints.begin(), m.constraints.end(), idle)) return;
  throw Error("mechanics", m.model->where(constraint.span),
              "constraint '" + constraint.name + "' holds for all values of the coordinates",
              "remove it, or give its bodies coordinates that it constrains");
}

}  // namespace

const model::Constraint& model_constraint(const Mechanics& m, const Constraint& constraint) {
  const auto same = [&](const model::Constraint& c) { return c.name == constraint.name; };
  return *std::find_if(m.model->constraints.begin(), m.model->constraints.end(), same);
}

bool may_be_redundant(const Mechanics& m, const Constraint& constraint) {
  const model::Constraint& whole = model_constraint(m, constraint);
  return whole.unit || may_be_identity(whole);
}

void add_constraints(Mechanics& m, Lowering& lower) {
  for (const model::Constraint& constraint : m.model->constraints) {
    if (constraint.contact) check_contact(m, lower, constraint);
    for (std::size_t k = 0; k < constraint.psi.size(); ++k) {
      Constraint result;
      result.name = constraint.name;
      const std::size_t part =
          constraint.is_rolling_with_friction() ? 3 : k + 1;  // the normal comes third, as without friction
      result.label = constraint.reaction_count() > 1 ? constraint.name + "." + std::to_string(part) : constraint.name;
      result.model_expression = constraint.psi[k];
      result.unilateral = constraint.unilateral;
      const bool velocities = constraint.is_velocity_equation(k);
      if (velocities) {
        add_velocity_form(m, lower, result);
      } else {
        add_position_form(m, lower, result);
      }
      if (may_be_identity(constraint) && is_identity(m, result)) result.redundancy = Redundancy::identity;
      if (result.redundancy == Redundancy::independent && vanishes(*m.dag, result.gradient)) {
        throw Error(
            "mechanics", m.model->where(constraint.span),
            "constraint '" + result.label + "' does not depend on any " + (velocities ? "velocity" : "coordinate"),
            constraint.joint
                ? "its bodies cannot move relative to one another: remove the joint, or give them coordinates"
            : velocities ? "a velocity constraint relates velocities, such as velocity = \"y_dot + z*x_dot\""
                         : "a constraint relates coordinates, such as holonomic = \"R - d\"");
      }
      if (result.redundancy == Redundancy::independent && !velocities && !constraint.joint && !constraint.rolling &&
          !constraint.unit)
        refuse_power(m, result);
      result.determined = result.redundancy == Redundancy::independent;
      m.constraints.push_back(std::move(result));
    }
    require_nontrivial(m, constraint);
  }
}

void eliminate_coordinates(Mechanics& m) {
  std::vector<bool> used(m.constraints.size(), false);
  // One constraint may fix a coordinate only after another is eliminated, so repeat until nothing changes.
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
      if (used[k] || !m.constraints[k].holonomic() || m.constraints[k].unilateral || m.constraints[k].force_input ||
          !m.is_independent(k))
        continue;
      const Ref reduced = with_fixed(m, m.constraints[k].psi);
      if (coordinates_in(*m.dag, reduced).empty()) {
        if (may_be_redundant(m, m.constraints[k]) && holds_identically(*m.dag, reduced))
          m.constraints[k].redundancy = Redundancy::redundant;
        else
          refuse_repeated(m, m.constraints[k], reduced);
        continue;
      }
      FixedCoordinate fixed{};
      fixed.constraint = k;
      if (!solve_for_only_coordinate(m, reduced, fixed)) continue;
      m.fixed.push_back(fixed);
      used[k] = true;
      changed = true;
    }
  }
  for (std::uint32_t i = 0; i < m.q.size(); ++i) {
    if (!m.is_eliminated(i)) m.free.push_back(i);
  }
}

void list_active_constraints(Mechanics& m) {
  const auto eliminates = [&](std::uint32_t k) {
    return std::any_of(m.fixed.begin(), m.fixed.end(),
                       [k](const FixedCoordinate& fixed) { return fixed.constraint == k; });
  };
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    if (!eliminates(k) && m.is_independent(k) && !m.constraints[k].force_input) m.active.push_back(k);
  }
}

}  // namespace eomgen::mechanics
