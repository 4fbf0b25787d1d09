// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts: the particle of a constraint with friction, its directions of slip, and the slip velocity.
#include <algorithm>
#include <functional>
#include <set>

#include "lists.hpp"
#include "mechanics/imposition.hpp"
#include "mechanics/stages.hpp"
#include "mechanics/vanishes.hpp"
#include "model/lone_parameter.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/factorisation.hpp"
#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

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
    contact_.unilateral = constraint.unilateral;
    contact_.restitution =
        constraint.restitution == model::no_node ? dag_.zero() : lower_.scalar(constraint.restitution);
    if (constraint.contact) {
      contact_.body_contact = static_cast<std::uint32_t>(&constraint - m_.model->constraints.data());
      contact_.rolls = rolls(*constraint.contact);
    }
    if (!constraint.friction) return add();
    if (constraint.contact) return read_body(*constraint.contact, *constraint.friction);
    find_place();
    choose_basis();
    find_tangents();
    const Vec3 v = lower_.ddt(lower_.position(contact_.place), constraint.friction->span);
    const Vec3 relative = lower_.subtract(v, lower_.vector(constraint.friction->surface_velocity));
    for (const Vec3& t : contact_.directions) {
      contact_.slip.push_back(lower_.dot(t, relative));
      contact_.tangents.emplace_back();
      for (std::uint32_t i = 0; i < m_.q.size(); ++i)
        contact_.tangents.back().push_back(tidy(lower_.dot(t, gradient(i))));
    }
    finish(*constraint.friction);
  }

  void read(const model::Force& force, const model::DryFriction& dry) {
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
  // The contact point of the body has F . dv/dqdot_i and its counterpart the opposite, so the slip velocity v gives
  // both at once.
  void read_body(const model::BodyContact& contact, const model::Friction& law) {
    contact_.place = contact.place;
    contact_.gram = {dag_.one()};
    Vec3 slip = lower_.vector(contact.slip);
    if (law.surface_velocity != model::no_node) slip = lower_.subtract(slip, lower_.vector(law.surface_velocity));
    for (std::uint32_t a = 0; a < 2; ++a) {
      const Vec3 t = lower_.vector(contact.tangents[a]);
      const Ref w = lower_.dot(t, slip);
      std::vector<Ref> slopes;
      for (std::uint32_t i = 0; i < m_.q.size(); ++i)
        slopes.push_back(symbolic::partial_derivative(dag_, {SymbolKind::coordinate, i, 1})(w));
      contact_.directions.push_back(t);
      contact_.tangent_indices.push_back(a);
      contact_.slip.push_back(w);
      contact_.tangents.push_back(std::move(slopes));
    }
    finish(law);
  }
  bool rolls(const model::BodyContact& contact) {
    if (contact.rolling) return true;
    const Vec3 tangential_velocity = lower_.vector(contact.tangential_velocity);
    return !vanishes(dag_, {tangential_velocity[0], tangential_velocity[1], tangential_velocity[2]});
  }

  Ref tidy(Ref r) { return expand_.expand_or_keep(r); }
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

  std::vector<std::uint32_t> named_places() const {
    std::set<std::uint32_t> bodies, found;
    for (const model::Body& body : m_.model->bodies) bodies.insert(body.place);
    std::set<model::NodeId> seen{model::no_node};
    std::vector<model::NodeId> stack = constraint_->psi;
    while (!stack.empty()) {
      const model::NodeId id = stack.back();
      stack.pop_back();
      if (!seen.insert(id).second) continue;
      const model::Node& node = m_.model->arena[id];
      if (node.op == model::Op::place && node.index != 0 && !bodies.contains(node.index)) found.insert(node.index);
      if (node.op == model::Op::definition) stack.push_back(m_.model->definitions[node.index].expression);
      stack.insert(stack.end(), node.args.begin(), node.args.end());
    }
    return {found.begin(), found.end()};
  }
  std::vector<std::uint32_t> particle_places() const { return mapped(m_.model->particles, &model::Particle::place); }

  // A particle or point that the constraint names, or else a particle; with the fewest coordinates among those that
  // have all coordinates of the constraint.
  void find_place() {
    std::set<std::uint32_t> needed;
    for (std::size_t k = 0; k < contact_.constraints.size(); ++k) {
      for (std::uint32_t i = 0; i < m_.q.size(); ++i) {
        if (!dag_.is_zero(slope(k)[i])) needed.insert(i);
      }
    }
    if (choose_place(named_places(), needed) || choose_place(particle_places(), needed)) return;
    fail("'" + contact_.name + "' is in contact with no particle: none has all coordinates of the constraint",
         "friction acts where a particle or a point is held on a surface or a curve: write the constraint with it, as "
         "dot(P, E1); for a coordinate alone write a force dry = { .. }");
  }
  bool choose_place(const std::vector<std::uint32_t>& places, const std::set<std::uint32_t>& needed) {
    std::size_t fewest = m_.q.size() + 1;
    bool several = false;
    for (const std::uint32_t place : places) {
      const std::set<std::uint32_t> own = coordinates_of(lower_.position(place));
      if (!std::includes(own.begin(), own.end(), needed.begin(), needed.end()) || own.size() > fewest) continue;
      several = own.size() == fewest;
      if (several) continue;
      fewest = own.size();
      contact_.place = place;
      own_ = {own.begin(), own.end()};
    }
    if (several) {
      fail("several particles have the coordinates of '" + contact_.name +
               "', so that it is open which of them has the friction",
           "write the constraint with the position of one particle or point, as dot(P, E1)");
    }
    return contact_.place != 0;
  }

  /// Limits own_ to coordinates whose vectors a_i are independent and span all others: a point of a mechanism in the
  /// plane may depend on any number of coordinates. Throws Error if psi is no function of the particle's position.
  void choose_basis() {
    const std::vector<std::uint32_t> all = own_;
    own_.clear();
    for (const std::uint32_t i : all) {
      if (extends_basis(gradient(i))) own_.push_back(i);
    }
    if (own_.empty()) fail("the particle of '" + contact_.name + "' does not move", "remove the friction");
    if (own_.size() == all.size()) return;
    std::vector<Vec3> a = mapped(own_, [&](std::uint32_t i) { return gradient(i); });
    const std::vector<Vec3> normals = gradients(a);
    for (std::size_t k = 0; k < normals.size(); ++k) {
      for (const std::uint32_t i : all) {
        if (std::find(own_.begin(), own_.end(), i) != own_.end()) continue;
        if (vanishes(dag_, {dag_.sub(lower_.dot(normals[k], gradient(i)), slope(k)[i])})) continue;
        fail("'" + contact_.name + "' depends on '" + m_.model->coordinates[i].name +
                 "' otherwise than by the position of '" + m_.model->places[contact_.place].name + "'",
             "write the constraint with the position of the particle or point that touches, as dot(P, E1)");
      }
    }
  }
  bool extends_basis(const Vec3& a) {
    const auto is_zero = [&](const Vec3& v) { return vanishes(dag_, {v[0], v[1], v[2]}); };
    if (own_.empty()) return !is_zero(a);
    if (own_.size() == 1) return !is_zero(symbolic::cross(dag_, gradient(own_[0]), a));
    const Vec3 normal = symbolic::cross(dag_, gradient(own_[0]), gradient(own_[1]));
    return own_.size() == 2 && !vanishes(dag_, {lower_.dot(normal, a)});
  }

  // a_i - (psi_i / psi_c) a_c lies in the surface; c is a coordinate on which psi depends. The vector would reverse
  // where psi_c passes through 0, and sliding would seem to stop. For a single tangent, psi_c times the vector is used
  // in that case.
  void find_tangents() {
    const std::size_t equations = contact_.constraints.size();
    if (own_.size() <= equations) {
      fail("'" + contact_.name + "' leaves its particle no direction to slide in",
           "remove the friction, or free a coordinate");
    }
    std::vector<Vec3> a = mapped(own_, [&](std::uint32_t i) { return gradient(i); });
    const std::vector<Vec3> normals = gradients(a);
    for (const Vec3& x : normals) {
      for (const Vec3& y : normals) contact_.gram.push_back(tidy(lower_.dot(x, y)));
    }
    if (equations == 2) {
      contact_.directions.push_back(unit(along_curve(a)));
      return;
    }
    std::size_t c = own_.size();
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (!dag_.is_zero(slope(0)[own_[i]])) c = i;
    }
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (i == c || contact_.directions.size() == 1) continue;
      const Ref own = slope(0)[own_[i]], divisor = slope(0)[own_[c]];
      const bool turns = own_.size() == 2 && !dag_.symbols({divisor}).empty();
      contact_.directions.push_back(unit(turns ? lower_.subtract(lower_.scale(divisor, a[i]), lower_.scale(own, a[c]))
                                               : lower_.subtract(a[i], lower_.scale(dag_.div(own, divisor), a[c]))));
    }
    if (own_.size() == 3)
      contact_.directions.push_back(tidy(symbolic::cross(dag_, unit(normals[0]), contact_.directions[0])));
  }

  /// sum c_i a_i with c = psi_1,i x psi_2,i: no psi changes along this vector. It is shorter than the product of the
  /// gradients.
  Vec3 along_curve(const std::vector<Vec3>& a) {
    Vec3 sum{dag_.zero(), dag_.zero(), dag_.zero()};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t j = own_[(i + 1) % 3], k = own_[(i + 2) % 3];
      const Ref c = tidy(dag_.sub(dag_.mul(slope(0)[j], slope(1)[k]), dag_.mul(slope(0)[k], slope(1)[j])));
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = dag_.add(sum[axis], dag_.mul(c, a[i][axis]));
    }
    return tidy(sum);
  }

  /// grad psi_k = sum psi_i a^ij a_j over the coordinates of the particle, (1.22).
  std::vector<Vec3> gradients(const std::vector<Vec3>& a) {
    const std::size_t n = a.size();
    std::vector<Ref> metric(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) metric[i * n + j] = metric[j * n + i] = tidy(lower_.dot(a[i], a[j]));
    }
    const symbolic::Factorisation factors(dag_, metric, n, symbolic::Ties::ascending);
    std::vector<Vec3> result;
    for (std::size_t k = 0; k < contact_.constraints.size(); ++k) {
      std::vector<Ref> lower_components = mapped(own_, [&](std::uint32_t i) { return slope(k)[i]; });
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
    Ref squares = dag_.zero();
    for (const Ref w : contact_.slip) squares = dag_.add(squares, dag_.mul(w, w));
    lower_.set_slip(contact_.slip.size() == 1 ? dag_.call(symbolic::Op::abs, contact_.slip[0])
                                              : dag_.call(symbolic::Op::sqrt, squares));
    contact_.dynamic_coefficient = lower_.scalar(law.dynamic_coefficient);
    if (law.width != model::no_node)
      contact_.width = lower_.scalar(law.width);
    else
      contact_.static_coefficient = lower_.scalar(law.static_coefficient);
    add();
  }

  void add() {
    contact_.first = 0;
    for (const Contact& before : m_.contacts) contact_.first += static_cast<std::uint32_t>(before.dimensions());
    m_.contacts.push_back(std::move(contact_));
  }

  Mechanics& m_;
  Lowering& lower_;
  Dag& dag_;
  symbolic::Expander expand_;
  const model::Constraint* constraint_ = nullptr;
  std::vector<std::uint32_t> own_;  // coordinates of the place
  Contact contact_;
};

}  // namespace

const model::Friction& friction_law_of(const Mechanics& m, const Contact& contact) {
  for (const model::Constraint& constraint : m.model->constraints) {
    if (constraint.name == contact.name && constraint.friction) return *constraint.friction;
  }
  const auto named = [&](const model::Force& force) { return force.name == contact.name; };
  return std::find_if(m.model->forces.begin(), m.model->forces.end(), named)->dry->law;
}

namespace {

/// Values of expressions that depend on parameters alone; none for others. Throws Error at `span` if one has no value.
std::vector<cln::cl_R> known_values(const Mechanics& m, const std::vector<Ref>& expressions, const std::string& what,
                                    const model::Span& span) {
  constexpr int digits = 30;
  // A parameter may use others, declared before or after it, without cycles.
  const std::function<cln::cl_R(const symbolic::Symbol&)> value = [&](const symbolic::Symbol& symbol) {
    return symbolic::evaluate(*m.dag, {m.parameter_value.at(symbol.index)}, value, digits)[0];
  };
  for (const symbolic::Symbol& s : m.dag->symbols(expressions)) {
    if (s.kind != SymbolKind::parameter) return {};
  }
  try {
    return symbolic::evaluate(*m.dag, expressions, value, digits);
  } catch (const std::domain_error& error) {
    throw Error("mechanics", m.model->where(span), what + " has no value: " + error.what(),
                "check the numbers that it is computed from");
  }
}

void check_law(const Mechanics& m, const Contact& contact) {
  const Ref mu_d = contact.dynamic_coefficient;
  const model::Friction& law = friction_law_of(m, contact);
  const bool is_smooth = law.width != model::no_node;
  const std::vector<cln::cl_R> mu = known_values(m, {is_smooth ? mu_d : contact.static_coefficient, mu_d},
                                                 "a coefficient of friction of '" + contact.name + "'", law.span);
  const bool negative = !mu.empty() && (cln::minusp(mu[0]) || cln::minusp(mu[1]));
  if (!mu.empty() && (negative || mu[0] < mu[1])) {
    const model::NodeId wrong = is_smooth || cln::minusp(mu[1]) ? law.dynamic_coefficient : law.static_coefficient;
    throw Error("mechanics", m.model->where(model::origin_of(*m.model, wrong, law.span)),
                negative ? "a coefficient of friction of '" + contact.name + "' is negative"
                         : "the static coefficient of friction of '" + contact.name + "' is less than the dynamic one",
                negative ? "friction opposes slip: give coefficients of 0 or more"
                         : "sliding friction must not exceed the limit of sticking: give static >= dynamic");
  }
  if (!is_smooth) return;
  const std::vector<cln::cl_R> width =
      known_values(m, {*contact.width}, "the width of the friction of '" + contact.name + "'", law.span);
  if (width.empty() || cln::plusp(width[0])) return;
  throw Error("mechanics", m.model->where(model::origin_of(*m.model, law.width, law.span)),
              "the width of the friction of '" + contact.name + "' is not positive",
              "give a slip speed above 0, small beside those of the motion; or Coulomb's law, which has no width");
}

void check_restitution(const Mechanics& m, const Contact& contact) {
  const auto named = [&](const model::Constraint& constraint) { return constraint.name == contact.name; };
  const auto found = std::find_if(m.model->constraints.begin(), m.model->constraints.end(), named);
  if (found == m.model->constraints.end() || found->restitution == model::no_node) return;
  const model::Span& span = m.model->arena[found->restitution].span;
  const std::vector<cln::cl_R> e =
      known_values(m, {contact.restitution}, "the coefficient of restitution of '" + contact.name + "'", span);
  if (e.empty() || (!cln::minusp(e[0]) && e[0] <= 1)) return;
  throw Error("mechanics", m.model->where(model::origin_of(*m.model, found->restitution, span)),
              "the coefficient of restitution of '" + contact.name + "' is not between 0 and 1",
              "0 stays after an impact, 1 bounces without loss");
}

}  // namespace

Ref rolling_friction(const Mechanics& m, const Contact& contact, std::uint32_t tangent) {
  const auto found = std::find(contact.tangent_indices.begin(), contact.tangent_indices.end(), tangent);
  if (found == contact.tangent_indices.end()) return m.dag->zero();
  return m.dag->symbol(
      {SymbolKind::friction, contact.first + static_cast<std::uint32_t>(found - contact.tangent_indices.begin()), 0});
}

void drop_blocked_directions(Mechanics& m) {
  symbolic::Substitution imposed = constraint_substitution(m);
  std::uint32_t first = 0;
  for (Contact& contact : m.contacts) {
    for (std::size_t a = contact.directions.size(); a-- > 0 && contact.directions.size() == 2;) {
      const Ref slip = imposed(contact.slip[a]);
      if (contact.body_contact ? !vanishes(*m.dag, {slip}) : !m.dag->is_zero(slip))
        continue;  // a plane body has no slip across its plane
      const auto drop = [a](auto& list) { list.erase(list.begin() + static_cast<std::ptrdiff_t>(a)); };
      drop(contact.directions), drop(contact.tangents), drop(contact.slip);
      if (contact.body_contact) drop(contact.tangent_indices);
    }
    contact.first = first;
    first += static_cast<std::uint32_t>(contact.dimensions());
  }
}

void check_friction_coefficients(const Mechanics& m) {
  for (const Contact& contact : m.contacts) {
    if (contact.dimensions() > 0) check_law(m, contact);
    if (contact.unilateral) check_restitution(m, contact);
  }
}

void add_contacts(Mechanics& m, Lowering& lower) {
  ContactReader reader(m, lower);
  for (const model::Constraint& constraint : m.model->constraints) {
    if (!constraint.friction && !constraint.unilateral) continue;
    reader.read(constraint);
  }
  for (const model::Force& force : m.model->forces) {
    if (!force.dry) continue;
    reader.read(force, *force.dry);
  }
}

}  // namespace eomgen::mechanics
