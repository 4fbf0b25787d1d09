// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/kinematics.hpp"

#include <algorithm>
#include <stdexcept>

#include "reading/atom_table.hpp"
#include "reading/ginac_bridge.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "reading/zero_test.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::reading {
namespace {

using symbolic::Vec3;

/// The largest index of a frame whose axes the expression names; 0 if there is none.
std::uint32_t last_frame(const model::Model& model, model::NodeId id) {
  if (id == model::no_node) return 0;
  const model::Node& node = model.arena[id];
  if (node.op == model::Op::axis || node.op == model::Op::angular_velocity) return node.index;
  if (node.op == model::Op::definition) return last_frame(model, model.definitions[node.index].expression);
  std::uint32_t last = 0;
  for (const model::NodeId arg : node.args) last = std::max(last, last_frame(model, arg));
  return last;
}

class Reader {
 public:
  explicit Reader(const Mechanics& mechanics)
      : m_(mechanics),
        dag_(*m_.dag),
        bridge_(m_),
        ddt_(symbolic::total_time_derivative(dag_, m_.model->coordinates.size(), m_.model->functions.size())) {}

  std::vector<Kinematics> all() {
    const model::Model& model = *m_.model;
    std::vector<bool> has_body(model.frames.size(), false);
    for (std::uint32_t p = 1; p < model.places.size(); ++p) {
      if (!m_.place_position[p]) continue;
      begin(model.places[p].name);
      const auto body =
          std::find_if(model.bodies.begin(), model.bodies.end(), [p](const model::Body& b) { return b.place == p; });
      if (body != model.bodies.end()) {
        has_body[body->frame] = true;
        rotation(body->frame, static_cast<std::size_t>(body - model.bodies.begin()));
      }
      motion(p, body != model.bodies.end() ? body->frame : 0);
    }
    for (std::uint32_t f = 1; f < model.frames.size(); ++f) {
      if (has_body[f]) continue;
      begin(model.frames[f].name);
      rotation(f, std::nullopt);
    }
    for (std::uint32_t d = 0; d < model.definitions.size(); ++d) definition(d);
    return std::move(result_);
  }

  std::vector<Kinematics> bases() {
    for (std::uint32_t f = 1; f < m_.model->frames.size(); ++f) {
      if (m_.model->frames[f].stages.empty() || angles(f).empty()) continue;
      begin(m_.model->frames[f].name);
      const auto body = std::find_if(m_.body_rotations.begin(), m_.body_rotations.end(),
                                     [f](const mechanics::BodyRotation& b) { return b.frame == f; });
      std::optional<std::size_t> index;
      if (body != m_.body_rotations.end()) index = static_cast<std::size_t>(body - m_.body_rotations.begin());
      const std::vector<std::pair<Triad, Vec3>> known = known_rates(f, index);
      tangents(f, known.front().first, known.back().first, known.front().second, known.back().second);
    }
    return std::move(result_);
  }

 private:
  /// Axes with their vectors.
  struct Triad {
    Axes axes;
    std::array<Vec3, 3> vectors;
  };

  void begin(const std::string& name) { result_.push_back({name, {}, {}, {}, {}}); }

  Triad fixed() {
    Triad result;
    for (std::size_t k = 0; k < 3; ++k) {
      result.vectors[k] = symbolic::zero_vector(dag_);
      result.vectors[k][k] = dag_.one();
    }
    return result;
  }
  Triad own(std::uint32_t frame) {
    Triad result{{Axes::Kind::own, frame, {}}, {}};
    for (std::size_t k = 0; k < 3; ++k)
      result.vectors[k] = mechanics::lower_vector(m_, m_.model->frames[frame].stages.back().e[k]);
    return result;
  }

  /// Runs `read` within the budget of an item. Returns the reason if it takes more.
  template <class Read>
  std::string within_budget(Read&& read) {
    try {
      const work::Budget budget(item_budget);
      read();
      return "";
    } catch (const work::BudgetExceeded& over) {
      return over.what();
    }
  }
  Components sums(const Vec3& along) {
    return {simplify(bridge_.sum(along[0])), simplify(bridge_.sum(along[1])), simplify(bridge_.sum(along[2]))};
  }
  Vec3 along(const Vec3& vector, const Triad& triad) {
    if (triad.axes.kind == Axes::Kind::fixed) return vector;
    Vec3 result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = symbolic::dot(dag_, vector, triad.vectors[k]);
    return result;
  }
  Vec3 combined(const Vec3& components, const Triad& triad) {
    Vec3 result = symbolic::zero_vector(dag_);
    for (std::size_t k = 0; k < 3; ++k)
      result = symbolic::add(dag_, result, symbolic::scale(dag_, components[k], triad.vectors[k]));
    return result;
  }
  Vec3 rate(const Vec3& v) { return {ddt_(v[0]), ddt_(v[1]), ddt_(v[2])}; }

  /// Adds a vector with known components along the axes.
  void add(Quantity quantity, std::uint32_t index, std::uint32_t number, const Axes& axes, const Vec3& components) {
    KinematicVector v{quantity, index, number, axes, {}, {}};
    v.skip_reason = within_budget([&] { v.components = sums(components); });
    result_.back().vectors.push_back(std::move(v));
  }
  /// Adds a vector along each of the triads.
  void add_along(Quantity quantity, std::uint32_t index, const Vec3& vector, const std::vector<Triad>& triads) {
    for (const Triad& triad : triads) add(quantity, index, 0, triad.axes, along(vector, triad));
  }

  /// The unit vectors of the place's own coordinates, unless these are the fixed axes or not orthonormal.
  std::optional<Triad> chart(std::uint32_t place) {
    const auto& chart = m_.model->places[place].chart;
    if (!chart || chart->system == "cartesian") return std::nullopt;
    Triad result{{Axes::Kind::chart, 0, {}}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      if (chart->unit_basis[k] == model::no_node) return std::nullopt;
      result.vectors[k] = mechanics::lower_vector(m_, chart->unit_basis[k]);
      std::optional<std::uint32_t> name;
      if (chart->entries[k] != model::no_node) {
        const model::Node& entry = m_.model->arena[chart->entries[k]];
        if (entry.op == model::Op::coordinate && entry.order == 0) name = entry.index;
      }
      const auto is_fixed = [&](const Vec3& e) { return e == fixed().vectors[2]; };
      if (!name && !is_fixed(result.vectors[k])) return std::nullopt;
      result.axes.coordinates.push_back(name);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        const Sum product = bridge_.sum(symbolic::dot(dag_, result.vectors[i], result.vectors[k]));
        if (!is_zero(product - Sum(i == k ? 1 : 0))) return std::nullopt;
      }
    }
    return result;
  }

  /// r, v and a along the fixed axes, and along those of its chart or of the frame to which it belongs.
  void motion(std::uint32_t place, std::uint32_t frame) {
    std::vector<Triad> triads{fixed()};
    std::optional<Triad> unit;
    within_budget([&] { unit = chart(place); });
    if (frame == 0 && !unit) frame = last_frame(*m_.model, m_.model->places[place].position);
    if (unit) triads.push_back(*std::move(unit));
    if (frame != 0) triads.push_back(own(frame));
    const bool is_body = std::any_of(m_.model->bodies.begin(), m_.model->bodies.end(),
                                     [place](const model::Body& b) { return b.place == place; });
    if (frame != 0 && !is_body) inertia_about(place, frame);
    std::rotate(triads.begin(), triads.begin() + 1, triads.end());  // the fixed axes last
    Vec3 r = *m_.place_position[place];
    add_along(Quantity::position, place, r, triads);
    for (const Quantity quantity : {Quantity::velocity, Quantity::acceleration}) {
      r = rate(r);
      add_along(quantity, place, r, triads);
    }
  }

  /// The three coordinates that are the entries of the rotation; empty for other rotations.
  std::vector<std::uint32_t> angles(std::uint32_t frame) const {
    std::vector<std::uint32_t> result;
    for (const model::NodeId entry : m_.model->frames[frame].entries) {
      const model::Node& node = m_.model->arena[entry];
      if (node.op != model::Op::coordinate || node.order != 0) return {};
      result.push_back(node.index);
    }
    if (result.size() != 3) result.clear();
    return result;
  }

  Vec3 by_rate(const Vec3& v, std::uint32_t coordinate) {
    symbolic::Derivation by = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, coordinate, 1});
    return {by(v[0]), by(v[1]), by(v[2])};
  }

  /// Axes, and the angular velocity along them; the last carry the inertia tensor.
  std::vector<std::pair<Triad, Vec3>> known_rates(std::uint32_t frame, std::optional<std::size_t> body) {
    std::vector<std::pair<Triad, Vec3>> known{{own(frame), m_.angular_velocity[frame]}};
    if (body && m_.body_rotations[*body].axes != known.front().first.vectors) {
      const mechanics::BodyRotation& carried = m_.body_rotations[*body];
      known.push_back({{{Axes::Kind::before_last_rotation, frame, {}}, carried.axes}, carried.w});
    }
    return known;
  }

  void rotation(std::uint32_t frame, std::optional<std::size_t> body) {
    if (m_.model->frames[frame].stages.empty()) return;
    const Triad e = own(frame), E = fixed();
    const Vec3 w = m_.angular_velocity[frame];
    const std::vector<std::pair<Triad, Vec3>> known = known_rates(frame, body);
    const Triad& carrier = known.back().first;
    for (std::uint32_t i = 0; i < known.size(); ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) add(Quantity::axis, frame, 3 * i + k, E.axes, known[i].first.vectors[k]);
    }
    for (const auto& [triad, components] : known) add(Quantity::angular_velocity, frame, 0, triad.axes, components);
    const Vec3 w_fixed = combined(known.back().second, carrier);
    add(Quantity::angular_velocity, frame, 0, E.axes, w_fixed);
    add(Quantity::angular_acceleration, frame, 0, e.axes, rate(w));
    add(Quantity::angular_acceleration, frame, 0, E.axes, rate(w_fixed));
    tangents(frame, e, carrier, w, known.back().second);
    axis_and_angle(frame, e);
    if (body) inertia(frame, *body, e, carrier, w);
  }

  void tangents(std::uint32_t frame, const Triad& e, const Triad& carrier, const Vec3& w, const Vec3& w_carrier) {
    const Triad E = fixed();
    std::vector<std::uint32_t> moving;
    for (std::uint32_t q = 0; q < m_.q.size(); ++q) {
      if (!symbolic::is_zero(dag_, by_rate(w, q))) moving.push_back(q);
    }
    for (const std::uint32_t q : moving) add(Quantity::tangent, frame, q, e.axes, by_rate(w, q));
    for (const std::uint32_t q : moving)
      add(Quantity::tangent, frame, q, E.axes, combined(by_rate(w_carrier, q), carrier));
    const std::vector<std::uint32_t> entries = angles(frame);
    if (entries.empty()) return;
    std::array<Vec3, 3> g;
    for (std::size_t i = 0; i < 3; ++i) g[i] = by_rate(w, entries[i]);
    const Ref volume = symbolic::dot(dag_, g[0], symbolic::cross(dag_, g[1], g[2]));
    for (const Triad* triad : {&e, &E}) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 normal = symbolic::cross(dag_, g[(i + 1) % 3], g[(i + 2) % 3]);
        KinematicVector dual{Quantity::dual, frame, entries[i], triad->axes, {}, {}};
        dual.skip_reason = within_budget([&] {
          const Sum under = simplify(bridge_.sum(volume));
          dual.components = sums(triad == &E ? combined(normal, e) : normal);
          for (Sum& component : dual.components) component = simplify(quotient(component, under));
        });
        result_.back().vectors.push_back(std::move(dual));
      }
    }
  }

  // cos(p) = (sum e_k . E_k - 1)/2 and 2 sin(p) r = sum E_k x e_k.
  void axis_and_angle(std::uint32_t frame, const Triad& e) {
    KinematicAngle result{frame, {}, {}, {}, {}};
    result.skip_reason = within_budget([&] {
      Ref trace = dag_.integer(-1);
      Vec3 axis = symbolic::zero_vector(dag_);
      const Triad E = fixed();
      for (std::size_t k = 0; k < 3; ++k) {
        trace = dag_.add(trace, e.vectors[k][k]);
        axis = symbolic::add(dag_, axis, symbolic::cross(dag_, E.vectors[k], e.vectors[k]));
      }
      result.cosine = simplify(bridge_.sum(dag_.div(trace, dag_.integer(2))));
      result.axis = sums(axis);
      if (!is_constant(result.cosine)) return;
      result.angle = angle_of(result.cosine);
      const Sum square = Sum(1) - result.cosine * result.cosine;
      if (square.is_zero()) return;  // no rotation, or half a turn, whose axis this does not give
      // Of a fraction, numerator and denominator apart: 1/sqrt(3) in place of 1/(2 sqrt(3/4)).
      const Sum inverse = square.is_number()
                              ? power(Sum(Rational(cln::numerator(square.number()))), Rational(-1) / 2) *
                                    power(Sum(Rational(cln::denominator(square.number()))), Rational(1) / 2)
                              : power(square, Rational(-1) / 2);
      const Sum half_inverse = Rational(1) / 2 * inverse;
      for (Sum& component : result.axis) component = simplify(component * half_inverse);
    });
    result_.back().angle = std::move(result);
  }
  static bool is_constant(const Sum& sum) {
    bool constant = true;
    for_each_atom(sum, [&](const Atom& atom) { constant = constant && atom.op != Op::symbol; });
    return constant;
  }
  static Sum angle_of(const Sum& cosine) {
    for (long twelfths = 0; twelfths <= 12; ++twelfths) {
      const Sum angle = Rational(twelfths) / 12 * pi();
      if (is_zero(call(Op::cos, {angle}) - cosine)) return angle;
    }
    return call(Op::acos, {cosine});
  }

  /// The inertia tensor about a point that is fixed to the body, by the parallel axis theorem, eq. (6.111).
  void inertia_about(std::uint32_t place, std::uint32_t frame) {
    const auto body = std::find_if(m_.body_rotations.begin(), m_.body_rotations.end(),
                                   [frame](const mechanics::BodyRotation& b) { return b.frame == frame; });
    if (body == m_.body_rotations.end()) return;
    const std::uint32_t centre = m_.model->bodies[static_cast<std::size_t>(body - m_.body_rotations.begin())].place;
    const auto mass = std::find_if(m_.masses.begin(), m_.masses.end(),
                                   [centre](const mechanics::PointMass& p) { return p.place == centre; });
    KinematicTensor t{false, place, frame, {Axes::Kind::own, frame, {}}, {}, {}};
    bool is_fixed = true;
    t.skip_reason = within_budget([&] {
      const Triad e = own(frame);
      const Vec3 from = symbolic::subtract(dag_, *m_.place_position[centre], *m_.place_position[place]);
      const Components arm = sums(along(from, e));
      for (const Sum& component : arm) {
        for_each_atom(component, [&](const Atom& atom) {
          is_fixed = is_fixed && (atom.op != Op::symbol || atom.symbol.kind == SymbolKind::parameter);
        });
      }
      const bool is_centre = std::all_of(arm.begin(), arm.end(), [](const Sum& s) { return s.is_zero(); });
      is_fixed = is_fixed && !is_centre;
      if (!is_fixed) return;
      const Sum m = bridge_.sum(mass->mass), square = arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k)
          t.entries[i][k] = simplify(bridge_.sum(body->J[i][k]) + m * ((i == k ? square : Sum()) - arm[i] * arm[k]));
      }
    });
    if (is_fixed) result_.back().tensors.push_back(std::move(t));
  }

  void inertia(std::uint32_t frame, std::size_t body, const Triad& e, const Triad& carrier, const Vec3& w) {
    const mechanics::BodyRotation& spin = m_.body_rotations[body];
    const Triad E = fixed();
    // J has the same components along the body's own axes and along the axes that carry it.
    add(Quantity::angular_momentum, frame, 0, e.axes, mechanics::inertia_times(dag_, spin, w));
    const Vec3 H = mechanics::angular_momentum(dag_, spin);
    if (carrier.axes.kind != Axes::Kind::own) add(Quantity::angular_momentum, frame, 0, carrier.axes, H);
    add(Quantity::angular_momentum, frame, 0, E.axes, combined(H, carrier));
    const auto tensor = [&](bool euler, const Triad& along_axes, const auto& entry) {
      KinematicTensor t{euler, 0, frame, along_axes.axes, {}, {}};
      t.skip_reason = within_budget([&] {
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t k = 0; k < 3; ++k) t.entries[i][k] = simplify(bridge_.sum(entry(i, k)));
        }
      });
      result_.back().tensors.push_back(std::move(t));
    };
    Ref half_trace = dag_.zero();
    for (std::size_t k = 0; k < 3; ++k) half_trace = dag_.add(half_trace, spin.J[k][k]);
    half_trace = dag_.div(half_trace, dag_.integer(2));
    tensor(false, e, [&](std::size_t i, std::size_t k) { return spin.J[i][k]; });
    tensor(true, e, [&](std::size_t i, std::size_t k) {
      return i == k ? dag_.sub(half_trace, spin.J[i][k]) : dag_.neg(spin.J[i][k]);
    });
    tensor(false, E, [&](std::size_t i, std::size_t k) {
      Ref sum = dag_.zero();
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          const Ref both = dag_.mul(carrier.vectors[a][i], carrier.vectors[b][k]);
          sum = dag_.add(sum, dag_.mul(spin.J[a][b], both));
        }
      }
      return sum;
    });
  }

  void definition(std::uint32_t d) {
    const model::Definition& of = m_.model->definitions[d];
    begin(of.name);
    if (!of.vector) {
      KinematicScalar scalar{d, {}, {}};
      scalar.skip_reason =
          within_budget([&] { scalar.value = bridge_.sum(mechanics::lower_scalar(m_, of.expression)); });
      result_.back().scalar = std::move(scalar);
      return;
    }
    const Vec3 value = mechanics::lower_vector(m_, of.expression);
    const std::uint32_t frame = last_frame(*m_.model, of.expression);
    std::vector<Triad> triads;
    if (frame != 0 && !m_.model->frames[frame].stages.empty()) triads.push_back(own(frame));
    triads.push_back(fixed());
    add_along(Quantity::definition, d, value, triads);
  }

  Mechanics m_;  // shares the Dag; lowering adds nodes to it
  symbolic::Dag& dag_;
  GinacBridge bridge_;
  symbolic::Derivation ddt_;
  std::vector<Kinematics> result_;
};

}  // namespace

const char* name(Quantity quantity) {
  switch (quantity) {
    case Quantity::axis: return "axes";
    case Quantity::position: return "position";
    case Quantity::velocity: return "velocity";
    case Quantity::acceleration: return "acceleration";
    case Quantity::angular_velocity: return "angular velocity";
    case Quantity::angular_acceleration: return "angular acceleration";
    case Quantity::tangent: return "tangent vectors";
    case Quantity::dual: return "dual vectors";
    case Quantity::angular_momentum: return "angular momentum";
    case Quantity::definition: return "definition";
  }
  return "";
}

std::vector<Kinematics> kinematics(const Mechanics& mechanics) try {
  const work::Budget budget(form_budget);
  return Reader(mechanics).all();
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

std::vector<Kinematics> euler_bases(const Mechanics& mechanics) try {
  const work::Budget budget(form_budget);
  return Reader(mechanics).bases();
} catch (const std::domain_error&) {
  throw no_value_error(mechanics);
}

}  // namespace eomgen::reading
