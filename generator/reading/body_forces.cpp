// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/body_forces.hpp"

#include <algorithm>
#include <stdexcept>

#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

class BodyForceReader {
 public:
  explicit BodyForceReader(const Mechanics& m) : m_(m), bridge_(m) {}

  std::vector<BodyForce> all() {
    std::vector<BodyForce> result;
    for (std::uint32_t f = 0; f < m_.model->forces.size(); ++f) {
      const Ref potential = m_.potential_by_force[f];
      if (m_.dag->is_zero(potential)) continue;
      for (std::uint32_t b = 0; b < m_.model->bodies.size(); ++b) {
        BodyForce of;
        of.force = m_.model->forces[f].name;
        of.body = m_.body_rotations[b].name;
        of.index = b;
        try {
          const work::Budget budget(form_budget);
          if (read(f, potential, of)) result.push_back(std::move(of));
        } catch (const work::BudgetExceeded& over) {
          of.skip_reason = over.what();
          result.push_back(std::move(of));
        }
      }
    }
    return result;
  }

 private:
  bool read(std::uint32_t f, Ref potential, BodyForce& of) {
    const model::Body& body = m_.model->bodies[of.index];
    if (const model::NodeId g = m_.model->forces[f].acceleration(); g != model::no_node) {
      const mechanics::Vec3 along = mechanics::lower_vector(m_, g);
      const Sum mass = bridge_.sum(mass_of(body));
      for (std::size_t k = 0; k < 3; ++k) of.force_vector.components[k] = mass * bridge_.sum(along[k]);
      return true;
    }
    const std::vector<std::uint32_t> entries = angles(body.frame);
    const bool moves_places = names_places(m_.model->forces[f]);
    const std::vector<std::uint32_t> place =
        moves_places ? coordinates(m_.model->places[body.place]) : std::vector<std::uint32_t>{};
    const std::vector<symbolic::Symbol> symbols = m_.dag->symbols({potential});
    const auto depends = [&](std::uint32_t i) {
      return std::any_of(symbols.begin(), symbols.end(),
                         [i](const symbolic::Symbol& s) { return s.kind == SymbolKind::coordinate && s.index == i; });
    };
    if (entries.empty() || (moves_places && place.empty())) {
      // Without coordinates of its own, a body shares those of the potential, or is not moved by it.
      if (!shares(potential, of.index)) return false;
      throw work::BudgetExceeded("the body has no position and angles of its own, which " + of.force +
                                 " would act along");
    }
    if (std::none_of(place.begin(), place.end(), depends) && std::none_of(entries.begin(), entries.end(), depends))
      return false;
    const Sum U = bridge_.sum(potential);
    for (const std::uint32_t i : place) add(U, i, of.force_vector);
    for (const std::uint32_t i : entries) add(U, i, of.moment);
    const auto& chart = m_.model->places[body.place].chart;
    of.along_fixed = chart && chart->system == "cartesian";
    if (of.along_fixed) {
      for (const auto& [coordinate, component] : of.force_vector.along_dual) {
        const auto at = std::find(place.begin(), place.end(), coordinate);
        of.force_vector.components[static_cast<std::size_t>(at - place.begin())] = component;
      }
    }
    add_moment(body.frame, of.moment);
    return true;
  }

  void add(const Sum& U, std::uint32_t i, PotentialVector& vector) {
    Sum component = simplify(cancel(-bridge_.derivative(U, coordinate_symbol(i, 0))));
    if (!component.is_zero()) vector.along_dual.emplace_back(i, std::move(component));
  }

  // sum -dU/dnu_i g^i along the axes in which the dual vectors are shortest.
  void add_moment(std::uint32_t frame, PotentialVector& moment) {
    if (kinematics_.empty()) kinematics_ = kinematics(m_);
    std::optional<Components> best;
    std::size_t terms = 0;
    for (const Axes::Kind kind : {Axes::Kind::own, Axes::Kind::fixed}) {
      Components sum;
      bool complete = true;
      for (const auto& [coordinate, component] : moment.along_dual) {
        const KinematicVector* dual = find_dual(frame, coordinate, kind);
        complete = complete && dual != nullptr;
        for (std::size_t k = 0; k < 3 && complete; ++k) sum[k] += component * dual->components[k];
      }
      if (!complete) continue;
      std::size_t here = 0;
      for (Sum& component : sum) {
        component = simplify(cancel(simplify(component)));
        here += component.size();
      }
      if (best && here >= terms) continue;
      best = std::move(sum);
      terms = here;
      moment.axes = {kind, kind == Axes::Kind::own ? frame : 0, {}};
    }
    if (best) moment.components = *std::move(best);
  }

  const KinematicVector* find_dual(std::uint32_t frame, std::uint32_t coordinate, Axes::Kind kind) const {
    for (const Kinematics& of : kinematics_) {
      for (const KinematicVector& v : of.vectors) {
        if (v.quantity == Quantity::dual && v.index == frame && v.number == coordinate && v.axes.kind == kind &&
            v.skip_reason.empty())
          return &v;
      }
    }
    return nullptr;
  }

  Ref mass_of(const model::Body& body) const {
    const auto found = std::find_if(m_.masses.begin(), m_.masses.end(),
                                    [&](const mechanics::PointMass& p) { return p.place == body.place; });
    return found->mass;
  }

  /// Coordinates that move or turn only one body.
  bool moves_others(std::uint32_t coordinate, std::uint32_t place, std::uint32_t frame) const {
    symbolic::Derivation by = symbolic::partial_derivative(*m_.dag, coordinate_symbol(coordinate, 1));
    const auto moves = [&](Ref r) { return !m_.dag->is_zero(by(r)); };
    for (const mechanics::PointMass& mass : m_.masses) {
      if (mass.place != place && std::any_of(mass.velocity.begin(), mass.velocity.end(), moves)) return true;
    }
    return std::any_of(m_.body_rotations.begin(), m_.body_rotations.end(), [&](const mechanics::BodyRotation& b) {
      return b.frame != frame && std::any_of(b.w.begin(), b.w.end(), moves);
    });
  }
  std::vector<std::uint32_t> own(const std::vector<model::NodeId>& entries, std::uint32_t place, std::uint32_t frame) {
    std::vector<std::uint32_t> result;
    for (const model::NodeId entry : entries) {
      if (entry == model::no_node) return {};
      const model::Node& node = m_.model->arena[entry];
      if (node.op != model::Op::coordinate || node.order != 0 || moves_others(node.index, place, frame)) return {};
      result.push_back(node.index);
    }
    return result;
  }
  std::vector<std::uint32_t> coordinates(const model::Place& place) {
    if (!place.chart || place.chart->planar || place.from != 0) return {};
    const auto index = static_cast<std::uint32_t>(&place - m_.model->places.data());
    const auto body = std::find_if(m_.model->bodies.begin(), m_.model->bodies.end(),
                                   [&](const model::Body& b) { return b.place == index; });
    return own({place.chart->entries.begin(), place.chart->entries.end()}, index, body->frame);
  }
  /// Three angles that turn this body alone; it may be moved by them.
  std::vector<std::uint32_t> angles(std::uint32_t frame) {
    const model::Frame& of = m_.model->frames[frame];
    const auto body = std::find_if(m_.model->bodies.begin(), m_.model->bodies.end(),
                                   [&](const model::Body& b) { return b.frame == frame; });
    if (of.entries.size() != 3 || of.parent != 0) return {};
    return own(of.entries, body->place, frame);
  }
  bool shares(Ref potential, std::uint32_t body) const {
    const mechanics::BodyRotation& rotation = m_.body_rotations[body];
    const std::uint32_t place = m_.model->bodies[body].place;
    std::vector<Ref> moving(rotation.w.begin(), rotation.w.end());
    for (const mechanics::PointMass& mass : m_.masses) {
      if (mass.place == place) moving.insert(moving.end(), mass.velocity.begin(), mass.velocity.end());
    }
    const std::vector<symbolic::Symbol> of_body = m_.dag->symbols(moving), of_potential = m_.dag->symbols({potential});
    return std::any_of(of_potential.begin(), of_potential.end(), [&](const symbolic::Symbol& s) {
      if (s.kind != SymbolKind::coordinate) return false;
      return std::any_of(of_body.begin(), of_body.end(), [&](const symbolic::Symbol& t) {
        return t.kind == SymbolKind::coordinate && t.index == s.index;
      });
    });
  }

  /// Whether the potential is one of places, and not of angles alone.
  bool names_places(const model::Force& force) const {
    return std::any_of(force.effects.begin(), force.effects.end(), [&](const model::Effect& effect) {
      return names_places(effect.value) || names_places(effect.at) || names_places(effect.other);
    });
  }
  bool names_places(model::NodeId id) const {
    if (id == model::no_node) return false;
    const model::Node& node = m_.model->arena[id];
    if (node.op == model::Op::place) return true;
    if (node.op == model::Op::definition) return names_places(m_.model->definitions[node.index].expression);
    return std::any_of(std::begin(node.args), std::end(node.args),
                       [&](model::NodeId arg) { return names_places(arg); });
  }

  Mechanics m_;  // shares the Dag; lowering adds nodes to it
  GinacBridge bridge_;
  std::vector<Kinematics> kinematics_;
};

}  // namespace

std::vector<BodyForce> body_forces(const Mechanics& mechanics) try {
  return BodyForceReader(mechanics).all();
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

}  // namespace eomgen::reading
