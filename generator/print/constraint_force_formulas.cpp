// SPDX-License-Identifier: GPL-3.0-or-later
// What the constraints exert on a body, as vectors: F_c = sum lambda_k f_k^i a^i and M_c = sum lambda_k h_k^i g^i, with the slopes of
// the constraint by the rates of its coordinates and angles as components along the dual bases, eqs. (9.2), (9.84).
#include <algorithm>

#include "print/formulas.hpp"

namespace eomgen::print {
namespace {

using mechanics::Mechanics;
using reading::Formula;
using reading::mark;
using reading::Sum;
using symbolic::Ref;
using symbolic::SymbolKind;

class BodyForces {
 public:
  BodyForces(const Mechanics& m, std::uint32_t body, std::vector<Statement>& out) : m_(m), body_(body), out_(out) {}

  void add() {
    const model::Body& body = m_.model->bodies[body_];
    const model::Place& place = m_.model->places[body.place];
    if (place.chart && !place.chart->planar) {
      const auto q = coordinates({place.chart->entries.begin(), place.chart->entries.end()});
      const bool fixed = place.chart->system == "cartesian" && along_fixed_axes(q);
      if (!q.empty()) within_budget("constraint force", "bold F", q, [&](std::size_t i) {
        return fixed ? mark("E", {reading::number(static_cast<long>(i + 1))}) : mark("a", {}, {coordinate(q[i])});
      });
    }
    const model::Frame& frame = m_.model->frames[body.frame];
    if (frame.rotation.empty() || frame.entries.size() != 3) return;
    const auto angles = coordinates(frame.entries);
    if (!angles.empty()) within_budget("constraint moment", "bold M", angles, [&](std::size_t i) { return mark("bold g", {}, {coordinate(angles[i])}); });
  }

 private:
  static Formula coordinate(std::uint32_t i) { return reading::symbol({SymbolKind::coordinate, i, 0}); }

  /// Three coordinates that move this body alone; none where an entry is anything else.
  std::vector<std::uint32_t> coordinates(const std::vector<model::NodeId>& entries) const {
    std::vector<std::uint32_t> result;
    for (const model::NodeId entry : entries) {
      if (entry == model::no_node) return {};
      const model::Node& node = m_.model->arena[entry];
      if (node.op != model::Op::coordinate || std::find(result.begin(), result.end(), node.index) != result.end()) return {};
      if (moves_others(node.index)) return {};
      result.push_back(node.index);
    }
    return result;
  }

  bool moves_others(std::uint32_t i) const {
    symbolic::Derivation by = symbolic::partial(*m_.dag, {SymbolKind::coordinate, i, 1});
    const auto moves = [&](Ref r) { return !m_.dag->is_zero(by(r)); };
    for (const mechanics::PointMass& mass : m_.masses) {
      if (mass.place != m_.model->bodies[body_].place && std::any_of(mass.velocity.begin(), mass.velocity.end(), moves)) return true;
    }
    for (std::size_t b = 0; b < m_.spins.size(); ++b) {
      if (b != body_ && std::any_of(m_.spins[b].w.begin(), m_.spins[b].w.end(), moves)) return true;
    }
    return false;
  }

  bool along_fixed_axes(const std::vector<std::uint32_t>& q) const {
    const symbolic::Vec3& position = *m_.place_position[m_.model->bodies[body_].place];
    for (std::size_t i = 0; i < q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial(*m_.dag, {SymbolKind::coordinate, q[i], 0});
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
    } catch (const work::OverBudget& over) {
      out_.push_back(left_out("reactions", m_.spins[body_].name, role, over.what()));
    }
  }

  template <class Vector>
  void show(const char* role, const char* letter, const std::vector<std::uint32_t>& along, Vector&& vector) {
    std::vector<Formula> terms;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      const Formula lambda = reading::symbol({SymbolKind::multiplier, k, 0});
      std::vector<Formula> parts;
      bool sums = false;  // terms can be broken over lines, brackets within brackets cannot
      for (std::size_t i = 0; i < along.size(); ++i) {
        const Sum slope = reading::read(m_, m_.constraints[k].gradient[along[i]]);
        if (slope.is_zero()) continue;
        const bool minus = reading::leads_negative(slope);
        Formula part = reading::product({reading::arrange(minus ? -slope : slope), vector(i)});
        parts.push_back(minus ? reading::negative(std::move(part)) : std::move(part));
        sums = sums || slope.size() > 1;
      }
      if (parts.empty()) continue;
      if (sums) {
        for (Formula& part : parts) {
          const bool minus = part.form == reading::Form::negative;
          Formula term = reading::product({lambda, minus ? reading::negative(std::move(part)) : std::move(part)});
          terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
        }
        continue;
      }
      const bool all_minus = std::all_of(parts.begin(), parts.end(), [](const Formula& f) { return f.form == reading::Form::negative; });
      if (all_minus) std::for_each(parts.begin(), parts.end(), [](Formula& f) { f = reading::negative(std::move(f)); });
      Formula term = reading::product({lambda, reading::sum(std::move(parts))});
      terms.push_back(all_minus ? reading::negative(std::move(term)) : std::move(term));
    }
    if (terms.empty()) return;
    std::vector<Formula> sub;
    if (m_.model->bodies.size() > 1) sub.push_back(reading::number(static_cast<long>(body_ + 1)));
    out_.push_back({"reactions", m_.spins[body_].name, "", role, reading::relation({mark(letter, std::move(sub)), reading::sum(std::move(terms))})});
  }

  const Mechanics& m_;
  std::uint32_t body_;
  std::vector<Statement>& out_;
};

}  // namespace

void add_constraint_forces(const Mechanics& m, std::vector<Statement>& out) {
  for (std::uint32_t body = 0; body < m.spins.size(); ++body) BodyForces(m, body, out).add();
}

}  // namespace eomgen::print
