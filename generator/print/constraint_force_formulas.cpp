// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint forces as vectors. On a particle: N = sum lambda_k dpsi_k/dq^i a^i along the unit vectors of its
// coordinates, eqs. (1.22), (2.99). On a body: F_c = sum lambda_k f_k^i a^i and M_c = sum lambda_k h_k^i g^i, eqs.
// (9.2), (9.84). Components along the dual bases are the derivatives of the constraint by the rates of coordinates and
// angles.
#include <algorithm>
#include <map>
#include <optional>

#include "print/formulas.hpp"
#include "reading/constrained_roots.hpp"
#include "reading/solved_form.hpp"
#include "reading/trig.hpp"

namespace eomgen::print {
namespace {

/// Multipliers in formulas: symbols, or functions of the state. In approach II the multipliers of imposed constraints
/// are not unknowns; vectors that contain them are omitted, as are those that the motion does not determine.
class Multipliers {
 public:
  Multipliers(const Mechanics& m, const DisplayForm& form) : m_(m), built_in_(m.constraints.size(), false) {
    if (form.approach != system::Approach::two) return;
    for (const reading::DisplayConstraint& c : form.constraints) built_in_[c.constraint] = c.fixes.has_value();
  }
  Multipliers(const Mechanics& m, const reading::SolvedForm& solved)
      : m_(m), built_in_(m.constraints.size(), false), solved_(&solved) {
    for (std::uint32_t k = 0; k < m.constraints.size(); ++k)
      built_in_[k] = m.is_independent(k) && !solved.multipliers[k];
  }
  const char* key() const { return solved_ != nullptr ? "solved" : "reactions"; }
  bool holds(std::uint32_t k) const { return m_.is_independent(k); }
  bool built_in(std::uint32_t k) const { return built_in_[k]; }
  bool are_solved() const { return solved_ != nullptr; }
  Sum value(std::uint32_t k) const {
    if (solved_ != nullptr) return *solved_->multipliers[k];
    return reading::display_sum(m_, m_.dag->symbol({SymbolKind::multiplier, k, 0}));
  }
  /// dpsi_k/dq_i, with the roots whose value a constraint gives.
  Sum slope(std::uint32_t k, std::uint32_t i) const {
    return shorter_(reading::display_sum(m_, m_.constraints[k].gradient[i]));
  }
  /// The friction force along tangent `a` of a contact, where all contacts hold; 0 otherwise.
  Sum friction(const mechanics::Contact& contact, std::uint32_t a) const {
    if (solved_ == nullptr || contact.first + a >= solved_->friction.size()) return {};
    return solved_->friction[contact.first + a].value_or(Sum());
  }
  /// A component as it is displayed: with the brackets of springs, which multipliers contain once they are solved for.
  Sum with_springs(const Sum& component) const {
    return solved_ == nullptr ? component : with_brackets(component, solved_->powers);
  }
  bool is_holding() const { return solved_ != nullptr && solved_->mode == reading::FrictionMode::holding; }

 private:
  const Mechanics& m_;
  const reading::ConstrainedRoots shorter_ = reading::constrained_roots(m_);
  std::vector<bool> built_in_;
  const reading::SolvedForm* solved_ = nullptr;
};

/// Whether the coordinate moves anything besides the mass at `place` and the body. If so, the constraint forces along
/// it act on those too.
bool moves_others(const Mechanics& m, std::uint32_t coordinate, std::uint32_t place,
                  std::optional<std::uint32_t> body) {
  symbolic::Derivation by = symbolic::partial_derivative(*m.dag, {SymbolKind::coordinate, coordinate, 1});
  const auto moves = [&](Ref r) { return !m.dag->is_zero(by(r)); };
  for (const mechanics::PointMass& mass : m.masses) {
    if (mass.place != place && std::any_of(mass.velocity.begin(), mass.velocity.end(), moves)) return true;
  }
  for (std::uint32_t b = 0; b < m.body_rotations.size(); ++b) {
    if (b != body && std::any_of(m.body_rotations[b].w.begin(), m.body_rotations[b].w.end(), moves)) return true;
  }
  return false;
}

class BodyForces {
 public:
  BodyForces(const Mechanics& m, const Multipliers& multipliers, std::uint32_t body, std::vector<Statement>& out)
      : m_(m), multipliers_(multipliers), body_(body), out_(out) {}

  void add() {
    const model::Body& body = m_.model->bodies[body_];
    const model::Place& place = m_.model->places[body.place];
    if (place.chart && !place.chart->planar) {
      const auto q = coordinates({place.chart->entries.begin(), place.chart->entries.end()});
      const bool fixed = place.chart->system == "cartesian" && along_fixed_axes(q);
      if (!q.empty())
        within_budget("constraint force", "bold F", q, [&](std::size_t i) {
          return fixed ? mark("E", {reading::number(static_cast<long>(i + 1))}) : mark("a", {}, {coordinate(q[i])});
        });
    }
    const model::Frame& frame = m_.model->frames[body.frame];
    if (frame.rotation.empty() || frame.entries.size() != 3) return;
    const auto angles = coordinates(frame.entries);
    if (!angles.empty())
      within_budget("constraint moment", "bold M", angles,
                    [&](std::size_t i) { return mark("bold g", {}, {coordinate(angles[i])}); });
  }

 private:
  static Formula coordinate(std::uint32_t i) { return reading::symbol({SymbolKind::coordinate, i, 0}); }

  /// Three coordinates that move only this body; empty if an entry is anything else.
  std::vector<std::uint32_t> coordinates(const std::vector<model::NodeId>& entries) const {
    std::vector<std::uint32_t> result;
    for (const model::NodeId entry : entries) {
      if (entry == model::no_node) return {};
      const model::Node& node = m_.model->arena[entry];
      if (node.op != model::Op::coordinate || std::find(result.begin(), result.end(), node.index) != result.end())
        return {};
      if (moves_others(m_, node.index, m_.model->bodies[body_].place, body_)) return {};
      result.push_back(node.index);
    }
    return result;
  }

  bool along_fixed_axes(const std::vector<std::uint32_t>& q) const {
    const symbolic::Vec3& position = *m_.place_position[m_.model->bodies[body_].place];
    for (std::size_t i = 0; i < q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, q[i], 0});
      for (std::size_t k = 0; k < 3; ++k) {
        const Ref slope = by(position[k]);
        if (i == k ? slope != m_.dag->one() : !m_.dag->is_zero(slope)) return false;
      }
    }
    return !q.empty();
  }

  template <class Vector>
  void within_budget(const char* role, const char* letter, const std::vector<std::uint32_t>& along, Vector&& vector) {
    try {
      show(role, letter, along, vector);
    } catch (const work::BudgetExceeded& over) {
      out_.push_back(left_out(multipliers_.key(), m_.body_rotations[body_].name, role, over.what()));
    }
  }

  /// The components along the vectors as sums, with the multipliers as functions of the state.
  template <class Vector>
  void show_solved(const char* role, const char* letter, const std::vector<std::uint32_t>& along, Vector&& vector) {
    std::vector<Formula> terms;
    for (std::size_t i = 0; i < along.size(); ++i) {
      Sum component;
      for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
        if (!multipliers_.holds(k)) continue;
        const Sum slope = multipliers_.slope(k, along[i]);
        if (slope.is_zero()) continue;
        if (multipliers_.built_in(k)) return;
        component = reading::simplify(component + slope * multipliers_.value(k));
      }
      if (component.is_zero()) continue;
      component = multipliers_.with_springs(component);
      const bool minus = reading::has_negative_leading_term(component);
      Formula term = reading::product({reading::arrange(minus ? -component : component), vector(i)});
      terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
    }
    if (!terms.empty()) add(role, letter, std::move(terms));
  }

  void add(const char* role, const char* letter, std::vector<Formula> terms) {
    std::vector<Formula> sub;
    if (m_.model->bodies.size() > 1) sub.push_back(reading::number(static_cast<long>(body_ + 1)));
    out_.push_back({multipliers_.key(), m_.body_rotations[body_].name, "", role,
                    reading::relation({mark(letter, std::move(sub)), reading::sum(std::move(terms))})});
  }

  template <class Vector>
  void show(const char* role, const char* letter, const std::vector<std::uint32_t>& along, Vector&& vector) {
    if (multipliers_.are_solved()) return show_solved(role, letter, along, vector);
    std::vector<Formula> terms;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (!multipliers_.holds(k)) continue;
      const Formula lambda = reading::symbol({SymbolKind::multiplier, k, 0});
      std::vector<Formula> parts;
      bool sums = false;  // lines break between terms, not within nested brackets
      for (std::size_t i = 0; i < along.size(); ++i) {
        const Sum slope = multipliers_.slope(k, along[i]);
        if (slope.is_zero()) continue;
        const bool minus = reading::has_negative_leading_term(slope);
        Formula part = reading::product({reading::arrange(minus ? -slope : slope), vector(i)});
        parts.push_back(minus ? reading::negative(std::move(part)) : std::move(part));
        sums = sums || slope.size() > 1;
      }
      if (parts.empty()) continue;
      if (multipliers_.built_in(k)) return;
      if (sums) {
        for (Formula& part : parts) {
          const bool minus = part.kind == reading::FormulaKind::negative;
          Formula term = reading::product({lambda, minus ? reading::negative(std::move(part)) : std::move(part)});
          terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
        }
        continue;
      }
      const bool all_minus = std::all_of(parts.begin(), parts.end(),
                                         [](const Formula& f) { return f.kind == reading::FormulaKind::negative; });
      if (all_minus) std::for_each(parts.begin(), parts.end(), [](Formula& f) { f = reading::negative(std::move(f)); });
      Formula term = reading::product({lambda, reading::sum(std::move(parts))});
      terms.push_back(all_minus ? reading::negative(std::move(term)) : std::move(term));
    }
    if (!terms.empty()) add(role, letter, std::move(terms));
  }

  const Mechanics& m_;
  const Multipliers& multipliers_;
  std::uint32_t body_;
  std::vector<Statement>& out_;
};

/// Basis vectors of the chart; if it names none, the contravariant basis.
std::vector<Formula> vectors_of(const reading::Geometry& g) {
  std::vector<Formula> result;
  if (g.contravariant_unit.empty()) {
    for (const std::uint32_t i : g.coordinates)
      result.push_back(mark("a", {}, {reading::symbol({SymbolKind::coordinate, i, 0})}));
    result.resize(3);
    return result;
  }
  for (const std::optional<std::uint32_t>& name : g.unit_names) {
    result.push_back(name ? mark("e", {reading::symbol({SymbolKind::coordinate, *name, 0})}) : mark("e"));
  }
  return result;
}

/// Constraint forces on particles that are moved only by their three coordinates, or by two in their plane, and on
/// those that carry such particles along: the force on what they carry is taken off.
class ParticleForces {
 public:
  ParticleForces(const Mechanics& m, const Multipliers& multipliers) : m_(m), multipliers_(multipliers) {}

  void add(std::vector<Statement>& out) {
    std::vector<reading::LeftOut> unseen;
    const std::vector<reading::Geometry> geometries = reading::geometry(m_, &unseen);
    // A particle is reached once the forces on all that it carries are known.
    std::map<std::size_t, Statement> statements;
    for (bool more = true; more;) {
      more = false;
      for (const reading::Geometry& g : geometries) {
        const std::optional<std::size_t> mass = particle_of(g);
        if (!mass || forces_.contains(*mass)) continue;
        const std::optional<std::vector<std::size_t>> carried = carried_by(g, *mass);
        if (!carried) continue;
        more = true;
        try {
          const work::Budget budget(reading::item_budget);
          if (auto statement = force_on(g, *mass, *carried)) statements.emplace(*mass, std::move(*statement));
        } catch (const work::BudgetExceeded& over) {
          forces_[*mass] = std::nullopt;
          statements.emplace(*mass, left_out(multipliers_.key(), g.name, role(), over.what()));
        }
      }
    }
    for (auto& [mass, statement] : statements) out.push_back(std::move(statement));
  }

 private:
  /// The mass that a chart with as many directions as coordinates describes.
  std::optional<std::size_t> particle_of(const reading::Geometry& g) const {
    const auto mass = std::find_if(m_.masses.begin(), m_.masses.end(), [&](const mechanics::PointMass& p) {
      return m_.model->places[p.place].name == g.name;
    });
    if (mass == m_.masses.end() || g.inverse.empty()) return std::nullopt;
    const auto& chart = m_.model->places[mass->place].chart;
    const std::size_t directions = chart && chart->planar ? 2 : 3;
    const bool of_body = std::any_of(m_.model->bodies.begin(), m_.model->bodies.end(),
                                     [&](const model::Body& b) { return b.place == mass->place; });
    if (of_body || g.coordinates.size() != directions) return std::nullopt;
    return static_cast<std::size_t>(mass - m_.masses.begin());
  }

  /// The other masses that its coordinates move, if each moves as the particle does along all of them and the force on
  /// each is known.
  std::optional<std::vector<std::size_t>> carried_by(const reading::Geometry& g, std::size_t p) const {
    std::vector<std::size_t> result;
    for (const std::uint32_t i : g.coordinates) {
      symbolic::Derivation by = symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, i, 1});
      const auto moves = [&](Ref r) { return !m_.dag->is_zero(by(r)); };
      for (const mechanics::BodyRotation& body : m_.body_rotations)
        if (std::any_of(body.w.begin(), body.w.end(), moves)) return std::nullopt;
      for (std::size_t other = 0; other < m_.masses.size(); ++other) {
        const symbolic::Vec3& velocity = m_.masses[other].velocity;
        if (other == p || std::none_of(velocity.begin(), velocity.end(), moves)) continue;
        if (!moves_alike(by, m_.masses[p].velocity, velocity) || !is_known(other)) return std::nullopt;
        if (std::find(result.begin(), result.end(), other) == result.end()) result.push_back(other);
      }
    }
    for (const std::size_t other : result) {  // along all coordinates, or its force is no part of this one
      for (const std::uint32_t i : g.coordinates) {
        symbolic::Derivation by = symbolic::partial_derivative(*m_.dag, {SymbolKind::coordinate, i, 1});
        if (!moves_alike(by, m_.masses[p].velocity, m_.masses[other].velocity)) return std::nullopt;
      }
    }
    return result;
  }

  bool is_known(std::size_t mass) const {
    const auto found = forces_.find(mass);
    return found != forces_.end() && found->second.has_value();
  }

  bool moves_alike(symbolic::Derivation& by, const symbolic::Vec3& a, const symbolic::Vec3& b) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (!m_.dag->is_zero(m_.dag->sub(by(a[k]), by(b[k])))) return false;
    return true;
  }

  /// Stores the force; no statement if there is none, or if it contains multipliers that are no unknowns.
  std::optional<Statement> force_on(const reading::Geometry& g, std::size_t p,
                                    const std::vector<std::size_t>& carried) {
    forces_[p] = std::nullopt;
    reading::Components force{};
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (!multipliers_.holds(k)) continue;
      for (std::size_t i = 0; i < g.coordinates.size(); ++i) {
        const Sum slope = multipliers_.slope(k, g.coordinates[i]);
        if (slope.is_zero()) continue;
        if (multipliers_.built_in(k)) return std::nullopt;
        add_along(g, i, multipliers_.value(k) * slope, force);
      }
    }
    for (const mechanics::Contact& contact : m_.contacts) {
      for (std::uint32_t a = 0; multipliers_.is_holding() && a < contact.dimensions(); ++a) {
        const Sum phi = multipliers_.friction(contact, a);
        for (std::size_t i = 0; i < g.coordinates.size(); ++i)
          add_along(g, i, phi * reading::display_sum(m_, contact.tangents[a][g.coordinates[i]]), force);
      }
    }
    Terms terms;
    if (!std::all_of(force.begin(), force.end(), [](const Sum& s) { return s.is_zero(); }))
      terms.push_back({false, vector(g, force)});
    for (const std::size_t other : carried)
      for (const auto& [minus, term] : *forces_.at(other)) terms.push_back({!minus, term});
    forces_[p] = terms;
    if (terms.empty()) return std::nullopt;
    std::vector<Formula> sum, sub;
    for (const auto& [minus, term] : terms) sum.push_back(minus ? negated(term) : term);
    if (m_.masses.size() > 1) sub.push_back(reading::number(static_cast<long>(p + 1)));
    const char* letter = multipliers_.is_holding() ? "bold F" : "bold N";
    return Statement{multipliers_.key(), g.name, "", role(),
                     reading::relation({mark(letter, std::move(sub)), reading::sum(std::move(sum))})};
  }
  /// While contacts hold, their friction is a constraint force like the others.
  const char* role() const {
    return multipliers_.is_holding() ? "constraint force with the friction that holds" : "constraint force";
  }

  /// Adds Q_i a^i.
  static void add_along(const reading::Geometry& g, std::size_t i, const Sum& component, reading::Components& force) {
    if (g.contravariant_unit.empty()) {
      force[i] = reading::simplify(force[i] + component);
      return;
    }
    for (std::size_t j = 0; j < 3; ++j) force[j] = reading::simplify(force[j] + component * g.contravariant_unit[i][j]);
  }

  /// Along the vectors of the chart, or along E1, E2, E3 if that is shorter: a force that holds balances weights.
  Formula vector(const reading::Geometry& g, const reading::Components& force) const {
    if (!multipliers_.is_holding() || g.contravariant_unit.empty())
      return combination(with_springs(force), vectors_of(g));
    reading::Components fixed;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        fixed[k] = reading::simplify(fixed[k] + force[j] * unit_along_fixed(g, j, k));
      }
    }
    std::size_t along_chart = 0, along_fixed = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along_chart += force[k].size();
      along_fixed += fixed[k].size();
    }
    if (along_fixed > along_chart) return combination(with_springs(force), vectors_of(g));
    return combination(with_springs(fixed), {mark("E", {reading::number(1)}), mark("E", {reading::number(2)}),
                                             mark("E", {reading::number(3)})});
  }

  reading::Components with_springs(reading::Components force) const {
    for (Sum& component : force) component = multipliers_.with_springs(component);
    return force;
  }

  /// e_j . E_k = sum_i (e_j . a_i) (a^i . E_k).
  static Sum unit_along_fixed(const reading::Geometry& g, std::size_t j, std::size_t k) {
    Sum result;
    for (std::size_t i = 0; i < g.coordinates.size(); ++i) result += g.covariant_unit[i][j] * g.contravariant[i][k];
    return reading::simplify(result);
  }

  /// -term, term by term.
  static Formula negated(Formula term) {
    if (term.kind != reading::FormulaKind::sum) return reading::negative(std::move(term));
    std::vector<Formula> terms;
    for (Formula& part : term.args) terms.push_back(reading::negative(std::move(part)));
    return reading::sum(std::move(terms));
  }

  using Terms = std::vector<std::pair<bool, Formula>>;  // negative, and the vector
  const Mechanics& m_;
  const Multipliers& multipliers_;
  std::map<std::size_t, std::optional<Terms>> forces_;  // by mass; empty: not known
};

}  // namespace

namespace {

void add_forces(const Mechanics& m, const Multipliers& multipliers, std::vector<Statement>& out) {
  if (!m.constraints.empty()) ParticleForces(m, multipliers).add(out);
  for (std::uint32_t body = 0; body < m.body_rotations.size(); ++body) BodyForces(m, multipliers, body, out).add();
}

}  // namespace

void add_constraint_forces(const Mechanics& m, const DisplayForm& form, std::vector<Statement>& out) {
  add_forces(m, Multipliers(m, form), out);
}

void add_constraint_forces(const Mechanics& m, const reading::SolvedForm& solved, std::vector<Statement>& out) {
  add_forces(m, Multipliers(m, solved), out);
}

}  // namespace eomgen::print
