// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report/recorded_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/output/decimal.hpp>
#include <eom/output/svg_plot.hpp>

namespace eomgen::cli {
namespace {

constexpr double least_seconds = 4, most_seconds = 20;  // duration of an animation, for any time span of the run
constexpr int digits_of_states = 10, digits_of_screens = 6;

// Rounds to the digits needed, to save bytes.
double shortened(double x, int digits) {
  double result = 0;
  const std::string text = std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "0";
  eom::decimals::read_decimal(text, result);
  return result;
}

// JSON for the script of a page: parts of the drawing, forces, initial data of the integrator.

Json bounds(const std::vector<double>& list) { return list_of(list, finite_or_null); }

/// Values that an event or a sample sets: entries [place in the state, place in the values of `resets`].
void add_reset(Json& of, const eom::hybrid::Reset& reset) {
  of["set"] = list_of(reset.set, [](const eom::hybrid::Reset::Entry& entry) {
    return Json::array({entry.component, entry.value});
  });
  of["condition"] = reset.condition ? Json(*reset.condition) : Json(nullptr);
}

Json to_json(const eom::StateLayout& layout) {
  return {{"rates", layout.rates_begin()},
          {"first_order", layout.first_order_begin()},
          {"discrete", layout.discrete_begin()},
          {"size", layout.size()}};
}

Json line(const analysis::DrawnLine& l) { return EOMGEN_MEMBERS(l, a, b); }

/// Bounds of coordinates are taken from the scene.
Json to_json(const analysis::DrawnParts& parts, const model::Model& model, const run::Scene& scene) {
  Json result;
  result["places"] =
      list_of(parts.places, [](const analysis::DrawnPlace& p) { return EOMGEN_MEMBERS(p, name, kind, at); });
  result["dampers"] = list_of(parts.dampers, line);
  result["springs"] = list_of(parts.springs, line);
  result["joints"] = list_of(parts.joints, [](const analysis::DrawnJoint& j) -> Json {
    return {{"at", j.at}, {"of", Json::array({or_null(j.of[0]), or_null(j.of[1])})}};
  });
  result["contacts"] = list_of(
      parts.contacts, [](const analysis::DrawnContact& c) { return EOMGEN_MEMBERS(c, name, at, tangents, foot); });
  std::size_t count = 0;
  result["surfaces"] = list_of(parts.surfaces, [&](const analysis::DrawnSurface& s) -> Json {
    const auto of_unit = [&](const char* unit) {
      return list_of(s.coordinates, [&](std::uint32_t c) -> Json { return model.coordinates[c].unit.text == unit; });
    };
    std::vector<double> lower, upper;
    for (const std::uint32_t c : s.coordinates) {
      lower.push_back(scene.lower[c]);
      upper.push_back(scene.upper[c]);
    }
    return {{"name", s.name},
            {"place", s.place},
            {"at", s.at},
            {"columns", s.coordinates},
            {"others", s.others},
            {"others_at", s.others_at},
            {"bound", s.psi.size()},
            {"angles", of_unit("rad")},
            {"lengths", of_unit("m")},
            {"lower", bounds(lower)},
            {"upper", bounds(upper)},
            {"integrals", or_null(s.integrals)},
            {"reshapes", s.changes_shape},
            {"moves", s.is_moving},
            {"equations", "surface_" + std::to_string(++count)}};
  });
  result["untried"] = parts.rods_incomplete;
  return result;
}

Json vector(const analysis::Point& r) { return Json::array({r.x(), r.y(), r.z()}); }

Json to_json(const analysis::Polyhedron& p) {
  return {{"vertices", list_of(p.vertices,
                               [](const analysis::Point& c) {
                                 return list_of(std::vector<double>(c.begin(), c.end()),
                                                [](double x) -> Json { return shortened(x, digits_of_states); });
                               })},
          {"faces", p.faces},
          {"smooth", p.smooth}};
}

Json to_json(const analysis::DrawnSolid& s) {
  Json result = Json::object();
  if (s.at) result["at"] = *s.at;
  if (s.ball) result["ball"] = *s.ball;
  if (s.tip) result["tip"] = *s.tip;
  if (s.polyhedron != nullptr) result.update({{"polyhedron", s.polyhedron->name}, {"edges", s.edges}});
  if (!s.points.empty()) result.update({{"points", s.points}, {"faces", s.faces}, {"open", s.open}});
  return result;
}

/// Adds the decided primitives, and the polyhedra of their solids.
void add_primitives(Json& parts, const analysis::Primitives& primitives) {
  parts["polyhedra"] = Json::object();
  for (const analysis::DrawnSolids& drawn : primitives.solids) {
    for (const analysis::DrawnSolid& s : drawn.list) {
      if (s.polyhedron != nullptr) parts["polyhedra"][s.polyhedron->name] = to_json(*s.polyhedron);
    }
  }
  parts["solids"] = list_of(primitives.solids, [](const analysis::DrawnSolids& s) -> Json {
    return {{"place", s.place},
            {"axes", or_null(s.axes)},
            {"list", list_of(s.list, [](const analysis::DrawnSolid& one) { return to_json(one); })}};
  });
  parts["links"] =
      list_of(primitives.links, [](const analysis::DrawnLink& l) { return EOMGEN_MEMBERS(l, from, to, is_rod); });
  parts["supports"] = list_of(primitives.supports, [](const analysis::DrawnSupport& s) -> Json {
    return {{"at", or_null(s.at)}, {"toward", vector(s.toward)}};
  });
  parts["wheels"] = list_of(primitives.wheels,
                            [](const analysis::DrawnWheels& w) { return EOMGEN_MEMBERS(w, of, axis, radii, belt); });
}

/// Adds the arrows of forces, and the names of forces without a vector, to the parts.
void add_forces(Json& parts, const analysis::DrawnForces& forces) {
  parts["arrows"] = list_of(forces.list(), [](const analysis::DrawnForce& f) -> Json {
    return {{"name", f.name}, {"kind", f.kind}, {"at", f.at}, {"value", f.value}, {"turns", f.is_moment}};
  });
  parts["beyond"] = forces.omitted_count();
  parts["without_vector"] = forces.without_vector();
}

const char* name_of(eom::contacts::ImpactLaw law) {
  switch (law) {
    case eom::contacts::ImpactLaw::newton: return "newton";
    case eom::contacts::ImpactLaw::poisson: return "poisson";
    case eom::contacts::ImpactLaw::moreau: return "moreau";
    case eom::contacts::ImpactLaw::stronge: return "stronge";
  }
  return "";
}

Json to_json(const eom::contacts::Set& set) {
  if (set.empty()) return nullptr;
  return {{"values", set.values},
          {"law", name_of(set.law)},
          {"order", set.order == eom::contacts::ImpactOrder::sequence ? "sequence" : "simultaneous"}};
}

Json to_json(const analysis::LiveStart& start) {
  return {{"n", start.layout.coordinates},
          {"layout", to_json(start.layout)},
          {"states", list_of(start.states,
                             [](const analysis::LiveState& s) -> Json {
                               return {{"name", s.name}, {"unit", s.unit}, {"moved", s.is_adjustable}};
                             })},
          {"lower", bounds(start.lower)},
          {"upper", bounds(start.upper)},
          {"set", list_of(start.set,
                          [](const auto& s) {
                            return Json::array({s.first, s.second});
                          })},
          {"parameters", list_of(start.parameters,
                                 [](const analysis::LiveParameter& p) -> Json {
                                   return {{"name", p.name},   {"unit", p.unit},         {"note", p.note},
                                           {"value", p.value}, {"positive", p.positive}, {"moved", p.is_adjustable}};
                                 })},
          {"starts", list_of(start.starts,
                             [](const auto& s) {
                               return Json::array({s.first, s.second});
                             })},
          {"inputs", start.inputs},
          {"events", list_of(start.events,
                             [](const analysis::LiveEvent& e) -> Json {
                               Json event{{"name", e.name}, {"stop", e.is_terminal}, {"direction", e.direction}};
                               add_reset(event, e.reset);
                               return event;
                             })},
          {"samples", list_of(start.samples,
                              [](const eom::hybrid::Sample& s) -> Json {
                                Json sample{{"name", s.name},
                                            {"noise", list_of(s.noise, [](const auto& noise) {
                                               return Json::array({noise.component, noise.normal, noise.seed});
                                             })}};
                                add_reset(sample, s.reset);
                                return sample;
                              })},
          {"contacts", list_of(start.contacts,
                               [](const analysis::LiveContact& c) -> Json {
                                 return {{"name", c.name},
                                         {"directions", c.shape.dimensions},
                                         {"surface", c.shape.surface},
                                         {"unilateral", c.shape.unilateral},
                                         {"sticks", c.shape.sticks},
                                         {"slip", c.slip},
                                         {"phi", c.phi},
                                         {"slopes", c.slopes},
                                         {"constraint", c.constraint},
                                         {"restitution", c.restitution ? Json(*c.restitution) : Json(nullptr)}};
                               })},
          {"contact_output_count", start.contact_outputs},
          {"mode_size", start.mode_size},
          {"solved", to_json(start.contact_set)},
          {"reset_count", start.reset_values},
          {"constraints", start.constraints},
          {"event_count", start.event_functions},
          {"size_count", start.sizes}};
}

}  // namespace

void RecordedMotion::row(double t, std::span<const double> values) {
  t_.push_back(t);
  rows_.emplace_back(values.begin(), values.end());
}

void RecordedMotion::drop_every_second_row() {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < t_.size(); ++k) {
    if (k % 2 == 1 && k + 1 < t_.size()) continue;
    t_[kept] = t_[k];
    std::swap(rows_[kept], rows_[k]);
    ++kept;
  }
  t_.resize(kept);
  rows_.resize(kept);
}

std::vector<double> RecordedMotion::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  std::vector<double> result;
  if (found == names_.end()) return result;
  const auto index = static_cast<std::size_t>(found - names_.begin());
  for (const std::vector<double>& row : rows_) result.push_back(row[index]);
  return result;
}

std::string RecordedMotion::plots(const std::vector<Panel>& panels) const {
  std::string result;
  for (const Panel& panel : panels) {
    eom::Plot plot;
    plot.x_label = "t in s";
    plot.y_label = panel.title;
    plot.height = 320;
    for (const std::string& name : panel.names) plot.series.push_back({name, t_, column(name)});
    result += "<figure>" + eom::svg(plot) + "</figure>\n";
  }
  return result;
}

std::vector<std::vector<double>> RecordedMotion::values(const std::vector<std::string>& names) const {
  std::vector<std::vector<double>> result(t_.size());
  for (const std::string& name : names) {
    const std::vector<double> values = column(name);
    for (std::size_t k = 0; k < t_.size(); ++k) result[k].push_back(values.empty() ? 0 : values[k]);
  }
  return result;
}

Json RecordedMotion::rows(const std::vector<std::string>& names, int digits) const {
  return list_of(values(names), [digits](const std::vector<double>& row) {
    return list_of(row, [digits](double x) -> Json { return shortened(x, digits); });
  });
}

Json RecordedMotion::json(const pipeline::Simulation& simulation, const analysis::Drawing& drawing,
                          const analysis::Primitives& primitives, const analysis::DrawnForces& forces,
                          const analysis::LiveModel& live, const std::vector<std::string>& outputs,
                          const std::vector<Panel>& panels) const {
  if (t_.size() < 2) return nullptr;
  const model::Model& model = simulation.derived->model;
  const std::vector<std::string> states = pipeline::state_names(*simulation.derived);
  Json times = Json::array(), curves = Json::array(), events = Json::array(), sizes = Json::array();
  for (const double t : t_) times.push_back(shortened(t, digits_of_states));
  for (const Panel& panel : panels) {
    Json of = Json::array();
    for (const std::string& name : panel.names) {
      const auto state = std::find(states.begin(), states.end(), name);
      const bool is_state = !live.script.empty() && state != states.end();
      const auto place =
          is_state ? state - states.begin() : std::find(outputs.begin(), outputs.end(), name) - outputs.begin();
      of.push_back({{"name", name}, {"state", is_state}, {"at", place}});
    }
    curves.push_back({{"title", panel.title}, {"of", of}});
  }
  for (const run::RunEvent& event : simulation.result.events) events.push_back({{"t", event.t}, {"name", event.name}});
  for (const double size : primitives.size_values) sizes.push_back(shortened(size, digits_of_states));
  const double span = t_.back() - t_.front();
  const auto down = analysis::gravity_direction(simulation.derived->mechanics, simulation.scene.parameters);
  const bool is_live = !live.script.empty();
  Json parts = to_json(drawing.parts(), model, simulation.scene);
  add_primitives(parts, primitives);
  add_forces(parts, forces);
  return {{"t", times},
          {"x", is_live ? rows(states, digits_of_states) : Json(nullptr)},
          {"y", is_live && !live.has_contacts() ? Json(nullptr) : rows(outputs, digits_of_screens)},
          {"t0", simulation.scene.t0},
          {"t1", simulation.scene.t1},
          {"speed", span / std::clamp(span, least_seconds, most_seconds)},
          {"down", down ? Json(*down) : Json(nullptr)},
          {"parts", parts},
          {"p", simulation.scene.parameters},
          {"sizes", sizes},
          {"panels", curves},
          {"events", events},
          {"live", is_live ? to_json(live.start) : Json(nullptr)},
          {"reason", live.reason},
          {"model", model.id}};
}

}  // namespace eomgen::cli
