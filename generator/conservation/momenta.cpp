// SPDX-License-Identifier: GPL-3.0-or-later
// sum d(m v)/dt . d = sum (Q_i - dU/dq_i) xi_i + sum lambda_k A_ki xi_i for displacements d = dr/dq_i xi_i of all
// masses. With d = E_k or E_k x r the left-hand side is dG_k/dt or dH_k/dt. For bodies, dH/dt . (dw/dqdot_i xi_i) is
// added: the body rotates about E_k, or not at all. Of a body that rolls, d may be such a rotation of it alone, about
// its centre of mass or about the point of contact P; then dH_P/dt has the term -v_P x m v, which must vanish.
#include "conservation/momenta.hpp"

#include <cmath>

#include "conservation/jumps.hpp"
#include "derive/equations.hpp"
#include "mechanics/vanishes.hpp"
#include "numeric/elimination.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/factorisation.hpp"
#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::conservation {
namespace {

using derive::generalized_forces;
using mechanics::constraint_substitution;
using mechanics::time_function_substitution;
using mechanics::Vec3;

constexpr double screening = 1e-5;  // candidates are then tested in many digits
// Budget of expanding J^T J, which finds zeros for orthogonal coordinates: products of two terms, and terms of one
// entry.
constexpr std::size_t gram_effort = 300'000, gram_terms = 400;

/// The least-squares solution y of J y = d, if it is one: J is rows x n, row-major.
bool is_in_range(const std::vector<double>& J, const std::vector<double>& d, std::size_t n, std::vector<double>& y) {
  numeric::Matrix<double> N(n, n), right(n, 1);
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t r = 0; r < d.size(); ++r) {
      right(i, 0) += J[r * n + i] * d[r];
      for (std::size_t k = 0; k < n; ++k) N(i, k) += J[r * n + i] * J[r * n + k];
    }
    size = std::max(size, N(i, i));
  }
  const numeric::Elimination<double> factors(std::move(N), 1e-10 * size, numeric::Pivoting::diagonal);
  if (factors.rank() < n) return false;
  y = factors.solve(right).a;
  double residual = 0, length = 0;
  for (std::size_t r = 0; r < d.size(); ++r) {
    double rest = d[r];
    for (std::size_t i = 0; i < n; ++i) rest -= J[r * n + i] * y[i];
    residual = std::max(residual, std::abs(rest));
    length = std::max(length, std::abs(d[r]));
  }
  return residual <= screening * length;
}

/// Whether force . y is 0 relative to its possible size.
bool does_no_work(const double* force, const std::vector<double>& y) {
  double sum = 0, forces = 0, longest = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    sum += force[i] * y[i];
    forces += std::abs(force[i]);
    longest = std::max(longest, std::abs(y[i]));
  }
  return std::abs(sum) <= screening * forces * longest;  // zero entries of y have rounding errors of the longest
}

/// A momentum: of the whole system, or the angular momentum of one body about its centre of mass or about a point that
/// is `arm` from it.
struct Candidate {
  bool angular = false;
  std::string name, title;  // without the axis
  std::uint32_t index = 0;  // of the output
  std::optional<std::size_t> body = {};
  std::optional<Vec3> arm = {};
};

class Search {
 public:
  Search(Mechanics& m, const system::EquationSystem& s) : s_(s), dag_(*m.dag), n_(s.free.size()) {
    symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
    const auto all = [&](const Vec3& v) {
      return Vec3{written(imposed(v[0])), written(imposed(v[1])), written(imposed(v[2]))};
    };
    for (const mechanics::PointMass& mass : m.masses) {
      mass_.push_back(written(mass.mass));
      r_.push_back(all(mass.position));
      v_.push_back(all(mass.velocity));
    }
    for (const Vec3& r : r_) {
      for (const Ref x : r) {
        for (const std::uint32_t i : s.free)
          J_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0})(x));
      }
    }
    for (const mechanics::BodyRotation& spin : m.body_rotations) {
      w_.push_back(all(spin.w));
      for (const Ref w : w_.back()) {
        for (const std::uint32_t i : s.free)
          J_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1})(w));
      }
      H_.push_back(inertia_times(dag_, spin, w_.back()));
      axes_.push_back({all(spin.axes[0]), all(spin.axes[1]), all(spin.axes[2])});
    }
    // Admissible displacements: for dependent coordinates (Euler parameters) the constraints select among those with
    // the same motion.
    J_.insert(J_.end(), s.A.begin(), s.A.end());
    const std::vector<Ref> Q = generalized_forces(m);
    for (const std::uint32_t i : s.free) {
      const Ref slope = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0})(s.potential);
      force_.push_back(dag_.sub(written(imposed(Q[i])), slope));
    }
    for (const Ref surface : jump_surfaces(dag_, {s.kinetic, s.potential})) {
      for (const std::uint32_t i : s.free)
        jump_gradients_.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 0})(surface));
    }
  }

  /// `is_redundant`: whether this expression is redundant, which is far cheaper to test than conservation.
  template <class Repeats>
  std::optional<ConservedQuantity> component(const Candidate& of, std::size_t k, const Repeats& is_redundant) {
    const bool angular = of.angular;
    const std::vector<Ref> d = displacement(of, k);
    if (mechanics::vanishes(dag_, d) || !may_be_conserved(d)) return std::nullopt;
    ConservedQuantity result;
    const std::string along = "E" + std::to_string(k + 1);
    result.name = of.name + along;
    result.kind = angular ? system::OutputKind::angular_momentum : system::OutputKind::linear_momentum;
    result.index = of.index;
    result.part = static_cast<std::uint32_t>(k);
    result.title = of.title + along;
    Ref expression = dag_.zero();
    for (std::size_t p = 0; p < r_.size(); ++p) {
      const Vec3 moved_by{d[3 * p], d[3 * p + 1], d[3 * p + 2]};
      expression = dag_.add(expression, dag_.mul(mass_[p], dot(dag_, moved_by, v_[p])));
    }
    for (std::size_t b = 0; b < H_.size(); ++b) {
      const std::size_t row = 3 * (r_.size() + b);
      expression = dag_.add(expression, dot(dag_, Vec3{d[row], d[row + 1], d[row + 2]}, H_[b]));
    }
    if (is_redundant(expression)) return std::nullopt;
    std::vector<Ref> must_vanish = conditions(d);
    if (of.arm) must_vanish.push_back(carried(of, k));
    const Certainty certainty = zero_certainty(dag_, must_vanish);
    if (certainty == Certainty::no) return std::nullopt;
    result.certainty = certainty;
    Ref magnitude = dag_.zero();
    for (std::size_t p = 0; p < r_.size(); ++p) {
      if (of.body && p != mass_of_body_[*of.body]) continue;
      Ref squares = dot(dag_, v_[p], v_[p]);
      const Vec3& arm = of.arm ? *of.arm : r_[p];
      if (of.body && !of.arm) squares = dag_.zero();
      if (angular) squares = dag_.mul(squares, dot(dag_, arm, arm));
      magnitude = dag_.add(magnitude, dag_.mul(mass_[p], dag_.call(symbolic::Op::sqrt, squares)));
    }
    for (std::size_t b = 0; b < H_.size() && angular; ++b)
      if (!of.body || b == *of.body)
        magnitude = dag_.add(magnitude, dag_.call(symbolic::Op::sqrt, dot(dag_, H_[b], H_[b])));
    result.expression = expression;
    result.magnitude = magnitude;
    return result;
  }

  /// For bodies that roll: about their centres of mass, and about the points of contact.
  std::vector<Candidate> of_rolling_bodies(Mechanics& m) {
    std::vector<Candidate> result;
    symbolic::Substitution imposed = constraint_substitution(m), written = time_function_substitution(m);
    const model::Model& model = *m.model;
    for (std::uint32_t c = 0; c < model.constraints.size(); ++c) {
      const auto& contact = model.constraints[c].contact;
      if (!contact || !contact->rolling || contact->other_place != 0) continue;
      for (std::uint32_t b = 0; b < model.bodies.size(); ++b) {
        if (model.bodies[b].place != contact->place) continue;
        const std::string& name = model.places[contact->place].name;
        result.push_back({true,
                          "angular_momentum." + name + ".",
                          "angular momentum of '" + name + "' about its centre of mass along ",
                          1 + b,
                          b,
                          {}});
        Vec3 arm = mechanics::lower_vector(m, contact->arm);
        for (Ref& x : arm) x = written(imposed(x));
        const auto bodies = static_cast<std::uint32_t>(model.bodies.size());
        result.push_back({true, "angular_momentum." + model.constraints[c].name + ".",
                          "angular momentum of '" + name + "' about the point of contact along ", 1 + bodies + c, b,
                          arm});
      }
    }
    for (const model::Body& body : model.bodies) {
      const auto mass = std::find_if(m.masses.begin(), m.masses.end(),
                                     [&](const mechanics::PointMass& p) { return p.place == body.place; });
      mass_of_body_.push_back(static_cast<std::size_t>(mass - m.masses.begin()));
    }
    coordinates_ = m.q.size();
    functions_ = model.functions.size();
    return result;
  }

 private:
  /// m v . (E_k x v_P): the rate of the component that the motion of the point P adds; v_P = v + d(arm)/dt.
  Ref carried(const Candidate& of, std::size_t k) {
    const std::size_t p = mass_of_body_[*of.body];
    symbolic::Derivation ddt = symbolic::total_time_derivative(dag_, coordinates_, functions_);
    Vec3 rate;
    for (std::size_t i = 0; i < 3; ++i) rate[i] = dag_.add(v_[p][i], ddt((*of.arm)[i]));
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;  // (E_k x a) . v = a_i v_j - a_j v_i
    return dag_.mul(mass_[p], dag_.sub(dag_.mul(rate[i], v_[p][j]), dag_.mul(rate[j], v_[p][i])));
  }

  std::vector<Ref> displacement(const Candidate& of, std::size_t k) const {
    std::vector<Ref> d = moved(of, k);
    for (std::size_t b = 0; b < axes_.size(); ++b) {
      for (const Vec3& e : axes_[b]) d.push_back(of.angular && (!of.body || b == *of.body) ? e[k] : dag_.zero());
    }
    d.resize(d.size() + s_.active.size(), dag_.zero());
    return d;
  }

  std::vector<Ref> moved(const Candidate& of, std::size_t k) const {
    std::vector<Ref> d;
    for (std::size_t p = 0; p < r_.size(); ++p) {
      if (of.body && (!of.arm || p != mass_of_body_[*of.body])) {
        d.insert(d.end(), 3, dag_.zero());
        continue;
      }
      const Vec3 r = of.arm ? Vec3{dag_.neg((*of.arm)[0]), dag_.neg((*of.arm)[1]), dag_.neg((*of.arm)[2])} : r_[p];
      for (std::size_t c = 0; c < 3; ++c) {
        if (!of.angular)
          d.push_back(c == k ? dag_.one() : dag_.zero());
        else if (c == k)
          d.push_back(dag_.zero());
        else
          d.push_back(c == (k + 1) % 3 ? dag_.neg(r[(k + 2) % 3]) : r[(k + 1) % 3]);  // E_k x r
      }
    }
    return d;
  }

  /// Tests at one point that the displacement is one of the coordinates' and that the forces do no work on it.
  bool may_be_conserved(const std::vector<Ref>& d) const {
    std::vector<Ref> both = J_;
    both.insert(both.end(), d.begin(), d.end());
    both.insert(both.end(), force_.begin(), force_.end());
    for (std::uint64_t point = 1; point <= 4; ++point) {
      std::vector<double> value =
          symbolic::evaluate(dag_, both, [=](const Symbol& s) { return symbolic::sample_double(s, point); });
      if (!std::all_of(value.begin(), value.end(), [](double x) { return std::isfinite(x); })) continue;
      const auto end = value.begin() + static_cast<std::ptrdiff_t>(J_.size());
      const auto force = end + static_cast<std::ptrdiff_t>(d.size());
      std::vector<double> xi;
      return is_in_range({value.begin(), end}, {end, force}, n_, xi) && does_no_work(&*force, xi);
    }
    return false;
  }

  // Expressions that must vanish: J xi - d, the work on xi, that of the constraint forces, and that of the impulses
  // where energies jump.
  std::vector<Ref> conditions(const std::vector<Ref>& d) {
    std::vector<Ref> y(n_, dag_.zero());
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t r = 0; r < d.size(); ++r) y[i] = dag_.add(y[i], dag_.mul(J_[r * n_ + i], d[r]));
    }
    if (!factors_) factors_.emplace(factorised());
    const std::vector<Ref> xi = factors_->backward(factors_->forward(y));
    std::vector<Ref> result;
    for (std::size_t r = 0; r < d.size(); ++r) result.push_back(dag_.sub(along(xi, J_, r), d[r]));
    result.push_back(along(xi, force_, 0));
    for (std::size_t k = 0; k * n_ < jump_gradients_.size(); ++k) result.push_back(along(xi, jump_gradients_, k));
    return result;
  }

  /// J^T J.
  symbolic::Factorisation factorised() {
    symbolic::ProductBudget effort{gram_effort};
    symbolic::Expander expand(dag_, gram_terms, &effort);
    std::vector<Ref> N(n_ * n_, dag_.zero());
    const std::size_t rows = J_.size() / n_;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        Ref sum = dag_.zero();
        for (std::size_t r = 0; r < rows; ++r) sum = dag_.add(sum, dag_.mul(J_[r * n_ + i], J_[r * n_ + k]));
        N[i * n_ + k] = N[k * n_ + i] = expand.expand_or_keep(sum);  // diagonal for orthogonal coordinates
      }
    }
    return {dag_, std::move(N), n_, symbolic::Ties::ascending};
  }

  Ref along(const std::vector<Ref>& xi, const std::vector<Ref>& matrix, std::size_t row) const {
    Ref sum = dag_.zero();
    for (std::size_t i = 0; i < n_; ++i) sum = dag_.add(sum, dag_.mul(matrix[row * n_ + i], xi[i]));
    return sum;
  }

  const system::EquationSystem& s_;
  Dag& dag_;
  std::size_t n_;
  std::vector<Ref> mass_, J_, force_;
  std::vector<Ref> jump_gradients_;  // gradients of the surfaces where energies jump, row by row
  std::vector<Vec3> r_, v_, w_, H_;
  std::vector<std::array<Vec3, 3>> axes_;  // of the rotating bodies
  std::vector<std::size_t> mass_of_body_;  // indices of masses
  std::size_t coordinates_ = 0, functions_ = 0;
  std::optional<symbolic::Factorisation> factors_;
};

bool is_redundant(const Dag& dag, const std::vector<ConservedQuantity>& known, Ref expression, Dag& work) {
  return std::any_of(known.begin(), known.end(), [&](const ConservedQuantity& c) {
    return mechanics::vanishes(dag, {work.sub(c.expression, expression)}) ||
           mechanics::vanishes(dag, {work.add(c.expression, expression)});
  });
}

}  // namespace

std::vector<ConservedQuantity> conserved_momenta(Mechanics& m, const system::EquationSystem& s,
                                                 const std::vector<ConservedQuantity>& known) {
  std::vector<ConservedQuantity> all = known, found;
  if (m.masses.empty() || !m.dag->is_zero(m.kinetic_given) || s.free.empty() ||
      s.free.size() > max_momentum_coordinates)
    return found;
  Search search(m, s);
  std::vector<Candidate> candidates{{false, "linear_momentum.", "linear momentum along "},
                                    {true, "angular_momentum.", "angular momentum about the origin along "}};
  for (Candidate& candidate : search.of_rolling_bodies(m)) candidates.push_back(std::move(candidate));
  for (const Candidate& candidate : candidates) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<ConservedQuantity> c = search.component(candidate, k, [&](Ref expression) {
        return mechanics::vanishes(*m.dag, {expression}) || is_redundant(*m.dag, all, expression, *m.dag);
      });
      if (!c) continue;
      found.push_back(*c);
      all.push_back(*c);
    }
  }
  return found;
}

}  // namespace eomgen::conservation
