// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/examination.hpp"

namespace eomgen::cli {
namespace {

Json values(const std::vector<ExaminedQuantity>& quantities, const char* key, bool written) {
  return list_of(quantities, [&](const ExaminedQuantity& q) {
    Json entry{{"name", q.name}, {"unit", q.unit}, {key, q.value}};
    if (written) entry["written"] = q.written;
    return entry;
  });
}

Json to_json(const analysis::ExaminedReset& r) {
  Json set = Json::object();
  for (const auto& [name, value] : r.set) set[name] = value;
  return {{"name", r.name},
          {"kind", r.sample ? "sample" : "event"},
          {r.sample ? "every" : "when", r.when},
          {"condition", r.condition.empty() ? Json(nullptr) : Json(r.condition)},
          {"set", set}};
}

Json to_json(const ConstraintClass& c) {
  Json entry = EOMGEN_MEMBERS(c, name, kind, integrable, integral, redundant, determined);
  entry["use"] = c.treatment;
  entry["reason"] = c.reason;
  entry["integral_of"] = c.integral_of;
  return entry;
}

Json to_json(const ForceClass& f) {
  return {{"name", f.name},
          {"conservative", f.conservative},
          {"potential", f.potential ? Json(f.potential->text) : Json(nullptr)},
          {"domain", f.domain},
          {"many_valued", f.many_valued},
          {"in_energy", f.in_energy},
          {"reason", f.reason}};
}

Json to_json(const analysis::ExaminedConserved& c) {
  Json entry{{"name", c.name}, {"title", c.title}, {"expression", c.expression.text}, {"certainty", c.certainty}};
  if (!c.where_zero.empty()) entry["where_zero"] = c.where_zero;
  return entry;
}

Json to_json(const analysis::ExaminedChart& c) {
  Json entry = EOMGEN_MEMBERS(c, of, own, second, angles);
  entry["exchanged"] = c.refusal.empty();
  entry["reason"] = c.refusal;
  return entry;
}

Json to_json(const Warning& w) {
  return {{"message", w.message}, {"line", w.where.line}, {"column", w.where.column}, {"remedy", w.remedy}};
}

constexpr auto entry = [](const auto& item) { return to_json(item); };

}  // namespace

Json to_json(const model::Model& model, const analysis::Examination& found) {
  return {{"format", 1},
          {"model", model.id},
          {"title", model.title},
          {"coordinates",
           list_of(found.coordinates, [](const auto& c) { return EOMGEN_MEMBERS(c, name, unit, eliminated); })},
          {"dof", found.degrees_of_freedom},
          {"states",
           list_of(found.states, [](const auto& z) { return EOMGEN_MEMBERS(z, name, unit, rate, energy_counted); })},
          {"discrete", list_of(found.discrete, [](const auto& d) { return EOMGEN_MEMBERS(d, name, unit); })},
          {"resets", list_of(found.resets, entry)},
          {"parameters", values(found.parameters, "value", true)},
          {"inputs", values(found.inputs, "default", false)},
          {"constraints", list_of(found.constraints, entry)},
          {"joints",
           list_of(found.joints,
                   [](const auto& j) { return EOMGEN_MEMBERS(j, name, type, bodies, axes, reactions, undetermined); })},
          {"forces", list_of(found.forces, entry)},
          {"contacts",
           list_of(found.contacts, [](const auto& c) { return EOMGEN_MEMBERS(c, name, kind, law, slip, unilateral); })},
          {"conserved", list_of(found.conserved, entry)},
          {"singular", list_of(found.singular,
                               [](const analysis::ExaminedSet& s) -> Json {
                                 return {{"set", s.set.text}, {"approach", s.approach}};
                               })},
          {"charts", list_of(found.charts, entry)},
          {"units", found.has_all_units ? "checked" : "checked where they are given"},
          {"warnings", list_of(model.warnings, entry)},
          {"left_out", to_json(found.left_out)}};
}

}  // namespace eomgen::cli
