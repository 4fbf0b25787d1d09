// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/drawing/parts.hpp"

#include <cln/exception.h>

#include <algorithm>
#include <cmath>

#include "forces/kind.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Vec3;

namespace {

constexpr int digits = 20;

/// Index of the body of a frame among the places.
std::optional<std::size_t> place_of(const model::Model& model, std::uint32_t frame) {
  for (const model::Body& body : model.bodies) {
    if (body.frame == frame) return body.place - 1;
  }
  return std::nullopt;
}

}  // namespace

bool depends_on_parameters_only(const symbolic::Dag& dag, Ref expression) {
  const std::vector<symbolic::Symbol> symbols = dag.symbols({expression});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](const symbolic::Symbol& s) { return s.kind == SymbolKind::parameter; });
}

Drawing::Drawing(mechanics::Mechanics& mechanics)
    : mechanics_(mechanics),
      model_(*mechanics.model),
      imposed_(mechanics::constraint_substitution(mechanics)),
      written_(mechanics::time_function_substitution(mechanics)) {
  places();
  bodies();
  forces();
  joints();
  pivots();
  contacts();
  couplings();
  shapes();
  surfaces();
  rods();
}

void Drawing::add_outputs(system::EquationSystem& system) const {
  system.outputs.insert(system.outputs.end(), own_.begin(), own_.end());
}

std::size_t Drawing::position(std::uint32_t place) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    outputs_.push_back(model_.places[place].name + ".position" + std::to_string(axis + 1));
    expressions_.push_back(written_(imposed_((*mechanics_.place_position[place])[axis])));
  }
  return outputs_.size() - 3;
}

std::size_t Drawing::vector(const Vec3& value) {
  const auto first = static_cast<std::uint32_t>(outputs_.size());
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Ref finished = written_(imposed_(value[k]));
    const std::string name = "draw." + std::to_string(first) + "." + std::to_string(k + 1);
    own_.push_back({name, finished, system::OutputKind::drawn, first, k});
    outputs_.push_back(name);
    expressions_.push_back(finished);
  }
  return first;
}

std::size_t Drawing::vector(model::NodeId value) { return vector(mechanics::lower_vector(mechanics_, value)); }

/// -1 if the value depends on anything else.
Ref Drawing::in_parameters(model::NodeId value) {
  symbolic::Dag& dag = *mechanics_.dag;
  const Ref lowered = value == model::no_node ? dag.integer(-1) : mechanics::lower_scalar(mechanics_, value);
  return depends_on_parameters_only(dag, lowered) ? lowered : dag.integer(-1);
}

void Drawing::places() {
  const auto massive = [](std::uint32_t i, const auto& list) {
    return std::any_of(list.begin(), list.end(), [i](const auto& heavy) { return heavy.place == i; });
  };
  for (std::uint32_t i = 1; i < model_.places.size(); ++i) {
    const model::Place& place = model_.places[i];
    // A line from the reference place usually shows a rod or thread. A place with free coordinates in space gets no
    // line to the origin.
    const bool linked = place.chart && (place.from > 0 || place.chart->system != "cartesian");
    const char* const kind = massive(i, model_.particles) ? "particle" : massive(i, model_.bodies) ? "body" : "point";
    parts_.places.push_back(
        {place.name, kind, linked ? std::optional(static_cast<long>(place.from) - 1) : std::nullopt, position(i)});
  }
}

void Drawing::bodies() {
  for (const model::Body& body : model_.bodies) {
    const model::Frame& frame = model_.frames[body.frame];
    if (frame.stages.empty()) continue;
    DrawnBody drawn{};
    drawn.place = body.place - 1;
    for (std::size_t k = 0; k < 2; ++k) drawn.axes[k] = vector(frame.stages.back().e[k]);
    for (std::size_t i = 0; i < 9; ++i) drawn.inertia[i] = in_parameters(body.inertia[i / 3][i % 3]);
    drawn.mass = in_parameters(body.mass);
    parts_.bodies.push_back(drawn);
  }
}

void Drawing::forces() {
  for (const model::Force& force : model_.forces) {
    const auto add = [&](std::vector<DrawnLine>& list, const forces::Line& line) {
      if (line.from.empty()) return;
      const std::size_t a = vector(force.value(line.from)), b = vector(force.value(line.to));
      list.push_back({a, b});
    };
    const forces::Kind& kind = *forces::find(force.kind);
    add(parts_.springs, kind.spring);
    add(parts_.dampers, kind.damper);
  }
}

void Drawing::joints() {
  for (const model::Joint& joint : model_.joints) {
    if (joint.points[1] == model::no_node) continue;
    parts_.joints.push_back(
        {joint.name, vector(joint.points[1]), {place_of(model_, joint.frames[0]), place_of(model_, joint.frames[1])}});
  }
}

void Drawing::contacts() {
  for (const model::Constraint& constraint : model_.constraints) {
    if (!constraint.contact || constraint.contact->arm == model::no_node) continue;
    const model::BodyContact& contact = *constraint.contact;
    Vec3 at = *mechanics_.place_position[contact.place];
    const Vec3 arm = mechanics::lower_vector(mechanics_, contact.arm);
    for (std::size_t k = 0; k < 3; ++k) at[k] = mechanics_.dag->add(at[k], arm[k]);
    Vec3 foot = at;
    std::optional<std::array<std::size_t, 2>> tangents;
    if (contact.other_place == 0 && contact.other_arm == model::no_node && contact.tangents[0] != model::no_node &&
        contact.tangents[1] != model::no_node) {
      const std::size_t t1 = vector(contact.tangents[0]), t2 = vector(contact.tangents[1]);
      tangents = {t1, t2};
      symbolic::Dag& dag = *mechanics_.dag;
      const Vec3 normal = symbolic::cross(dag, mechanics::lower_vector(mechanics_, contact.tangents[0]),
                                          mechanics::lower_vector(mechanics_, contact.tangents[1]));
      // The last equation is the height above the plane.
      const Ref height = mechanics::lower_scalar(mechanics_, constraint.psi.back());
      foot = symbolic::subtract(dag, at, symbolic::scale(dag, height, normal));
    }
    const std::size_t point = vector(at);
    parts_.contacts.push_back({constraint.name, contact.place - 1, point, tangents, tangents ? vector(foot) : point});
  }
}

void Drawing::couplings() {
  for (const model::Constraint& constraint : model_.constraints) {
    if (!constraint.coupled) continue;
    const model::RotationCoupling& coupled = *constraint.coupled;
    const auto a = place_of(model_, coupled.frames[0]), b = place_of(model_, coupled.frames[1]);
    const Ref ratio = mechanics::lower_scalar(mechanics_, coupled.ratio);
    if (!a || !b || !depends_on_parameters_only(*mechanics_.dag, ratio)) continue;
    const std::size_t n = vector(coupled.axes[0]), m = vector(coupled.axes[1]);
    parts_.couplings.push_back({{*a, *b}, {n, m}, ratio, coupled.frames[2] > 0});
  }
}

void Drawing::shapes() {
  for (const model::ShapeSpec& drawn : model_.drawn) {
    DrawnShape shape{drawn.place - 1, drawn.kind, {}, drawn.axis, {}, drawn.faces};
    for (const model::NodeId length : drawn.lengths) shape.lengths.push_back(in_parameters(length));
    for (const model::NodeId x : drawn.at) shape.at.push_back(in_parameters(x));
    parts_.shapes.push_back(std::move(shape));
  }
}

std::optional<std::array<double, 3>> gravity_direction(mechanics::Mechanics& mechanics,
                                                       const std::vector<double>& parameters) {
  for (const model::Force& force : mechanics.model->forces) {
    const model::NodeId gravity = force.acceleration();
    if (gravity == model::no_node) continue;
    const Vec3 g = mechanics::lower_vector(mechanics, gravity);
    std::array<double, 3> down{};
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!depends_on_parameters_only(*mechanics.dag, g[k])) return std::nullopt;
      const auto lookup = [&](const symbolic::Symbol& s) -> cln::cl_R { return numeric::exact(parameters[s.index]); };
      try {
        down[k] = cln::double_approx(symbolic::evaluate(*mechanics.dag, {g[k]}, lookup, digits)[0]);
      } catch (const std::exception&) {
        return std::nullopt;  // undefined: the page then draws E3 upwards
      }
      length = std::hypot(length, down[k]);
    }
    if (length > 0) return down;
  }
  return std::nullopt;
}

}  // namespace eomgen::analysis
