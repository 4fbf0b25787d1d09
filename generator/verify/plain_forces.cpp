// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/plain_forces.hpp"

#include <cln/real.h>

#include "verify/uses.hpp"

namespace eomgen::verify {
namespace {

using model::no_node;
using model::NodeId;

Vector slope(const Vector& v, unsigned level, std::size_t i) {
  return {v[0].slope(level, i), v[1].slope(level, i), v[2].slope(level, i)};
}

/// Adds the generalised force of each kind, (2.74): Q_i = F . dr/dq_i.
class Forces {
 public:
  Forces(const model::Model& model, const Precision& precision, Interpreter& now, std::vector<Residual>& sums)
      : model_(model), precision_(precision), now_(now), by_q_(now.by_coordinates(false)), sums_(sums) {}

  void operator()(const model::Gravity& gravity) {
    const Vector g = now_.vector(gravity.acceleration);
    for (const model::Particle& p : model_.particles) apply(now_.scalar(p.mass) * g, by_q_.place(p.place));
  }
  void operator()(const model::CentralGravity& gravity) {
    for (const model::Particle& p : model_.particles) {
      const Jet strength = now_.scalar(gravity.GM) * now_.scalar(p.mass);
      attract(strength, now_.place(p.place) - now_.vector(gravity.center),
              by_q_.place(p.place) - by_q_.vector(gravity.center));
    }
  }
  void operator()(const model::Gravitation& gravity) {
    const auto& all = model_.particles;
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
  void operator()(const model::Dry&) {}  // with the contacts (State::friction)
  void operator()(const model::Generalized& generalized) {
    for (const auto& [coordinate, force] : generalized.components)
      sums_[coordinate].add(-now_.scalar(force).real());
  }

 private:
  /// F . dr/dq_i; the size of the term is that of its factors
  void apply(const Vector& force, const Vector& r) {
    Real size = 0;
    for (const Jet& component : force) size = size + cln::abs(component.real());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const Vector tangent = slope(r, by_q_.level(), i);
      Real length = 0;
      for (const Jet& component : tangent) length = length + cln::abs(component.real());
      sums_[i].add(-dot(force, tangent).real(), size * length);
    }
  }
  /// F dx/dq_i of one component
  void work(const Jet& force, const Jet& x) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i].add(-(force * x.slope(by_q_.level(), i)).real());
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
    for (const model::Particle& p : model.particles)
      terms.push_back(-(at.scalar(p.mass) * dot(g, at.place(p.place))));
  }
  void operator()(const model::CentralGravity& gravity) {
    for (const model::Particle& p : model.particles) {
      const Jet R = norm(at.place(p.place) - at.vector(gravity.center), precision);
      terms.push_back(-(at.scalar(gravity.GM) * at.scalar(p.mass)) / R);
    }
  }
  void operator()(const model::Gravitation& gravity) {
    const auto& all = model.particles;
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
};

}  // namespace

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
