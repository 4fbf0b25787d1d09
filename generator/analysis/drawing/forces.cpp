// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/forces.hpp"

#include <algorithm>

#include "mechanics/particle_force.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::analysis {
namespace {

using mechanics::Mechanics;
using mechanics::PointMass;
using symbolic::Ref;
using symbolic::SymbolKind;
using symbolic::Vec3;
using system::OutputKind;

constexpr std::size_t most_forces = 60;  // arrows that anybody tells apart
constexpr const char *applied = "applied", *constraint = "constraint", *friction = "friction";

/// The arrows of one system of equations.
class Collection {
 public:
  Collection(Mechanics& mechanics, const Drawing& drawing, system::EquationSystem& system)
      : m_(mechanics),
        model_(*mechanics.model),
        drawing_(drawing),
        system_(system),
        dag_(*mechanics.dag),
        imposed_(mechanics::impose(mechanics)),
        written_(mechanics::write_out(mechanics)),
        on_mass_(m_.masses.size(), symbolic::zero_vector(dag_)) {}

  void run() {
    all_are_vectors_ = model_.energy.potential == model::no_node && m_.dag->is_zero(m_.kinetic_given);
    for (std::size_t i = 0; i < model_.forces.size(); ++i) force(i);
    for (std::size_t p = 0; p < m_.masses.size(); ++p) on_particle(p);
    for (std::uint32_t i = 0; i < model_.joints.size(); ++i) joint(i);
    for (const model::Constraint& c : model_.constraints) body_contact(c);
    for (std::uint32_t j = 0; j < m_.contacts.size(); ++j) rubbing(j);
  }

  std::vector<std::string> names;
  std::vector<DrawnForce> list;

 private:
  void put(const std::string& name, const char* kind, std::size_t at, const Vec3& value) {
    if (list.size() >= most_forces || symbolic::is_zero(dag_, value)) return;
    list.push_back({name, kind, at, vector(value)});
  }
  std::size_t vector(const Vec3& value) {
    const std::size_t first = drawing_.outputs().size() + names.size();
    for (std::uint32_t k = 0; k < 3; ++k) {
      names.push_back("draw.force." + std::to_string(first) + "." + std::to_string(k + 1));
      system_.outputs.push_back(
          {names.back(), written_(imposed_(value[k])), OutputKind::drawn, static_cast<std::uint32_t>(first), k});
    }
    return first;
  }
  std::size_t place(std::uint32_t of) const { return drawing_.parts().places[of - 1].at; }
  bool is_particle(const PointMass& mass) const {
    return std::any_of(model_.particles.begin(), model_.particles.end(),
                       [&](const model::Particle& p) { return p.place == mass.place; });
  }
  const system::Output* output(OutputKind kind, std::uint32_t index, std::uint32_t part) const {
    const auto found = std::find_if(system_.outputs.begin(), system_.outputs.end(), [&](const system::Output& o) {
      return o.kind == kind && o.index == index && o.part == part;
    });
    return found == system_.outputs.end() ? nullptr : &*found;
  }
  /// Three outputs along these axes; what is not there is 0.
  Vec3 along(OutputKind kind, std::uint32_t index, const std::array<Vec3, 3>& axes) {
    Vec3 sum = symbolic::zero_vector(dag_);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (const system::Output* o = output(kind, index, k))
        sum = symbolic::add(dag_, sum, symbolic::scale(dag_, o->value, axes[k]));
    }
    return sum;
  }
  std::array<Vec3, 3> fixed_axes() const {
    std::array<Vec3, 3> axes;
    for (std::size_t k = 0; k < 3; ++k) {
      axes[k] = symbolic::zero_vector(dag_);
      axes[k][k] = dag_.one();
    }
    return axes;
  }

  /// On the mass that is there, else at the point.
  void act(const std::string& name, const Vec3& value, const Vec3& at) {
    const auto mass =
        std::find_if(m_.masses.begin(), m_.masses.end(), [&](const PointMass& p) { return p.position == at; });
    if (mass == m_.masses.end()) {
      if (!symbolic::is_zero(dag_, value)) put(name, applied, vector(at), value);
      return;
    }
    Vec3& sum = on_mass_[static_cast<std::size_t>(mass - m_.masses.begin())];
    sum = symbolic::add(dag_, sum, value);
    put(name, applied, place(mass->place), value);
  }

  void force(std::size_t i) {
    const model::Force& force = model_.forces[i];
    using Acts = model::Effect::Acts;
    if (force.dry) {
      all_are_vectors_ = false;
      return;
    }
    bool is_vector = true;
    for (const model::Effect& effect : force.effects) {
      if (effect.acts == Acts::acceleration) {
        const Vec3 g = mechanics::lower_vector(m_, effect.value);
        const bool named = force.name != "force " + std::to_string(i + 1);
        for (const PointMass& mass : m_.masses)
          act(named ? force.name : "weight", symbolic::scale(dag_, mass.mass, g), mass.position);
      } else if (effect.acts == Acts::potential) {
        is_vector = spring(force, effect) && is_vector;
      } else if (effect.acts == Acts::work || effect.acts == Acts::component) {
        is_vector = false;
      }
    }
    for (const mechanics::Load& load : m_.loads) {
      if (load.name == force.name) act(force.name, load.force, load.at);
    }
    if (!is_vector) generalised(i);
  }

  /// Of a stiffness between two points.
  bool spring(const model::Force& force, const model::Effect& effect) {
    const model::NodeId stiffness = force.value("stiffness"), length = force.value("length");
    if (effect.other == model::no_node || stiffness == model::no_node) return false;
    const Vec3 a = mechanics::lower_vector(m_, effect.at), b = mechanics::lower_vector(m_, effect.other),
               d = symbolic::subtract(dag_, b, a);
    Ref factor = mechanics::lower_scalar(m_, stiffness);
    const Ref free = length == model::no_node ? dag_.zero() : mechanics::lower_scalar(m_, length);
    if (!dag_.is_zero(free)) {
      const Ref distance = dag_.call(symbolic::Op::sqrt, symbolic::dot(dag_, d, d));
      factor = dag_.mul(factor, dag_.sub(dag_.one(), dag_.div(free, distance)));
    }
    const Vec3 pull = symbolic::scale(dag_, factor, d);
    act(force.name, pull, a);
    act(force.name, symbolic::scale(dag_, dag_.integer(-1), pull), b);
    return true;
  }

  /// What is known by its components along coordinates only: on particles that these move alone.
  void generalised(std::size_t i) {
    std::vector<Ref> Q = m_.force_components[i];
    for (std::uint32_t c = 0; c < Q.size(); ++c)
      Q[c] = dag_.sub(Q[c], symbolic::partial(dag_, {SymbolKind::coordinate, c, 0})(m_.potential_by_force[i]));
    bool any = false;
    for (std::size_t p = 0; p < m_.masses.size(); ++p) {
      if (!is_particle(m_.masses[p])) continue;
      const auto value = mechanics::force_on_particle(m_, p, Q);
      if (!value || mechanics::vanishes(dag_, {(*value)[0], (*value)[1], (*value)[2]})) continue;
      put(model_.forces[i].name, applied, place(m_.masses[p].place), *value);
      any = true;
    }
    all_are_vectors_ = all_are_vectors_ && any;
  }

  /// What all constraints exert; where coordinates move several masses Newton's law says it, m a - F.
  void on_particle(std::size_t p) {
    const PointMass& mass = m_.masses[p];
    if (!is_particle(mass)) return;
    Vec3 force = along(OutputKind::constraint_force, mass.place, fixed_axes());
    if (symbolic::is_zero(dag_, force) && all_are_vectors_ && m_.contacts.empty() && is_held(mass)) {
      symbolic::Derivation ddt = symbolic::total_time(dag_, m_.q.size(), model_.functions.size());
      for (std::size_t k = 0; k < 3; ++k)
        force[k] = dag_.sub(dag_.mul(mass.mass, ddt(mass.velocity[k])), on_mass_[p][k]);
    }
    put("N", constraint, place(mass.place), force);
  }
  /// By its coordinates or by constraints: not one that three coordinates of its own move freely.
  bool is_held(const PointMass& mass) {
    return !mechanics::force_on_particle(m_, static_cast<std::size_t>(&mass - m_.masses.data()),
                                         std::vector<Ref>(m_.q.size(), dag_.zero()));
  }

  void joint(std::uint32_t i) {
    const model::Joint& joint = model_.joints[i];
    const auto& drawn = drawing_.parts().joints;
    const auto at = std::find_if(drawn.begin(), drawn.end(), [&](const DrawnJoint& d) { return d.name == joint.name; });
    if (at == drawn.end()) return;
    std::array<Vec3, 3> axes = fixed_axes();
    if (!model_.frames[joint.axes].stages.empty()) {
      for (std::size_t k = 0; k < 3; ++k)
        axes[k] = mechanics::lower_vector(m_, model_.frames[joint.axes].stages.back().e[k]);
    }
    put(joint.name, constraint, at->at, along(OutputKind::joint_reaction, i, axes));
  }

  const DrawnContact* contact_drawn(const std::string& name) const {
    const auto& drawn = drawing_.parts().contacts;
    const auto found = std::find_if(drawn.begin(), drawn.end(), [&](const DrawnContact& c) { return c.name == name; });
    return found == drawn.end() ? nullptr : &*found;
  }
  /// On the body that touches: along the normal, and where it rolls without a law of friction along both tangents.
  void body_contact(const model::Constraint& c) {
    const DrawnContact* drawn = contact_drawn(c.name);
    if (drawn == nullptr) return;
    const Vec3 t1 = mechanics::lower_vector(m_, c.contact->tangents[0]),
               t2 = mechanics::lower_vector(m_, c.contact->tangents[1]);
    const std::array<Vec3, 3> axes{t1, t2, symbolic::cross(dag_, t1, t2)};
    Vec3 sum = symbolic::zero_vector(dag_);
    std::size_t equation = 0;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.constraints[k].name != c.name) continue;
      const system::Output* o = output(OutputKind::constraint_reaction, k, 0);
      const std::size_t axis = equation + 1 == c.psi.size() ? 2 : equation;
      ++equation;
      if (o != nullptr && axis < 3) sum = symbolic::add(dag_, sum, symbolic::scale(dag_, o->value, axes[axis]));
    }
    put(c.name, constraint, drawn->at, sum);
  }
  void rubbing(std::uint32_t j) {
    const mechanics::Contact& contact = m_.contacts[j];
    if (contact.directions.empty()) return;
    const Vec3 force = along(OutputKind::friction, j, fixed_axes());
    if (const DrawnContact* drawn = contact_drawn(contact.name))
      put(contact.name, friction, drawn->at, force);
    else if (contact.place > 0)
      put(contact.name, friction, place(contact.place), force);
  }

  Mechanics& m_;
  const model::Model& model_;
  const Drawing& drawing_;
  system::EquationSystem& system_;
  symbolic::Dag& dag_;
  symbolic::Substitution imposed_, written_;
  std::vector<Vec3> on_mass_;     // applied
  bool all_are_vectors_ = false;  // so that the rest of m a is of constraints
};

}  // namespace

void DrawnForces::add_outputs(system::EquationSystem& system) {
  Collection collection(mechanics_, drawing_, system);
  collection.run();
  names_ = std::move(collection.names);
  list_ = std::move(collection.list);
}

}  // namespace eomgen::analysis
