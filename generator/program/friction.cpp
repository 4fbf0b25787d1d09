// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/friction.hpp"

#include <algorithm>

#include "lists.hpp"
#include "program/elimination.hpp"
#include "program/normal_forces.hpp"

namespace eomgen::program {
namespace {

using symbolic::Derivation;
using symbolic::Substitution;
using symbolic::Symbol;
using symbolic::SymbolKind;
using system::Contact;

/// An affine function of phi: value + sum_b slope_b phi_b.
struct Affine {
  Ref value;
  std::vector<Ref> slope;
};

class FrictionLawSolver {
 public:
  FrictionLawSolver(const system::EquationSystem& system, const LinearSolver& solve) : s_(system), dag_(*system.dag) {
    for (const Contact& contact : s_.contacts) count_ += contact.slip.size();
    solve_motion(solve);
    matrix_.assign(count_ * count_, dag_.zero());
    right_.assign(count_, dag_.zero());
  }

  FrictionSolution run() {
    for (std::uint32_t j = 0; j < s_.contacts.size(); ++j) {
      for (const std::uint32_t k : s_.contacts[j].reactions) normal_[j].push_back(affine(s_.reactions[k].value));
    }
    find_coupled_curves();
    for (std::uint32_t j = 0; j < s_.contacts.size(); ++j) add_rows(j);
    solve_rows();
    for (std::size_t i = 0; i < motion_.size(); ++i) {
      (i < s_.free.size() ? result_.qddot : result_.lambda).push_back(at(motion_[i]));
    }
    for (std::uint32_t j = 0; j < s_.contacts.size(); ++j) add_indicators(j);
    return std::move(result_);
  }

 private:
  Symbol phi_symbol(std::size_t b) const { return {SymbolKind::friction, static_cast<std::uint32_t>(b), 0}; }

  // qddot and lambda as affine functions of phi, with one solve per tangent.
  void solve_motion(const LinearSolver& solve) {
    std::map<Symbol, Ref> none;
    for (std::size_t b = 0; b < count_; ++b) none[phi_symbol(b)] = dag_.zero();
    Substitution without(dag_, none);
    std::vector<Ref> f, c, still(s_.active.size(), dag_.zero());
    for (const Ref r : s_.f) f.push_back(without(r));
    for (const Ref gamma : s_.gamma) c.push_back(dag_.neg(gamma));
    const auto store = [this](const std::pair<std::vector<Ref>, std::vector<Ref>>& solution, auto&& into) {
      std::size_t i = 0;
      for (const auto* part : {&solution.first, &solution.second}) {
        for (const Ref r : *part) into(motion_[i++], r);
      }
    };
    motion_.resize(s_.free.size() + s_.active.size());
    store(solve(f, c), [](Affine& a, Ref r) { a.value = r; });
    for (std::size_t b = 0; b < count_; ++b) {
      Derivation by = symbolic::partial_derivative(dag_, phi_symbol(b));
      std::vector<Ref> column = mapped(s_.f, [&](Ref r) { return by(r); });
      store(solve(column, still), [](Affine& a, Ref r) { a.slope.push_back(r); });
    }
    for (std::size_t i = 0; i < s_.free.size(); ++i) unknown_.push_back({SymbolKind::coordinate, s_.free[i], 2});
    for (const std::uint32_t k : s_.active) unknown_.push_back({SymbolKind::multiplier, k, 0});
  }

  /// The affine form of an expression that is linear in qddot, lambda and phi.
  Affine affine(Ref expression) {
    std::map<Symbol, Ref> base;
    for (std::size_t i = 0; i < unknown_.size(); ++i) base[unknown_[i]] = motion_[i].value;
    for (std::size_t b = 0; b < count_; ++b) base[phi_symbol(b)] = dag_.zero();
    Affine result{Substitution(dag_, base)(expression), {}};
    for (std::size_t b = 0; b < count_; ++b) {
      Ref slope = symbolic::partial_derivative(dag_, phi_symbol(b))(expression);
      for (std::size_t i = 0; i < unknown_.size(); ++i) {
        slope =
            dag_.add(slope, dag_.mul(symbolic::partial_derivative(dag_, unknown_[i])(expression), motion_[i].slope[b]));
      }
      result.slope.push_back(slope);
    }
    return result;
  }
  Ref at(const Affine& a) const {
    Ref sum = a.value;
    for (std::size_t b = 0; b < count_; ++b) sum = dag_.add(sum, dag_.mul(a.slope[b], result_.phi[b]));
    return sum;
  }

  Ref slides(std::uint32_t j) const { return dag_.symbol(system::slip_direction_symbol(j)); }
  /// The sign of the normal force; a unilateral contact does not pull.
  Ref normal_sign(std::uint32_t j) const {
    return s_.contacts[j].unilateral ? dag_.one() : dag_.symbol(system::normal_sign_symbol(j));
  }
  /// Selects `apart` if contact j is open, else `touching`.
  Ref select_by_contact(std::uint32_t j, Ref if_open, Ref if_closed) const {
    if (!s_.contacts[j].unilateral || if_open == if_closed) return if_closed;
    return dag_.select(dag_.symbol(system::normal_sign_symbol(j)), dag_.zero(), if_open, if_closed);
  }
  /// Selects `sliding` if contact j slides, else `sticking`.
  Ref by_mode(std::uint32_t j, Ref sticking, Ref sliding) const {
    if (sticking == sliding || s_.contacts[j].width) return sliding;
    const Ref half = dag_.constant(symbolic::Rational(1) / 2), s = slides(j);
    return dag_.select(dag_.mul(s, s), half, sticking, sliding);
  }
  Ref root(Ref r) const { return dag_.call(symbolic::Op::sqrt, r); }
  Ref absolute(Ref r) const { return dag_.call(symbolic::Op::abs, r); }
  Ref squares(const Contact& c) const {
    Ref sum = dag_.zero();
    for (const Ref w : c.slip) sum = dag_.add(sum, dag_.mul(w, w));
    return sum;
  }
  Ref speed(const Contact& c) const { return root(squares(c)); }
  /// Component a of the unit vector of slip.
  Ref sliding_direction(std::uint32_t j, std::size_t a) const {
    const Contact& c = s_.contacts[j];
    if (c.width && dag_.is_zero(*c.width)) {  // constraints prescribe the slip; at rest friction is not determined
      const Ref square = squares(c);
      return dag_.select(dag_.zero(), square, dag_.div(c.slip[a], root(square)), dag_.zero());
    }
    if (c.width) return dag_.div(c.slip[a], root(dag_.add(squares(c), dag_.mul(*c.width, *c.width))));
    return c.slip.size() == 1 ? slides(j) : dag_.div(c.slip[a], speed(c));
  }

  void add_rows(std::uint32_t j) {
    const Contact& c = s_.contacts[j];
    if (c.reactions.size() == 2 && coupled_.empty()) close_curve(j);
    const std::vector<Affine> sticking = sticking_rows(j);
    for (std::size_t a = 0; a < c.slip.size(); ++a) {
      const Affine& rate = sticking[a];
      const Affine law = sliding_law(j, a);
      const std::size_t row = c.first + a;
      if (c.reactions.size() == 2 && !coupled_.empty()) {
        by_normal_[place_of(j)][row] =
            dag_.neg(by_mode(j, dag_.zero(), dag_.mul(c.dynamic_coefficient, sliding_direction(j, a))));
      }
      for (std::size_t b = 0; b < count_; ++b) {
        const Ref none = b == row ? dag_.one() : dag_.zero();  // open contact: phi = 0
        matrix_[row * count_ + b] = select_by_contact(j, none, by_mode(j, rate.slope[b], law.slope[b]));
      }
      right_[row] = select_by_contact(j, dag_.zero(), dag_.neg(by_mode(j, rate.value, law.value)));
    }
    if (c.reactions.size() == 1 && !c.slip.empty()) set_surface_margin(j);
  }

  /// Rows that vanish while sticking: the slip rate; phi itself along directions that another contact constrains.
  std::vector<Affine> sticking_rows(std::uint32_t j) {
    std::vector<Affine> rates = mapped(s_.contacts[j].slip_rate, [&](Ref rate) { return affine(rate); });
    return sticking_rows(s_.contacts[j], rates, 0, {});
  }
  /// The rows as a case distinction over the contacts that constrain a direction. Contacts before `next` are decided:
  /// those in `touching` are closed, the others open.
  std::vector<Affine> sticking_rows(const Contact& c, const std::vector<Affine>& rates, std::size_t next,
                                    const std::vector<const system::BlockedDirection*>& closed) const {
    if (next == c.blocked.size()) return held_rows(c, rates, closed);
    const system::BlockedDirection& held = c.blocked[next];
    std::vector<Affine> rows = sticking_rows(c, rates, next + 1, closed);
    std::vector<const system::BlockedDirection*> more = closed;
    more.push_back(&held);
    const std::vector<Affine> where_it_touches = sticking_rows(c, rates, next + 1, more);
    for (std::size_t a = 0; a < rows.size(); ++a) {
      const Affine& other = where_it_touches[a];
      rows[a].value = select_by_contact(held.by, rows[a].value, other.value);
      for (std::size_t b = 0; b < count_; ++b)
        rows[a].slope[b] = select_by_contact(held.by, rows[a].slope[b], other.slope[b]);
    }
    return rows;
  }
  std::vector<Affine> held_rows(const Contact& c, const std::vector<Affine>& rates,
                                const std::vector<const system::BlockedDirection*>& closed) const {
    if (closed.empty()) return rates;
    std::vector<Affine> rows(rates.size(), Affine{dag_.zero(), std::vector<Ref>(count_, dag_.zero())});
    if (rates.size() == 1 || closed.size() > 1) {
      for (std::size_t a = 0; a < rows.size(); ++a) rows[a].slope[c.first + a] = dag_.one();
      return rows;
    }
    // phi has no component along h; the slip rate has none perpendicular to h.
    const std::vector<Ref>& h = closed[0]->along;
    const auto across = [&](Ref first, Ref second) { return dag_.sub(dag_.mul(h[0], second), dag_.mul(h[1], first)); };
    for (std::size_t a = 0; a < 2; ++a) rows[0].slope[c.first + a] = h[a];
    rows[1].value = across(rates[0].value, rates[1].value);
    for (std::size_t b = 0; b < count_; ++b) rows[1].slope[b] = across(rates[0].slope[b], rates[1].slope[b]);
    return rows;
  }

  /// The row that vanishes while sliding: phi_a + mu |N| w_a/|w|.
  Affine sliding_law(std::uint32_t j, std::size_t a) {
    const Contact& c = s_.contacts[j];
    const Ref drag = dag_.mul(c.dynamic_coefficient, sliding_direction(j, a));
    Affine law{dag_.zero(), std::vector<Ref>(count_, dag_.zero())};
    law.slope[c.first + a] = dag_.one();
    if (c.reactions.empty()) {
      law.value = dag_.mul(drag, absolute(c.normal));
    } else if (c.reactions.size() == 2) {
      if (coupled_.empty()) law.value = dag_.mul(drag, curve_normal_[j]);
    } else {
      const Ref factor = dag_.mul(drag, dag_.mul(normal_sign(j), root(c.gram[0])));
      law.value = dag_.mul(factor, normal_[j][0].value);
      for (std::size_t b = 0; b < count_; ++b) {
        law.slope[b] = dag_.add(law.slope[b], dag_.mul(factor, normal_[j][0].slope[b]));
      }
    }
    return law;
  }

  // Curves whose normal forces depend on the friction at another contact are solved together (normal_forces.hpp).
  void find_coupled_curves() {
    std::vector<std::uint32_t> curves;
    bool coupled = false;
    for (std::uint32_t j = 0; j < s_.contacts.size(); ++j) {
      const Contact& c = s_.contacts[j];
      if (c.reactions.size() != 2) continue;
      curves.push_back(j);
      for (const Affine& lambda : normal_[j]) {
        for (std::size_t b = 0; b < count_; ++b) coupled = coupled || (b != c.first && !dag_.is_zero(lambda.slope[b]));
      }
    }
    if (!coupled) return;
    coupled_ = std::move(curves);
    by_normal_.assign(coupled_.size(), std::vector<Ref>(count_, dag_.zero()));
  }
  std::size_t place_of(std::uint32_t curve) const {
    return static_cast<std::size_t>(std::find(coupled_.begin(), coupled_.end(), curve) - coupled_.begin());
  }

  // nu = |lambda^T G lambda|^(1/2) with lambda = l0 - sigma mu nu L: (1 - mu^2 LGL) nu^2 + 2 sigma mu l0GL nu - l0Gl0 =
  // 0.
  void close_curve(std::uint32_t j) {
    const Contact& c = s_.contacts[j];
    const auto form = [&](auto&& x, auto&& y) {
      Ref sum = dag_.zero();
      for (std::size_t k = 0; k < 4; ++k) {
        sum = dag_.add(sum, dag_.mul(c.gram[k], dag_.mul(x(normal_[j][k / 2]), y(normal_[j][k % 2]))));
      }
      return sum;
    };
    const auto value = [](const Affine& l) { return l.value; };
    const auto slope = [&c](const Affine& l) { return l.slope[c.first]; };
    const Ref square = form(value, value), feedback = form(slope, slope),
              sigma_mu = dag_.mul(sliding_direction(j, 0), c.dynamic_coefficient);
    if (dag_.is_zero(feedback)) {
      curve_normal_[j] = root(square);
      return;
    }
    const Ref strength = c.width ? sigma_mu : c.dynamic_coefficient;  // the sign of sliding cancels in the square
    const Ref a = dag_.sub(dag_.one(), dag_.mul(dag_.power(strength, 2), feedback));
    const Ref b = dag_.mul(sigma_mu, form(value, slope));
    const Ref discriminant = dag_.add(dag_.mul(b, b), dag_.mul(a, square));
    curve_normal_[j] = dag_.div(dag_.sub(root(discriminant), b), a);
    margin_[j] = by_mode(j, dag_.one(), a);
    // a < 0: both roots have the sign of b. Both are solutions if it is positive and the discriminant is not negative;
    // otherwise there is none.
    add_codes(margin_[j], dag_.call(symbolic::Op::min, b, discriminant));
  }

  // phi = -mu w p sqrt(g) (x0 + L phi) has exactly one solution with p x >= 0 for one p if |factor L| < 1.
  void set_surface_margin(std::uint32_t j) {
    const Contact& c = s_.contacts[j];
    Ref feedback = dag_.zero();  // of friction on its own normal force, sliding with p = 1
    const Ref pressed = dag_.mul(c.dynamic_coefficient, root(c.gram[0]));
    for (std::size_t a = 0; a < c.slip.size(); ++a) {
      feedback =
          dag_.add(feedback, dag_.mul(dag_.mul(pressed, sliding_direction(j, a)), normal_[j][0].slope[c.first + a]));
    }
    if (dag_.is_zero(feedback)) return;
    const Ref own = dag_.add(dag_.one(), dag_.mul(normal_sign(j), feedback));
    // A unilateral contact does not pull: p = 1. It may also open, which the law allows if x0 < 0.
    const Ref single = c.unilateral ? own : dag_.sub(dag_.one(), absolute(feedback));
    margin_[j] = select_by_contact(j, dag_.one(), by_mode(j, dag_.one(), single));
    add_codes(margin_[j], dag_.mul(dag_.mul(normal_sign(j), normal_[j][0].value), own));
  }

  /// Adds the codes for a negative margin: several solutions if `several` is positive, otherwise none.
  void add_codes(Ref margin, Ref several) {
    const Ref minus = dag_.integer(-1), one = dag_.one(), zero = dag_.zero();
    result_.existence.push_back(dag_.select(margin, zero, dag_.select(several, zero, minus, one), one));
    result_.uniqueness.push_back(dag_.select(margin, zero, dag_.select(several, zero, one, minus), one));
  }

  void solve_rows() {
    std::vector<std::vector<Ref>> sides{right_};
    sides.insert(sides.end(), by_normal_.begin(), by_normal_.end());
    if (count_ > 0) eliminate(dag_, matrix_, sides);
    result_.phi = sides[0];
    if (!coupled_.empty()) add_coupled(sides);
  }

  // phi = sides[0] + sum_d sides[1 + d] nu_d
  void add_coupled(const std::vector<std::vector<Ref>>& sides) {
    std::vector<CurveForce> forces;
    for (const std::uint32_t j : coupled_) {
      CurveForce force{s_.contacts[j].gram, {}, std::vector<std::array<Ref, 2>>(coupled_.size())};
      for (std::size_t k = 0; k < 2; ++k) {
        force.a[k] = at(normal_[j][k]);
        for (std::size_t d = 0; d < coupled_.size(); ++d) {
          force.b[d][k] = dag_.zero();
          for (std::size_t b = 0; b < count_; ++b) {
            force.b[d][k] = dag_.add(force.b[d][k], dag_.mul(normal_[j][k].slope[b], sides[1 + d][b]));
          }
        }
      }
      forces.push_back(std::move(force));
    }
    const NormalForces normal = coupled_normal_forces(dag_, forces);
    for (std::size_t b = 0; b < count_; ++b) {
      for (std::size_t d = 0; d < coupled_.size(); ++d) {
        result_.phi[b] = dag_.add(result_.phi[b], dag_.mul(sides[1 + d][b], normal.nu[d]));
      }
    }
    add_codes(normal.solution_margin, normal.multiplicity);
    if (coupled_.size() == 1) margin_[coupled_[0]] = normal.solution_margin;
  }

  /// |N| of contact j; for a surface, `press` is set to the signed multiplier.
  Ref normal_force(std::uint32_t j, Ref& press) {
    const Contact& c = s_.contacts[j];
    const std::size_t n = c.reactions.size();
    if (n == 0) return absolute(c.normal);
    if (n == 1) press = dag_.mul(normal_sign(j), at(normal_[j][0]));
    Ref square = dag_.zero();
    for (std::size_t k = 0; k < n * n && !c.gram.empty(); ++k) {
      square = dag_.add(square, dag_.mul(c.gram[k], dag_.mul(at(normal_[j][k / n]), at(normal_[j][k % n]))));
    }
    return root(square);
  }

  void add_indicators(std::uint32_t j) {
    const Contact& c = s_.contacts[j];
    const Ref one = dag_.one();
    ContactIndicators watch{one, one, one, one, one};
    const Ref normal = normal_force(j, watch.hold);
    if (c.unilateral) watch.hold = select_by_contact(j, s_.psi[*c.unilateral], watch.hold);
    if (!c.slip.empty()) watch.slip = c.slip[0];
    if (c.slip.size() == 2) watch.below = c.slip[1];
    if (c.can_stick()) {
      const Ref limit = dag_.mul(c.static_coefficient, normal), phi = result_.phi[c.first];
      watch.above = dag_.sub(limit, phi);
      if (c.slip.size() == 1) watch.below = dag_.add(limit, phi);
      if (c.slip.size() == 2)
        watch.above = dag_.sub(limit, root(dag_.add(dag_.mul(phi, phi), dag_.power(result_.phi[c.first + 1], 2))));
    }
    if (margin_.contains(j)) watch.margin = margin_.at(j);
    result_.indicators.push_back(watch);
  }

  const system::EquationSystem& s_;
  Dag& dag_;
  std::size_t count_ = 0;
  std::vector<Symbol> unknown_;                          // qddot, then multipliers
  std::vector<Affine> motion_;                           // affine form of unknown_
  std::map<std::uint32_t, std::vector<Affine>> normal_;  // multipliers per contact
  std::map<std::uint32_t, Ref> curve_normal_, margin_;
  std::vector<Ref> matrix_, right_;          // linear system for phi
  std::vector<std::uint32_t> coupled_;       // curves with coupled normal forces
  std::vector<std::vector<Ref>> by_normal_;  // per coupled curve: coefficients of its normal force in right_
  FrictionSolution result_;
};

}  // namespace

FrictionSolution solve_friction_laws(const system::EquationSystem& system, const LinearSolver& solve) {
  return FrictionLawSolver(system, solve).run();
}

}  // namespace eomgen::program
