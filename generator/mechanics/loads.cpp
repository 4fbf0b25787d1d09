// SPDX-License-Identifier: GPL-3.0-or-later
// Forces: what has a potential goes into U, everything else becomes a load at a point or a generalised force.
#include "mechanics/direction.hpp"
#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::SymbolKind;

class ForceReader {
 public:
  ForceReader(Mechanics& mechanics, Lowering& lower) : m_(mechanics), lower_(lower), dag_(*mechanics.dag) {}

  void read(std::size_t index) {
    force_ = &m_.model->forces[index];
    const std::size_t first_load = m_.loads.size();
    potential_ = dag_.zero();
    generalized_.assign(m_.q.size(), dag_.zero());
    std::visit([this](const auto& kind) { add(kind); }, force_->kind);
    refuse_if_idle(first_load);
    m_.potential_by_force.push_back(potential_);
    m_.potential = dag_.add(m_.potential, potential_);
    m_.force_components.push_back(components(first_load));
  }

 private:
  using Points = std::vector<PointMass>;

  void add(const model::Gravity& gravity) {
    require_masses();
    const Vec3 g = lower_.vector(gravity.acceleration);
    const bool uniform = !depends_on_state({g[0], g[1], g[2]});
    for (const PointMass& mass : m_.masses) {
      if (uniform) {
        potential_ = dag_.sub(potential_, dag_.mul(mass.mass, lower_.dot(g, mass.position)));  // U = -m g.r
      } else {
        load(lower_.scale(mass.mass, g), mass.position);
      }
    }
  }
  void add(const model::CentralGravity& gravity) {
    require_masses();
    const Ref GM = lower_.scalar(gravity.GM);
    const Vec3 center = lower_.vector(gravity.center);
    for (const PointMass& mass : m_.masses) {
      const Ref distance = lower_.norm(lower_.subtract(mass.position, center));
      potential_ = dag_.sub(potential_, dag_.div(dag_.mul(GM, mass.mass), distance));
    }
    for (std::size_t b = 0; b < m_.spins.size() && gravity.order == 2; ++b) {  // (7.71)
      const Spin& spin = m_.spins[b];
      const Vec3 d = lower_.subtract(lower_.position(m_.model->bodies[b].place), center);
      const std::array<Ref, 3> along{lower_.dot(d, spin.axes[0]), lower_.dot(d, spin.axes[1]),
                                     lower_.dot(d, spin.axes[2])};
      const std::array<Ref, 3> J = times(dag_, spin, along);
      Ref dJd = dag_.zero();
      for (std::size_t k = 0; k < 3; ++k) dJd = dag_.add(dJd, dag_.mul(along[k], J[k]));
      const Ref R = lower_.norm(d);
      const Ref trace = dag_.add(spin.J[0][0], dag_.add(spin.J[1][1], spin.J[2][2]));
      const Ref bracket = dag_.sub(dag_.div(dag_.mul(dag_.integer(3), dJd), dag_.power(R, 2)), trace);
      potential_ = dag_.add(potential_, dag_.div(dag_.mul(GM, bracket), dag_.mul(dag_.integer(2), dag_.power(R, 3))));
    }
  }
  void add(const model::Gravitation& gravity) {
    require_masses();
    const Ref G = lower_.scalar(gravity.G);
    for (std::size_t i = 0; i < m_.masses.size(); ++i) {
      for (std::size_t k = i + 1; k < m_.masses.size(); ++k) {
        const Ref distance = lower_.norm(lower_.subtract(m_.masses[i].position, m_.masses[k].position));
        const Ref masses = dag_.mul(m_.masses[i].mass, m_.masses[k].mass);
        potential_ = dag_.sub(potential_, dag_.div(dag_.mul(G, masses), distance));
      }
    }
  }
  void add(const model::AppliedForce& applied) { load(lower_.vector(applied.force), lower_.vector(applied.at)); }
  void add(const model::Spring& spring) {
    const Vec3 along = lower_.subtract(lower_.vector(spring.a), lower_.vector(spring.b));
    const Ref length = lower_.scalar(spring.length);
    if (spring.energy == model::no_node) {
      // Of no free length: no square root, and no singular point.
      const Ref extension_squared =
          dag_.is_zero(length) ? lower_.dot(along, along) : dag_.power(dag_.sub(lower_.norm(along), length), 2);
      potential_ = dag_.div(dag_.mul(lower_.scalar(spring.stiffness), extension_squared), dag_.integer(2));
    } else {
      lower_.set_extension(dag_.sub(lower_.norm(along), length));
      potential_ = lower_.scalar(spring.energy);
    }
    require_potential();
  }
  void add(const model::Damper& damper) {
    const Vec3 a = lower_.vector(damper.a), b = lower_.vector(damper.b);
    const Vec3 along = lower_.subtract(a, b);
    if (const auto w = direction(lower_, dag_, m_.q.size(), along)) {
      // Points that may meet: c (w . v)/(w . w) w with the line w between them has a value there too.
      const Ref size = symbolic::tidy(dag_, lower_.dot(*w, *w)), rate = lower_.dot(*w, lower_.ddt(along, force_->span));
      const Ref pull = dag_.div(dag_.mul(lower_.scalar(damper.coefficient), symbolic::simpler(dag_, rate, 60)), size);
      load(lower_.scale(dag_.neg(pull), *w), a);
      load(lower_.scale(pull, *w), b);
      return;
    }
    const Ref distance = lower_.norm(along);
    const Ref rate = lower_.ddt(distance, force_->span);
    const Ref tension = dag_.mul(lower_.scalar(damper.coefficient), rate);
    const Vec3 pull = lower_.scale(dag_.div(tension, distance), along);
    load(lower_.scale(dag_.integer(-1), pull), a);
    load(pull, b);
  }
  void add(const model::Torsion& torsion) {
    const Ref angle = lower_.scalar(torsion.angle);
    if (torsion.stiffness != model::no_node) {
      const Ref twist = dag_.sub(angle, lower_.scalar(torsion.rest));
      potential_ = dag_.div(dag_.mul(lower_.scalar(torsion.stiffness), dag_.power(twist, 2)), dag_.integer(2));
      require_potential();
    }
    if (torsion.coefficient == model::no_node) return;
    const Ref moment = dag_.neg(dag_.mul(lower_.scalar(torsion.coefficient), lower_.ddt(angle, force_->span)));
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial(dag_, {SymbolKind::coordinate, i, 0});
      generalized_[i] = dag_.add(generalized_[i], dag_.mul(moment, by(angle)));
    }
  }
  void add(const model::Drag& drag) {  // -(1/2) rho A C |v| v, eq. (8.53)
    const Vec3 at = lower_.vector(drag.on);
    const Vec3 v = lower_.ddt(at, force_->span);
    Ref factor =
        dag_.mul(lower_.scalar(drag.density), dag_.mul(lower_.scalar(drag.area), lower_.scalar(drag.coefficient)));
    factor = dag_.mul(dag_.constant(symbolic::Rational(-1) / 2), dag_.mul(factor, lower_.norm(v)));
    load(lower_.scale(factor, v), at);
  }
  void add(const model::Generalized& generalized) {
    for (const auto& [coordinate, force] : generalized.components) {
      generalized_[coordinate] = dag_.add(generalized_[coordinate], lower_.scalar(force));
    }
  }

  void add(const model::Moment& applied) {  // Q_i = M . dw/dqdot_i, eq. (9.2)
    const Vec3 moment = lower_.vector(applied.moment), w = lower_.angular_velocity(applied.frame);
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      symbolic::Derivation by = symbolic::partial(dag_, {SymbolKind::coordinate, i, 1});
      generalized_[i] = dag_.add(generalized_[i], lower_.dot(moment, Vec3{by(w[0]), by(w[1]), by(w[2])}));
    }
  }
  void add(const model::Magnus& magnus) {  // m c w x v, eq. (8.52)
    const model::Body& body = m_.model->bodies[magnus.body];
    const Vec3 at = lower_.position(body.place);
    const Vec3 lift = lower_.cross(lower_.angular_velocity(body.frame), lower_.ddt(at, force_->span));
    load(lower_.scale(dag_.mul(lower_.scalar(body.mass), lower_.scalar(magnus.coefficient)), lift), at);
  }
  void add(const model::Dry&) {}  // a contact (contacts.cpp)

  void load(const Vec3& force, const Vec3& at) {
    m_.loads.push_back({force_->name, force, at, lower_.ddt(at, force_->span)});
  }
  void require_masses() const {
    if (m_.masses.empty()) {
      fail("this force acts on masses, and the model has none",
           "add a [[particle]] or [[body]], or put the potential into [energy]");
    }
  }
  void require_potential() const {
    for (const symbolic::Symbol& symbol : dag_.symbols({potential_})) {
      if (symbol.kind == SymbolKind::input || (symbol.kind == SymbolKind::coordinate && symbol.order > 0)) {
        fail("the energy of a spring may depend on positions, parameters and time only",
             "write a force that depends on velocities or inputs as force = \"...\"");
      }
    }
  }
  bool depends_on_state(const std::vector<Ref>& expressions) const {
    for (const symbolic::Symbol& symbol : dag_.symbols(expressions)) {
      if (symbol.kind == SymbolKind::coordinate || symbol.kind == SymbolKind::input) return true;
    }
    return false;
  }
  // Q_i = F . dr/dq_i, eq. (3.20)
  std::vector<Ref> components(std::size_t first_load) const {
    std::vector<Ref> Q = generalized_;
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      for (std::size_t k = first_load; k < m_.loads.size(); ++k) {
        Q[i] = dag_.add(Q[i], lower_.dot(m_.loads[k].force, lower_.gradient(m_.loads[k].at, i)));
      }
    }
    return Q;
  }
  // A force that enters no equation is a mistake of the model, not something to drop silently.
  void refuse_if_idle(std::size_t first_load) const {
    std::vector<Ref> effect = components(first_load);
    for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
      effect.push_back(symbolic::partial(dag_, {SymbolKind::coordinate, i, 0})(potential_));
    }
    if (!std::holds_alternative<model::Dry>(force_->kind) && vanishes(dag_, effect)) {
      fail("'" + force_->name + "' changes no equation of motion: it does no work in any motion of the coordinates",
           "check its direction and the point it acts on, or remove it");
    }
  }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error("mechanics", m_.model->where(force_->span), what, remedy);
  }

  Mechanics& m_;
  Lowering& lower_;
  Dag& dag_;
  const model::Force* force_ = nullptr;
  Ref potential_;
  std::vector<Ref> generalized_;
};

}  // namespace

void add_forces(Mechanics& mechanics, Lowering& lower) {
  mechanics.potential = lower.scalar(mechanics.model->energy.potential);
  ForceReader reader(mechanics, lower);
  for (std::size_t i = 0; i < mechanics.model->forces.size(); ++i) reader.read(i);
}

}  // namespace eomgen::mechanics
