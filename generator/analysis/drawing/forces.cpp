// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/forces.hpp"

#include <algorithm>

#include "analysis/drawing/force_decomposition.hpp"
#include "forces/kind.hpp"
#include "mechanics/particle_force.hpp"
#include "mechanics/vanishes.hpp"

namespace eomgen::analysis {
namespace {

using mechanics::Mechanics;
using mechanics::PointMass;
using symbolic::Vec3;
using system::OutputKind;

constexpr std::size_t most_forces = 60;  // limit of readability
constexpr const char *applied = "applied", *constraint = "constraint", *friction = "friction";

/// Collects the arrows of one system of equations.
class Collection {
 public:
  Collection(Mechanics& mechanics, const Drawing& drawing, system::EquationSystem& system)
      : m_(mechanics),
        model_(*mechanics.model),
        drawing_(drawing),
        system_(system),
        dag_(*mechanics.dag),
        imposed_(mechanics::constraint_substitution(mechanics)),
        written_(mechanics::time_function_substitution(mechanics)),
        on_mass_(m_.masses.size(), symbolic::zero_vector(dag_)) {}

  void run() {
    all_are_vectors_ = model_.energy.potential == model::no_node && m_.dag->is_zero(m_.kinetic_given);
    for (std::size_t i = 0; i < model_.forces.size(); ++i) force(i);
    for (std::size_t p = 0; p < m_.masses.size(); ++p) on_particle(p);
    for (std::uint32_t i = 0; i < model_.joints.size(); ++i) joint(i);
    for (const model::Constraint& c : model_.constraints) body_contact(c);
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) on_bodies(k);
    for (std::uint32_t j = 0; j < m_.contacts.size(); ++j) rubbing(j);
  }

  std::vector<std::string> names;
  std::vector<DrawnForce> list;
  std::vector<std::string> unknown;
  std::size_t beyond = 0;

 private:
  void put(const std::string& name, const char* kind, std::size_t at, const Vec3& value, bool turns = false) {
    if (symbolic::is_zero(dag_, value)) return;
    if (list.size() >= most_forces) {
      ++beyond;
      return;
    }
    list.push_back({name, kind, at, vector(value), turns});
  }
  void put_moment(const std::string& name, const char* kind, const BodyMoment& moment) {
    put(name, kind, place(model_.bodies[moment.body].place), moment.value, true);
  }
  BodyMoments& moments() {
    if (!moments_) moments_.emplace(m_);
    return *moments_;
  }
  void leave_out(const std::string& name) {
    if (std::find(unknown.begin(), unknown.end(), name) == unknown.end()) unknown.push_back(name);
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
  /// Vector of three outputs along these axes, from part `first` on. Missing outputs are 0.
  Vec3 along(OutputKind kind, std::uint32_t index, const std::array<Vec3, 3>& axes, std::uint32_t first = 0) {
    Vec3 sum = symbolic::zero_vector(dag_);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (const system::Output* o = output(kind, index, first + k))
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

  /// Applies the force to the mass at this point if there is one, otherwise to the point.
  void act(const std::string& name, const Vec3& value, const Vec3& at) {
    acts_.push_back({value, at});
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
    using LoadType = model::Effect::LoadType;
    if (force.dry) {
      all_are_vectors_ = false;
      return;
    }
    acts_.clear();
    turns_.clear();
    bool is_vector = true;
    for (const model::Effect& effect : force.effects) {
      if (effect.load_type == LoadType::acceleration) {
        const Vec3 g = mechanics::lower_vector(m_, effect.value);
        const bool named = force.name != "force " + std::to_string(i + 1);
        for (const PointMass& mass : m_.masses)
          act(named ? force.name : "weight", symbolic::scale(dag_, mass.mass, g), mass.position);
      } else if (effect.load_type == LoadType::potential) {
        is_vector = spring(force, effect) && is_vector;
      } else if (effect.load_type == LoadType::moment) {
        is_vector = moment(force, effect) && is_vector;
      } else if (effect.load_type == LoadType::work || effect.load_type == LoadType::component) {
        is_vector = false;
      }
    }
    for (const mechanics::Load& load : m_.loads) {
      if (load.name == force.name) act(force.name, load.force, load.at);
    }
    if (!is_vector && !generalised(i)) {
      all_are_vectors_ = false;
      leave_out(force.name);
    }
  }

  /// Moment on a body; nothing for the ground.
  bool moment(const model::Force& force, const model::Effect& effect) {
    if (effect.index == 0) return true;
    const auto body = moments().body_of(effect.index);
    if (!body) return false;
    turns_.push_back({*body, mechanics::lower_vector(m_, effect.value)});
    put_moment(force.name, applied, turns_.back());
    return true;
  }

  /// Forces of a stiffness between two points.
  bool spring(const model::Force& force, const model::Effect& effect) {
    const forces::LinearSpring& keys = forces::find(force.kind)->linear_spring;
    const model::NodeId stiffness = force.value(keys.stiffness), length = force.value(keys.length);
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

  /// Draws a force that is given by its generalised components. Returns whether the arrows represent all of it.
  bool generalised(std::size_t i) {
    const model::Force& force = model_.forces[i];
    ForceDecomposition Q(m_, moments(), m_.force_components[i]);
    Q.add_potential(m_.potential_by_force[i]);
    for (const Act& act : acts_) Q.subtract(act.force, act.at);
    for (const BodyMoment& turn : turns_) Q.subtract(turn);
    for (const Ref angle : angles(force)) {
      for (const BodyMoment& turn : Q.moments_about_angle(angle)) put_moment(force.name, applied, turn);
    }
    for (const auto& [p, value] : Q.forces_on_masses()) {
      put(force.name, applied, place(m_.masses[p].place), value);
      on_mass_[p] = symbolic::add(dag_, on_mass_[p], value);
    }
    for (const BodyMoment& turn : Q.moments_on_attitudes()) put_moment(force.name, applied, turn);
    return mechanics::vanishes(dag_, Q.remainder());
  }
  /// Angle along which the force acts: its own, or coordinates.
  std::vector<Ref> angles(const model::Force& force) {
    std::vector<Ref> result;
    if (const model::NodeId own = force.value("angle"); own != model::no_node)
      result.push_back(mechanics::lower_scalar(m_, own));
    for (const model::Effect& effect : force.effects) {
      if (effect.load_type == model::Effect::LoadType::component && model_.coordinates[effect.index].unit.text == "rad")
        result.push_back(m_.q[effect.index]);
    }
    return result;
  }

  /// Total force of all constraints. If coordinates move several masses, it follows from Newton's law as m a - F.
  void on_particle(std::size_t p) {
    const PointMass& mass = m_.masses[p];
    if (!is_particle(mass)) return;
    Vec3 force = along(OutputKind::constraint_force, mass.place, fixed_axes());
    if (symbolic::is_zero(dag_, force) && all_are_vectors_ && m_.contacts.empty() && is_held(mass)) {
      symbolic::Derivation ddt = symbolic::total_time_derivative(dag_, m_.q.size(), model_.functions.size());
      for (std::size_t k = 0; k < 3; ++k)
        force[k] = dag_.sub(dag_.mul(mass.mass, ddt(mass.velocity[k])), on_mass_[p][k]);
    }
    put("N", constraint, place(mass.place), force);
  }
  /// Whether coordinates or constraints restrict the place. False if its own coordinates move it freely in space or in
  /// the plane of its chart.
  bool is_held(const PointMass& mass) {
    const std::vector<symbolic::Symbol> symbols = dag_.symbols({mass.position[0], mass.position[1], mass.position[2]});
    const auto count = std::count_if(symbols.begin(), symbols.end(),
                                     [](const symbolic::Symbol& s) { return s.kind == SymbolKind::coordinate; });
    const std::optional<model::Chart>& chart = model_.places[mass.place].chart;
    return count < (chart && chart->planar ? 2 : 3) ||
           !mechanics::force_on_particle(m_, static_cast<std::size_t>(&mass - m_.masses.data()),
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
    put(joint.name, constraint, at->at, along(OutputKind::joint_reaction, i, axes, 3), true);
  }

  const DrawnContact* contact_drawn(const std::string& name) const {
    const auto& drawn = drawing_.parts().contacts;
    const auto found = std::find_if(drawn.begin(), drawn.end(), [&](const DrawnContact& c) { return c.name == name; });
    return found == drawn.end() ? nullptr : &*found;
  }
  /// Contact force on the body: along the normal, and along both tangents if it rolls without a friction law.
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
  /// Forces of explicit constraints and couplings on bodies. For particles they are contained in N.
  void on_bodies(std::uint32_t k) {
    const mechanics::Constraint& c = m_.constraints[k];
    const model::Constraint& of = *std::find_if(model_.constraints.begin(), model_.constraints.end(),
                                                [&](const model::Constraint& other) { return other.name == c.name; });
    if (of.joint || of.contact || of.unit || m_.body_rotations.empty() || !m_.is_independent(k)) return;
    std::vector<std::uint32_t> concerned;
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      if (!dag_.is_zero(c.gradient[i]) && moves_bodies(i)) concerned.push_back(i);
    }
    if (concerned.empty()) return;
    const system::Output* lambda = output(OutputKind::constraint_reaction, k, 0);
    if (lambda == nullptr) return leave_out(c.label);
    std::vector<Ref> along;
    for (const Ref f : c.gradient) along.push_back(dag_.mul(lambda->value, f));
    ForceDecomposition Q(m_, moments(), along);
    if (of.coupled) coupling(c.label, *of.coupled, lambda->value, Q);
    if (!of.coupled && c.holonomic()) {  // psi may be an angle
      for (const BodyMoment& turn : Q.moments_about_angle(c.psi)) put_moment(c.label, constraint, turn);
    }
    for (const auto& [p, value] : Q.forces_on_masses()) {
      if (!is_particle(m_.masses[p])) put(c.label, constraint, place(m_.masses[p].place), value);
    }
    for (const BodyMoment& turn : Q.moments_on_attitudes()) put_moment(c.label, constraint, turn);
    for (const std::uint32_t i : concerned) {
      if (!mechanics::vanishes(dag_, {Q.remainder()[i]})) return leave_out(c.label);
    }
  }
  bool moves_bodies(std::uint32_t c) {
    symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, c, 0});
    for (std::size_t b = 0; b < m_.body_rotations.size(); ++b) {
      const Vec3& r = *m_.place_position[model_.bodies[b].place];
      if (moments().rotates(b, c) || !symbolic::is_zero(dag_, {by(r[0]), by(r[1]), by(r[2])})) return true;
    }
    return false;
  }
  /// The multiplier of a coupling is the moment on the first body about its axis.
  void coupling(const std::string& name, const model::RotationCoupling& coupled, Ref lambda, ForceDecomposition& Q) {
    const Vec3 a = symbolic::scale(dag_, lambda, mechanics::lower_vector(m_, coupled.axes[0])),
               b = symbolic::scale(dag_, dag_.neg(dag_.mul(lambda, mechanics::lower_scalar(m_, coupled.ratio))),
                                   mechanics::lower_vector(m_, coupled.axes[1])),
               rest = symbolic::scale(dag_, dag_.integer(-1), symbolic::add(dag_, a, b));
    const std::array<Vec3, 3> values{a, b, rest};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto body = coupled.frames[k] > 0 ? moments().body_of(coupled.frames[k]) : std::nullopt;
      if (!body) continue;
      put_moment(name, constraint, {*body, values[k]});
      Q.subtract({*body, values[k]});
    }
  }
  void rubbing(std::uint32_t j) {
    const mechanics::Contact& contact = m_.contacts[j];
    if (contact.directions.empty()) {
      if (contact.place == 0) leave_out(contact.name);  // friction along a coordinate
      return;
    }
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
  std::vector<Vec3> on_mass_;  // applied
  struct Act {
    Vec3 force, at;
  };
  std::vector<Act> acts_;  // of the current force
  std::vector<BodyMoment> turns_;
  std::optional<BodyMoments> moments_;
  bool all_are_vectors_ = false;  // so the remainder of m a is due to constraints
};

}  // namespace

void DrawnForces::add_outputs(system::EquationSystem& system) {
  Collection collection(mechanics_, drawing_, system);
  collection.run();
  names_ = std::move(collection.names);
  list_ = std::move(collection.list);
  omitted_count_ = collection.beyond;
  unknown_ = std::move(collection.unknown);
}

}  // namespace eomgen::analysis
