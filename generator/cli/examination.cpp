// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/examination.hpp"

namespace eomgen::cli {
namespace {

Json list(const std::vector<std::string>& names) {
  Json result = Json::array();
  for (const std::string& name : names) result.push_back(name);
  return result;
}

Json values(const std::vector<ExaminedQuantity>& quantities, const char* key, bool written) {
  Json result = Json::array();
  for (const ExaminedQuantity& q : quantities) {
    result.push_back({{"name", q.name}, {"unit", q.unit}, {key, q.value}});
    if (written) result.back()["written"] = q.written;
  }
  return result;
}

Json constraints(const analysis::Examination& found) {
  Json result = Json::array();
  for (const ConstraintClass& c : found.constraints) {
    result.push_back({{"name", c.name},
                      {"kind", c.kind},
                      {"integrable", c.integrable},
                      {"integral", or_null(c.integral)},
                      {"redundant", c.redundant},
                      {"determined", or_null(c.determined)},
                      {"use", c.treatment},
                      {"reason", c.reason},
                      {"integral_of", list(c.integral_of)}});
  }
  return result;
}

Json joints(const analysis::Examination& found) {
  Json result = Json::array();
  for (const analysis::ExaminedJoint& j : found.joints) {
    result.push_back({{"name", j.name},
                      {"type", j.type},
                      {"bodies", {j.bodies[0], j.bodies[1]}},
                      {"axes", j.axes},
                      {"reactions", list(j.reactions)},
                      {"undetermined", list(j.undetermined)}});
  }
  return result;
}

Json forces(const analysis::Examination& found) {
  Json result = Json::array();
  for (const ForceClass& f : found.forces) {
    result.push_back({{"name", f.name},
                      {"conservative", f.conservative},
                      {"potential", f.potential ? Json(f.potential->text) : Json(nullptr)},
                      {"domain", list(f.domain)},
                      {"many_valued", f.many_valued},
                      {"in_energy", f.in_energy},
                      {"reason", f.reason}});
  }
  return result;
}

}  // namespace

Json to_json(const model::Model& model, const analysis::Examination& found) {
  Json result{{"format", 1}, {"model", model.id}, {"title", model.title}};
  Json coordinates = Json::array(), states = Json::array(), contacts = Json::array(), conserved = Json::array(),
       singular = Json::array(), charts = Json::array(), warnings = Json::array(), left_out = Json::array();
  for (const auto& c : found.coordinates)
    coordinates.push_back({{"name", c.name}, {"unit", c.unit}, {"eliminated", c.eliminated}});
  for (const auto& z : found.states) {
    states.push_back({{"name", z.name}, {"unit", z.unit}, {"rate", z.rate}, {"energy_counted", z.energy_counted}});
  }
  Json discrete = Json::array(), resets = Json::array();
  for (const auto& d : found.discrete) discrete.push_back({{"name", d.name}, {"unit", d.unit}});
  for (const auto& r : found.resets) {
    Json set = Json::object();
    for (const auto& [name, value] : r.set) set[name] = value;
    resets.push_back({{"name", r.name},
                      {"kind", r.sample ? "sample" : "event"},
                      {r.sample ? "every" : "when", r.when},
                      {"condition", r.condition.empty() ? Json(nullptr) : Json(r.condition)},
                      {"set", set}});
  }
  for (const auto& c : found.contacts) {
    contacts.push_back(
        {{"name", c.name}, {"kind", c.kind}, {"law", c.law}, {"slip", list(c.slip)}, {"unilateral", c.unilateral}});
  }
  for (const auto& c : found.conserved) {
    conserved.push_back(
        {{"name", c.name}, {"title", c.title}, {"expression", c.expression.text}, {"certainty", c.certainty}});
    if (!c.where_zero.empty()) conserved.back()["where_zero"] = c.where_zero;
  }
  for (const auto& s : found.singular) singular.push_back({{"set", s.set.text}, {"approach", s.approach}});
  for (const auto& c : found.charts) {
    charts.push_back({{"of", c.of},
                      {"own", c.own},
                      {"second", c.second},
                      {"angles", list(c.angles)},
                      {"exchanged", c.refusal.empty()},
                      {"reason", c.refusal}});
  }
  for (const Warning& w : model.warnings) {
    warnings.push_back(
        {{"message", w.message}, {"line", w.where.line}, {"column", w.where.column}, {"remedy", w.remedy}});
  }
  for (const work::LeftOut& l : found.left_out) left_out.push_back({{"what", l.what}, {"why", l.why}});
  result["coordinates"] = coordinates;
  result["dof"] = found.degrees_of_freedom;
  result["states"] = states;
  result["discrete"] = discrete;
  result["resets"] = resets;
  result["parameters"] = values(found.parameters, "value", true);
  result["inputs"] = values(found.inputs, "default", false);
  result["constraints"] = constraints(found);
  result["joints"] = joints(found);
  result["forces"] = forces(found);
  result["contacts"] = contacts;
  result["conserved"] = conserved;
  result["singular"] = singular;
  result["charts"] = charts;
  result["units"] = found.has_all_units ? "checked" : "checked where they are given";
  result["warnings"] = warnings;
  result["left_out"] = left_out;
  return result;
}

}  // namespace eomgen::cli
