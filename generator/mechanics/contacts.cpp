// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb friction: which particle a constraint presses on, the directions in which it can slide there, and how fast it does.
#include <algorithm>
#include <functional>
#include <set>

#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/factorisation.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

using symbolic::SymbolKind;

class ContactReader {
 public:
  ContactReader(Mechanics& m, Lowering& lower) : m_(m), lower_(lower), dag_(*m.dag), expand_(dag_, 60) {}

  void read(const model::Constraint& constraint) {
    constraint_ = &constraint;
    contact_ = Contact{};
    contact_.name = constraint.name;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.constraints[k].name == constraint.name) contact_.constraints.push_back(k);
    }
    find_particle();
    find_tangents();
    const Vec3 v = lower_.ddt(lower_.position(contact_.place), constraint.friction->span);
    const Vec3 relative = lower_.subtract(v, lower_.vector(constraint.friction->surface_velocity));
    for (const Vec3& t : contact_.directions) {
      contact_.slip.push_back(lower_.dot(t, relative));
      contact_.tangents.emplace_back();
      for (std::uint32_t i = 0; i < m_.q.size(); ++i) contact_.tangents.back().push_back(tidy(lower_.dot(t, gradient(i))));
    }
    finish(*constraint.friction);
  }

  void read(const model::Force& force, const model::Dry& dry) {
    contact_ = Contact{};
    contact_.name = force.name;
    contact_.coordinate = dry.coordinate;
    contact_.normal = lower_.scalar(dry.normal);
    contact_.tangents.emplace_back(m_.q.size(), dag_.zero());
    contact_.tangents[0][dry.coordinate] = dag_.one();
    contact_.slip.push_back(m_.qdot[dry.coordinate]);
    finish(dry.law);
  }

 private:
  Ref tidy(Ref r) { return expand_.tidy(r); }
  Vec3 tidy(const Vec3& v) { return {tidy(v[0]), tidy(v[1]), tidy(v[2])}; }
  Vec3 gradient(std::uint32_t i) { return lower_.gradient(lower_.position(contact_.place), i); }
  const std::vector<Ref>& slope(std::size_t k) const { return m_.constraints[contact_.constraints[k]].gradient; }

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error("mechanics", m_.model->where(constraint_->friction->span), what, remedy);
  }

  std::set<std::uint32_t> coordinates_of(const Vec3& position) const {
    std::set<std::uint32_t> result;
    for (const symbolic::Symbol& s : dag_.symbols({position[0], position[1], position[2]})) {
      if (s.kind == SymbolKind::coordinate) result.insert(s.index);
    }
    return result;
  }

  // The particle with the fewest coordinates among those that have all coordinates of the constraint.
  void find_particle() {
    std::set<std::uint32_t> needed;
    for (std::size_t k = 0; k < contact_.constraints.size(); ++k) {
      for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
        if (!dag_.is_zero(slope(k)[i])) needed.insert(i);
      }
    }
    std::size_t fewest = 4;
    bool several = false;
    for (const model::Particle& particle : m_.model->particles) {
      const std::set<std::uint32_t> own = coordinates_of(lower_.position(particle.place));
      if (!std::includes(own.begin(), own.end(), needed.begin(), needed.end()) || own.size() > fewest) continue;
      several = own.size() == fewest;
      if (several) continue;
      fewest = own.size();
      contact_.place = particle.place;
      own_ = {own.begin(), own.end()};
    }
    if (contact_.place == 0 || fewest > 3) {
      fail("'" + contact_.name + "' touches no particle: none has all coordinates of the constraint, and at most three",
           "friction acts where a particle is held on a surface or a curve; for a coordinate alone write a force dry = { .. }");
    }
    if (several) {
      fail("several particles have the coordinates of '" + contact_.name + "', so that it is open which of them rubs",
           "write the constraint in coordinates of one particle");
    }
  }

  // a_i - (psi_i / psi_c) a_c lies in the surface; c is a coordinate on which psi depends.
  void find_tangents() {
    const std::size_t equations = contact_.constraints.size();
    if (own_.size() <= equations) {
      fail("'" + contact_.name + "' leaves its particle no direction to slide in", "remove the friction, or free a coordinate");
    }
    std::vector<Vec3> a;
    for (const std::uint32_t i : own_) a.push_back(gradient(i));
    const std::vector<Vec3> normals = gradients(a);
    for (const Vec3& x : normals) {
      for (const Vec3& y : normals) contact_.gram.push_back(tidy(lower_.dot(x, y)));
    }
    if (equations == 2) {
      contact_.directions.push_back(unit(symbolic::cross(dag_, normals[0], normals[1])));
      return;
    }
    std::size_t c = own_.size();
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (!dag_.is_zero(slope(0)[own_[i]])) c = i;
    }
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (i == c || contact_.directions.size() == 1) continue;
      const Ref share = dag_.div(slope(0)[own_[i]], slope(0)[own_[c]]);
      contact_.directions.push_back(unit(lower_.subtract(a[i], lower_.scale(share, a[c]))));
    }
    if (own_.size() == 3) contact_.directions.push_back(tidy(symbolic::cross(dag_, unit(normals[0]), contact_.directions[0])));
  }

  /// grad psi_k = sum psi_i a^ij a_j over the coordinates of the particle, (1.22).
  std::vector<Vec3> gradients(const std::vector<Vec3>& a) {
    const std::size_t n = a.size();
    std::vector<Ref> metric(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) metric[i * n + j] = metric[j * n + i] = tidy(lower_.dot(a[i], a[j]));
    }
    if (dag_.is_zero(metric[0])) fail("the particle of '" + contact_.name + "' does not move", "remove the friction");
    const symbolic::Factorisation factors(dag_, metric, n, symbolic::Ties::ascending);
    std::vector<Vec3> result;
    for (std::size_t k = 0; k < contact_.constraints.size(); ++k) {
      std::vector<Ref> lower_components;
      for (const std::uint32_t i : own_) lower_components.push_back(slope(k)[i]);
      const std::vector<Ref> upper = factors.backward(factors.forward(lower_components));
      Vec3 sum = symbolic::zero_vector(dag_);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = dag_.add(sum[axis], dag_.mul(upper[i], a[i][axis]));
      }
      result.push_back(tidy(sum));
    }
    return result;
  }

  Vec3 unit(const Vec3& v) {
    const Ref length = dag_.call(symbolic::Op::sqrt, tidy(lower_.dot(v, v)));
    return tidy(lower_.scale(dag_.div(dag_.one(), length), v));
  }

  void finish(const model::Friction& law) {
    contact_.first = 0;
    for (const Contact& before : m_.contacts) contact_.first += static_cast<std::uint32_t>(before.dimensions());
    Ref squares = dag_.zero();
    for (const Ref w : contact_.slip) squares = dag_.add(squares, dag_.mul(w, w));
    lower_.set_slip(contact_.slip.size() == 1 ? dag_.call(symbolic::Op::abs, contact_.slip[0])
                                              : dag_.call(symbolic::Op::sqrt, squares));
    contact_.static_coefficient = lower_.scalar(law.static_coefficient);
    contact_.dynamic_coefficient = lower_.scalar(law.dynamic_coefficient);
    m_.contacts.push_back(std::move(contact_));
  }

  Mechanics& m_;
  Lowering& lower_;
  Dag& dag_;
  symbolic::Expander expand_;
  const model::Constraint* constraint_ = nullptr;
  std::vector<std::uint32_t> own_;  // coordinates of the particle
  Contact contact_;
};

constexpr std::size_t most_contacts = 3;  // the mode of an emitted function has room for no more (docs/abi.md)

[[noreturn]] void refuse_more(const Mechanics& m, const model::Span& span) {
  throw Error("mechanics", m.model->where(span), "this is the fourth contact with friction",
              "a model may have three: the number of modes grows with every one");
}

const model::Friction& law_of(const Mechanics& m, const Contact& contact) {
  for (const model::Constraint& constraint : m.model->constraints) {
    if (constraint.name == contact.name && constraint.friction) return *constraint.friction;
  }
  const auto named = [&](const model::Force& force) { return force.name == contact.name; };
  return std::get<model::Dry>(std::find_if(m.model->forces.begin(), m.model->forces.end(), named)->kind).law;
}

}  // namespace

void check_coefficients(const Mechanics& m) {
  constexpr int digits = 30;
  // A parameter may use others, declared before or after it, without cycles.
  const std::function<cln::cl_R(const symbolic::Symbol&)> value = [&](const symbolic::Symbol& symbol) {
    return symbolic::evaluate(*m.dag, {m.parameter_value.at(symbol.index)}, value, digits)[0];
  };
  for (const Contact& contact : m.contacts) {
    const std::vector<Ref> both{contact.static_coefficient, contact.dynamic_coefficient};
    const std::vector<symbolic::Symbol> symbols = m.dag->symbols(both);
    if (std::any_of(symbols.begin(), symbols.end(), [](const auto& s) { return s.kind != SymbolKind::parameter; })) continue;
    const std::vector<cln::cl_R> mu = symbolic::evaluate(*m.dag, both, value, digits);
    if (!cln::minusp(mu[0]) && !cln::minusp(mu[1]) && mu[0] >= mu[1]) continue;
    const bool negative = cln::minusp(mu[0]) || cln::minusp(mu[1]);
    throw Error("mechanics", m.model->where(law_of(m, contact).span),
                negative ? "a coefficient of friction of '" + contact.name + "' is negative"
                         : "the static coefficient of friction of '" + contact.name + "' is less than the dynamic one",
                negative ? "friction opposes slip: give coefficients of 0 or more"
                         : "what sticks at a force must not be dragged loose by less: give static >= dynamic");
  }
}

void add_contacts(Mechanics& m, Lowering& lower) {
  ContactReader reader(m, lower);
  for (const model::Constraint& constraint : m.model->constraints) {
    if (!constraint.friction) continue;
    if (m.contacts.size() == most_contacts) refuse_more(m, constraint.friction->span);
    reader.read(constraint);
  }
  for (const model::Force& force : m.model->forces) {
    const auto* dry = std::get_if<model::Dry>(&force.kind);
    if (dry == nullptr) continue;
    if (m.contacts.size() == most_contacts) refuse_more(m, dry->law.span);
    reader.read(force, *dry);
  }
}

}  // namespace eomgen::mechanics
