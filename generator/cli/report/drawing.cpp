// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report/drawing.hpp"

#include <cln/exception.h>

#include <algorithm>
#include <cmath>

#include "forces/kind.hpp"
#include "mechanics/imposition.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::cli {

using symbolic::Ref;
using symbolic::SymbolKind;
using symbolic::Vec3;

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

std::size_t Drawing::size(pipeline::Derived& derived, model::NodeId value) {
  symbolic::Dag& dag = *derived.mechanics.dag;
  Ref lowered = value == model::no_node ? dag.integer(-1) : mechanics::lower_scalar(derived.mechanics, value);
  if (!is_of_parameters(dag, lowered)) lowered = dag.integer(-1);
  sizes_.push_back(lowered);
  return sizes_.size() - 1;
}

void Drawing::places(const model::Model& model) {
  parts_["places"] = Json::array();
  const auto massive = [](std::uint32_t i, const auto& list) {
    return std::any_of(list.begin(), list.end(), [i](const auto& heavy) { return heavy.place == i; });
  };
  for (std::uint32_t i = 1; i < model.places.size(); ++i) {
    const model::Place& place = model.places[i];
    // What a position is measured from is a rod or a thread as often as not; free coordinates of space are no line to
    // the origin.
    const bool linked = place.chart && (place.from > 0 || place.chart->system != "cartesian");
    parts_["places"].push_back({{"name", place.name},
                                {"kind", massive(i, model.particles) ? "particle"
                                         : massive(i, model.bodies)  ? "body"
                                                                     : "point"},
                                {"from", linked ? Json(static_cast<int>(place.from) - 1) : Json(nullptr)},
                                {"at", vector_of(place.name + ".position")}});
  }
}

void Drawing::bodies(pipeline::Derived& derived) {
  parts_["bodies"] = Json::array();
  for (const model::Body& body : derived.model.bodies) {
    const model::Frame& frame = derived.model.frames[body.frame];
    if (frame.stages.empty()) continue;
    Json axes = Json::array();
    for (std::size_t k = 0; k < 2; ++k)
      axes.push_back(vector(derived, mechanics::lower_vector(derived.mechanics, frame.stages.back().e[k])));
    Json inertia = Json::array();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) inertia.push_back(size(derived, body.inertia[i][k]));
    }
    parts_["bodies"].push_back(
        {{"place", body.place - 1}, {"axes", axes}, {"mass", size(derived, body.mass)}, {"inertia", inertia}});
  }
}

void Drawing::forces(pipeline::Derived& derived) {
  parts_["springs"] = parts_["dampers"] = Json::array();
  for (const model::Force& force : derived.model.forces) {
    const auto add = [&](const char* list, const forces::Line& line) {
      if (line.from.empty()) return;
      const auto end = [&](const std::string& name) {
        return vector(derived, mechanics::lower_vector(derived.mechanics, force.value(name)));
      };
      const std::size_t a = end(line.from), b = end(line.to);
      parts_[list].push_back({{"a", a}, {"b", b}});
    };
    const forces::Kind& kind = *forces::find(force.kind);
    add("springs", kind.spring);
    add("dampers", kind.damper);
  }
}

void Drawing::joints(pipeline::Derived& derived) {
  parts_["joints"] = Json::array();
  const auto place_of = [&](std::uint32_t frame) -> Json {
    for (const model::Body& body : derived.model.bodies) {
      if (body.frame == frame) return body.place - 1;
    }
    return nullptr;
  };
  for (const model::Joint& joint : derived.model.joints) {
    if (joint.points[1] == model::no_node) continue;
    parts_["joints"].push_back({{"name", joint.name},
                                {"at", vector(derived, mechanics::lower_vector(derived.mechanics, joint.points[1]))},
                                {"of", {place_of(joint.frames[0]), place_of(joint.frames[1])}}});
  }
}

void Drawing::contacts(pipeline::Derived& derived) {
  parts_["contacts"] = Json::array();
  mechanics::Mechanics& m = derived.mechanics;
  for (const model::Constraint& constraint : derived.model.constraints) {
    if (!constraint.contact || constraint.contact->arm == model::no_node) continue;
    const model::BodyContact& contact = *constraint.contact;
    Vec3 at = *m.place_position[contact.place];
    const Vec3 arm = mechanics::lower_vector(m, contact.arm);
    for (std::size_t k = 0; k < 3; ++k) at[k] = m.dag->add(at[k], arm[k]);
    Json tangents = nullptr;
    if (contact.other_place == 0 && contact.tangents[0] != model::no_node && contact.tangents[1] != model::no_node) {
      tangents = {vector(derived, mechanics::lower_vector(m, contact.tangents[0])),
                  vector(derived, mechanics::lower_vector(m, contact.tangents[1]))};
    }
    parts_["contacts"].push_back({{"name", constraint.name}, {"at", vector(derived, at)}, {"tangents", tangents}});
  }
}

void Drawing::shapes(pipeline::Derived& derived) {
  parts_["shapes"] = Json::array();
  for (const model::Drawn& drawn : derived.model.drawn) {
    Json lengths = Json::array(), at = Json::array();
    for (const model::NodeId length : drawn.lengths) lengths.push_back(size(derived, length));
    for (const model::NodeId x : drawn.at) at.push_back(size(derived, x));
    parts_["shapes"].push_back(
        {{"place", drawn.place - 1}, {"kind", drawn.kind}, {"lengths", lengths}, {"axis", drawn.axis}, {"at", at}});
  }
}

std::optional<std::array<double, 3>> falling(pipeline::Derived& derived, const std::vector<double>& parameters) {
  constexpr int digits = 20;
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

}  // namespace eomgen::cli
