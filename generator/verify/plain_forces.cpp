// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/plain_forces.hpp"

#include <cln/real.h>

#include <set>

#include "verify/uses.hpp"

namespace eomgen::verify {
namespace {

using model::no_node;
using model::NodeId;

Vector slope(const Vector& v, unsigned level, std::size_t i) {
  return {v[0].slope(level, i), v[1].slope(level, i), v[2].slope(level, i)};
}

Jet trace(const model::Body& body, Interpreter& at) {
  return at.scalar(body.inertia[0][0]) + at.scalar(body.inertia[1][1]) + at.scalar(body.inertia[2][2]);
}

/// Adds the generalised force of each kind, (2.74): Q_i = F . dr/dq_i.
class Forces {
 public:
  Forces(const model::Model& model, const Precision& precision, Interpreter& now, std::vector<Residual>& sums)
      : model_(model), precision_(precision), now_(now), by_q_(now.by_coordinates(false)), sums_(sums) {}

  void operator()(const model::Gravity& gravity) {
    const Vector g = now_.vector(gravity.acceleration);
    for (const Mass& p : masses(model_)) apply(now_.scalar(p.mass) * g, by_q_.place(p.place));
  }
  void operator()(const model::CentralGravity& gravity) {
    for (const model::Body& body : model_.bodies) {
      if (gravity.order == 2) attract_extended(gravity, body);
    }
    for (const Mass& p : masses(model_)) {
      const Jet strength = now_.scalar(gravity.GM) * now_.scalar(p.mass);
      attract(strength, now_.place(p.place) - now_.vector(gravity.center),
              by_q_.place(p.place) - by_q_.vector(gravity.center));
    }
  }
  void operator()(const model::Gravitation& gravity) {
    const std::vector<Mass> all = masses(model_);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        const Jet strength = now_.scalar(gravity.G) * now_.scalar(all[i].mass) * now_.scalar(all[k].mass);
        attract(strength, now_.place(all[i].place) - now_.place(all[k].place),
                by_q_.place(all[i].place) - by_q_.place(all[k].place));
      }
  }
  void operator()(const model::AppliedForce& applied) { apply(now_.vector(applied.force), by_q_.vector(applied.at)); }
  void operator()(const model::Spring& spring) {
    if (spring.energy != no_node) {
      Interpreter own = by_q_.for_spring(spring);
      descend(own.scalar(spring.energy));
      return;
    }
    const Jet stiffness = by_q_.scalar(spring.stiffness);
    if (by_q_.scalar(spring.length).exactly_zero()) {  // no free length: -K d . dd/dq_i, smooth where the ends meet
      const Vector d = by_q_.vector(spring.b) - by_q_.vector(spring.a);
      const Jet K = stiffness.value(by_q_.level());
      for (const Jet& component : d) work(-(K * component.value(by_q_.level())), component);
      work(dot(d, d).value(by_q_.level()) / -2, stiffness);
      return;
    }
    stretch(stiffness, by_q_.extension(spring));
  }
  void operator()(const model::Damper& damper) {
    Interpreter& later = now_.along_time();
    const Jet length = norm(later.vector(damper.b) - later.vector(damper.a), precision_);
    const Jet tension = now_.scalar(damper.coefficient) * length.slope(later.level(), 0);
    const Vector along = now_.vector(damper.b) - now_.vector(damper.a);
    const Vector on_b = (-tension / norm(along, precision_)) * along;
    apply(on_b, by_q_.vector(damper.b) - by_q_.vector(damper.a));
  }
  void operator()(const model::Torsion& torsion) {
    const Jet angle = by_q_.scalar(torsion.angle);
    if (torsion.stiffness != no_node) stretch(by_q_.scalar(torsion.stiffness), angle - by_q_.scalar(torsion.rest));
    if (torsion.coefficient != no_node) {
      Interpreter& later = now_.along_time();
      const Jet rate = later.scalar(torsion.angle).slope(later.level(), 0);
      work(-(now_.scalar(torsion.coefficient) * rate), angle);
    }
  }
  void operator()(const model::Drag& drag) {  // (8.53)
    Interpreter& later = now_.along_time();
    const Vector v = slope(later.vector(drag.on), later.level(), 0);
    const Jet factor = now_.scalar(drag.density) * now_.scalar(drag.area) * now_.scalar(drag.coefficient) / -2;
    apply((factor * norm(v, precision_)) * v, by_q_.vector(drag.on));
  }
  void operator()(const model::Moment& moment) { turn(now_.vector(moment.moment), moment.frame); }
  void operator()(const model::Magnus& magnus) {  // (8.52)
    const model::Body& body = model_.bodies[magnus.body];
    Interpreter& later = now_.along_time();
    const Vector v = slope(later.place(body.place), later.level(), 0);
    const Jet factor = now_.scalar(body.mass) * now_.scalar(magnus.coefficient);
    apply(factor * cross(now_.angular_velocity(body.frame), v), by_q_.place(body.place));
  }
  void operator()(const model::Dry&) {}  // with the contacts (State::friction)
  void operator()(const model::Generalized& generalized) {
    for (const auto& [coordinate, force] : generalized.components) sums_[coordinate].add(-now_.scalar(force).real());
  }

 private:
  /// F . dr/dq_i; the size of the term is that of its factors
  void apply(const Vector& force, const Vector& r) {
    Real size = 0;
    for (const Jet& component : force) size = size + cln::abs(component.real());
    for (const std::size_t i : directions({&r[0], &r[1], &r[2]})) {
      const Vector tangent = slope(r, by_q_.level(), i);
      Real length = 0;
      for (const Jet& component : tangent) length = length + cln::abs(component.real());
      sums_[i].add(-dot(force, tangent).real(), size * length);
    }
  }
  /// M . dw/dqdot_i
  void turn(const Vector& moment, std::uint32_t frame) {
    const auto size = [](const Vector& v) {
      return Real(cln::abs(v[0].real()) + cln::abs(v[1].real()) + cln::abs(v[2].real()));
    };
    std::vector<const Jet*> components;
    std::array<Vector, 3> axes;
    for (std::size_t k = 0; k < 3; ++k) axes[k] = by_q_.axis(frame, k);
    for (const Vector& axis : axes)
      for (const Jet& component : axis) components.push_back(&component);
    for (const std::size_t i : directions(components)) {
      const Vector rotation = now_.virtual_rotation(frame, i);
      sums_[i].add(-dot(moment, rotation).real(), size(moment) * size(rotation));
    }
  }
  /// The coordinates that move any of these.
  std::set<std::size_t> directions(const std::vector<const Jet*>& jets) const {
    std::set<std::size_t> result;
    for (const Jet* jet : jets)
      for (const std::size_t i : jet->directions(by_q_.level())) result.insert(i);
    return result;
  }
  /// What the inertia of a body adds to Newton's attraction, and the moment, eq. (7.72).
  void attract_extended(const model::CentralGravity& gravity, const model::Body& body) {
    const Vector d = now_.place(body.place) - now_.vector(gravity.center);
    const Jet R = norm(d, precision_), GM = now_.scalar(gravity.GM);
    const Vector c = (Jet(1) / R) * d, Jc = inertia_times(body, now_, c);
    const Jet along = trace(body, now_) - Jet(5) * dot(c, Jc);
    const Vector force = (Jet(-3) * GM / (Jet(2) * R * R * R * R)) * (Jet(2) * Jc + along * c);
    apply(force, by_q_.place(body.place) - by_q_.vector(gravity.center));
    turn((Jet(3) * GM / (R * R * R)) * cross(c, Jc), body.frame);
  }
  /// F dx/dq_i of one component
  void work(const Jet& force, const Jet& x) {
    for (const std::size_t i : x.directions(by_q_.level())) sums_[i].add(-(force * x.slope(by_q_.level(), i)).real());
  }
  /// Newton's attraction along d, on both ends.
  void attract(const Jet& strength, const Vector& d, const Vector& d_by_q) {
    const Jet distance = norm(d, precision_);
    apply((-strength / (distance * distance * distance)) * d, d_by_q);
  }
  /// Tension K e through de, and what a stiffness that depends on the place adds.
  void stretch(const Jet& stiffness, const Jet& extension) {
    const Jet K = stiffness.value(by_q_.level());
    const Jet e = extension.value(by_q_.level());
    work(-(K * e), extension);
    work(e * e / -2, stiffness);
  }
  void descend(const Jet& energy) { work(Jet(-1), energy); }

  const model::Model& model_;
  const Precision& precision_;
  Interpreter& now_;
  Interpreter& by_q_;
  std::vector<Residual>& sums_;
};

struct Potentials {
  const model::Model& model;
  const Precision& precision;
  Interpreter& at;
  std::vector<Jet>& terms;

  void operator()(const model::Gravity& gravity) {
    const auto moves = [](const model::Node& node) {
      return node.op == model::Op::coordinate || node.op == model::Op::input;
    };
    if (uses(model, gravity.acceleration, moves)) return;  // not a uniform field
    const Vector g = at.vector(gravity.acceleration);
    for (const Mass& p : masses(model)) terms.push_back(-(at.scalar(p.mass) * dot(g, at.place(p.place))));
  }
  void operator()(const model::CentralGravity& gravity) {
    for (const Mass& p : masses(model)) {
      const Jet R = norm(at.place(p.place) - at.vector(gravity.center), precision);
      terms.push_back(-(at.scalar(gravity.GM) * at.scalar(p.mass)) / R);
    }
    for (const model::Body& body : model.bodies) {  // (7.71)
      if (gravity.order != 2) continue;
      const Vector d = at.place(body.place) - at.vector(gravity.center);
      const Jet R = norm(d, precision);
      const Jet half = at.scalar(gravity.GM) / (Jet(2) * R * R * R);
      terms.push_back(-(half * trace(body, at)));
      terms.push_back(Jet(3) * half * dot(d, inertia_times(body, at, d)) / (R * R));
    }
  }
  void operator()(const model::Gravitation& gravity) {
    const std::vector<Mass> all = masses(model);
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        const Jet R = norm(at.place(all[i].place) - at.place(all[k].place), precision);
        terms.push_back(-(at.scalar(gravity.G) * at.scalar(all[i].mass) * at.scalar(all[k].mass)) / R);
      }
  }
  void operator()(const model::Spring& spring) {
    if (spring.energy != no_node) {
      Interpreter own = at.for_spring(spring);
      terms.push_back(own.scalar(spring.energy));
      return;
    }
    const Vector d = at.vector(spring.b) - at.vector(spring.a);
    const bool free_length = !at.scalar(spring.length).exactly_zero();
    const Jet e = free_length ? at.extension(spring) : Jet();
    terms.push_back(at.scalar(spring.stiffness) * (free_length ? e * e : dot(d, d)) / 2);
  }
  void operator()(const model::Torsion& torsion) {
    if (torsion.stiffness == no_node) return;
    const Jet e = at.scalar(torsion.angle) - at.scalar(torsion.rest);
    terms.push_back(at.scalar(torsion.stiffness) * e * e / 2);
  }
  void operator()(const model::AppliedForce&) {}
  void operator()(const model::Damper&) {}
  void operator()(const model::Drag&) {}
  void operator()(const model::Generalized&) {}
  void operator()(const model::Dry&) {}
  void operator()(const model::Moment&) {}
  void operator()(const model::Magnus&) {}
};

}  // namespace

std::vector<Mass> masses(const model::Model& model) {
  std::vector<Mass> result;
  for (const model::Particle& particle : model.particles) result.push_back({particle.place, particle.mass});
  for (const model::Body& body : model.bodies) result.push_back({body.place, body.mass});
  return result;
}

Vector inertia_times(const model::Body& body, Interpreter& at, const Vector& v) {
  Vector sum;
  for (std::size_t i = 0; i < 3; ++i) {
    Jet component;
    for (std::size_t k = 0; k < 3; ++k)
      component = component + at.scalar(body.inertia[i][k]) * dot(at.axis(body.frame, k), v);
    sum = sum + component * at.axis(body.frame, i);
  }
  return sum;
}

void subtract_forces(const model::Model& model, const Precision& precision, Interpreter& now,
                     std::vector<Residual>& sums) {
  Forces forces(model, precision, now, sums);
  for (const model::Force& force : model.forces) std::visit(forces, force.kind);
}

std::vector<Jet> potentials(const model::Model& model, const Precision& precision, Interpreter& at) {
  std::vector<Jet> terms;
  if (model.energy.potential != no_node) terms.push_back(at.scalar(model.energy.potential));
  Potentials visitor{model, precision, at, terms};
  for (const model::Force& force : model.forces) std::visit(visitor, force.kind);
  return terms;
}

}  // namespace eomgen::verify
