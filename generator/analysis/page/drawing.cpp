// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/drawing.hpp"

#include <cln/exception.h>

#include <algorithm>
#include <cmath>

#include "forces/kind.hpp"
#include "mechanics/imposition.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using symbolic::Ref;
using symbolic::SymbolKind;
using symbolic::Vec3;

namespace {

constexpr int digits = 20;

/// Where the body of this frame is among the places.
std::optional<std::size_t> place_of(const model::Model& model, std::uint32_t frame) {
  for (const model::Body& body : model.bodies) {
    if (body.frame == frame) return body.place - 1;
  }
  return std::nullopt;
}

}  // namespace

bool is_of_parameters(const symbolic::Dag& dag, Ref expression) {
  const std::vector<symbolic::Symbol> symbols = dag.symbols({expression});
  return std::all_of(symbols.begin(), symbols.end(),
                     [](const symbolic::Symbol& s) { return s.kind == SymbolKind::parameter; });
}

Drawing::Drawing(pipeline::Derived& derived) {
  places(derived.model);
  bodies(derived);
  forces(derived);
  joints(derived);
  contacts(derived);
  couplings(derived);
  shapes(derived);
}

std::size_t Drawing::vector_of(const std::string& base) {
  for (int axis = 1; axis <= 3; ++axis) outputs_.push_back(base + std::to_string(axis));
  return outputs_.size() - 3;
}

std::size_t Drawing::vector(pipeline::Derived& derived, const Vec3& value) {
  symbolic::Substitution imposed = mechanics::impose(derived.mechanics),
                         written = mechanics::write_out(derived.mechanics);
  const auto first = static_cast<std::uint32_t>(outputs_.size());
  const std::string base = "draw." + std::to_string(first) + ".";
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Ref finished = written(imposed(value[k]));
    for (system::EquationSystem& candidate : derived.candidates)
      candidate.outputs.push_back({base + std::to_string(k + 1), finished, system::OutputKind::drawn, first, k});
  }
  return vector_of(base);
}

std::size_t Drawing::vector(pipeline::Derived& derived, model::NodeId value) {
  return vector(derived, mechanics::lower_vector(derived.mechanics, value));
}

std::size_t Drawing::size(pipeline::Derived& derived, model::NodeId value) {
  symbolic::Dag& dag = *derived.mechanics.dag;
  Ref lowered = value == model::no_node ? dag.integer(-1) : mechanics::lower_scalar(derived.mechanics, value);
  if (!is_of_parameters(dag, lowered)) lowered = dag.integer(-1);
  sizes_.push_back(lowered);
  return sizes_.size() - 1;
}

void Drawing::places(const model::Model& model) {
  const auto massive = [](std::uint32_t i, const auto& list) {
    return std::any_of(list.begin(), list.end(), [i](const auto& heavy) { return heavy.place == i; });
  };
  for (std::uint32_t i = 1; i < model.places.size(); ++i) {
    const model::Place& place = model.places[i];
    // What a position is measured from is a rod or a thread as often as not; free coordinates of space are no line to
    // the origin.
    const bool linked = place.chart && (place.from > 0 || place.chart->system != "cartesian");
    const char* const kind = massive(i, model.particles) ? "particle" : massive(i, model.bodies) ? "body" : "point";
    parts_.places.push_back({place.name, kind, linked ? std::optional(static_cast<long>(place.from) - 1) : std::nullopt,
                             vector_of(place.name + ".position")});
  }
}

void Drawing::bodies(pipeline::Derived& derived) {
  for (const model::Body& body : derived.model.bodies) {
    const model::Frame& frame = derived.model.frames[body.frame];
    if (frame.stages.empty()) continue;
    DrawnBody drawn{};
    drawn.place = body.place - 1;
    for (std::size_t k = 0; k < 2; ++k) drawn.axes[k] = vector(derived, frame.stages.back().e[k]);
    for (std::size_t i = 0; i < 9; ++i) drawn.inertia[i] = size(derived, body.inertia[i / 3][i % 3]);
    drawn.mass = size(derived, body.mass);
    parts_.bodies.push_back(drawn);
  }
}

void Drawing::forces(pipeline::Derived& derived) {
  for (const model::Force& force : derived.model.forces) {
    const auto add = [&](std::vector<DrawnLine>& list, const forces::Line& line) {
      if (line.from.empty()) return;
      const std::size_t a = vector(derived, force.value(line.from)), b = vector(derived, force.value(line.to));
      list.push_back({a, b});
    };
    const forces::Kind& kind = *forces::find(force.kind);
    add(parts_.springs, kind.spring);
    add(parts_.dampers, kind.damper);
  }
}

void Drawing::joints(pipeline::Derived& derived) {
  for (const model::Joint& joint : derived.model.joints) {
    if (joint.points[1] == model::no_node) continue;
    parts_.joints.push_back({joint.name,
                             vector(derived, joint.points[1]),
                             {place_of(derived.model, joint.frames[0]), place_of(derived.model, joint.frames[1])}});
  }
}

void Drawing::contacts(pipeline::Derived& derived) {
  mechanics::Mechanics& m = derived.mechanics;
  for (const model::Constraint& constraint : derived.model.constraints) {
    if (!constraint.contact || constraint.contact->arm == model::no_node) continue;
    const model::BodyContact& contact = *constraint.contact;
    Vec3 at = *m.place_position[contact.place];
    const Vec3 arm = mechanics::lower_vector(m, contact.arm);
    for (std::size_t k = 0; k < 3; ++k) at[k] = m.dag->add(at[k], arm[k]);
    std::optional<std::array<std::size_t, 2>> tangents;
    if (contact.other_place == 0 && contact.tangents[0] != model::no_node && contact.tangents[1] != model::no_node) {
      const std::size_t t1 = vector(derived, contact.tangents[0]), t2 = vector(derived, contact.tangents[1]);
      tangents = {t1, t2};
    }
    parts_.contacts.push_back({constraint.name, vector(derived, at), tangents});
  }
}

void Drawing::couplings(pipeline::Derived& derived) {
  for (const model::Constraint& constraint : derived.model.constraints) {
    if (!constraint.coupled) continue;
    const model::Coupled& coupled = *constraint.coupled;
    const auto a = place_of(derived.model, coupled.frames[0]), b = place_of(derived.model, coupled.frames[1]);
    const Ref ratio = mechanics::lower_scalar(derived.mechanics, coupled.ratio);
    if (!a || !b || !is_of_parameters(*derived.mechanics.dag, ratio)) continue;
    const std::size_t n = vector(derived, coupled.axes[0]), m = vector(derived, coupled.axes[1]);
    parts_.couplings.push_back(
        {constraint.name, {*a, *b}, {n, m}, size(derived, coupled.ratio), coupled.frames[2] > 0});
  }
}

void Drawing::shapes(pipeline::Derived& derived) {
  for (const model::Drawn& drawn : derived.model.drawn) {
    DrawnShape shape{drawn.place - 1, drawn.kind, {}, drawn.axis, {}};
    for (const model::NodeId length : drawn.lengths) shape.lengths.push_back(size(derived, length));
    for (const model::NodeId x : drawn.at) shape.at.push_back(size(derived, x));
    parts_.shapes.push_back(std::move(shape));
  }
}

std::vector<double> sizes_of(const Drawing& drawing, const pipeline::Simulation& simulation) {
  std::vector<double> result;
  const auto lookup = [&](const symbolic::Symbol& s) -> cln::cl_R {
    return cln::cl_R(simulation.scene.parameters[s.index]);
  };
  for (const Ref size : drawing.sizes()) {
    try {
      result.push_back(
          cln::double_approx(symbolic::evaluate(*simulation.derived->mechanics.dag, {size}, lookup, digits)[0]));
    } catch (const std::exception&) {
      result.push_back(-1);  // unknown, as where it depends on more than parameters
    }
  }
  return result;
}

std::optional<std::array<double, 3>> falling(pipeline::Derived& derived, const std::vector<double>& parameters) {
  for (const model::Force& force : derived.model.forces) {
    const model::NodeId gravity = force.acceleration();
    if (gravity == model::no_node) continue;
    const Vec3 g = mechanics::lower_vector(derived.mechanics, gravity);
    std::array<double, 3> down{};
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_of_parameters(*derived.mechanics.dag, g[k])) return std::nullopt;
      const auto lookup = [&](const symbolic::Symbol& s) -> cln::cl_R { return cln::cl_R(parameters[s.index]); };
      try {
        down[k] = cln::double_approx(symbolic::evaluate(*derived.mechanics.dag, {g[k]}, lookup, digits)[0]);
      } catch (const std::exception&) {
        return std::nullopt;  // no value: the page draws E3 upwards then
      }
      length = std::hypot(length, down[k]);
    }
    if (length > 0) return down;
  }
  return std::nullopt;
}

}  // namespace eomgen::analysis
