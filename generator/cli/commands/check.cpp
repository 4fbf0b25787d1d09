// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/charts.hpp"
#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/examination.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/watch.hpp"
#include "derive/conservative.hpp"
#include "derive/conserved.hpp"
#include "derive/lagrange.hpp"
#include "print/render.hpp"
#include "reading/reading.hpp"

namespace eomgen::cli {
namespace {

using json = nlohmann::ordered_json;

std::string shown(const mechanics::Mechanics& m, symbolic::Ref expression) {
  return print::render_expression(m, "", "", expression).text;
}

json constraints_of(const mechanics::Mechanics& m) {
  json result = json::array();
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    const mechanics::Constraint& c = m.constraints[k];
    const mechanics::Classification& found = m.classification[k];
    std::string use = "keeps a multiplier";
    for (const mechanics::FixedCoordinate& fixed : m.fixed) {
      if (m.constraints[fixed.constraint].label == c.label)
        use = "fixes " + m.model->coordinates[fixed.coordinate].name;
    }
    if (c.need == mechanics::Need::identity) use = "holds identically, without a multiplier";
    if (c.need == mechanics::Need::redundant) use = "follows from the others, without a multiplier; watched";
    const auto of_joint = [&](const model::Joint& joint) { return joint.name == c.name; };
    const bool joint = std::any_of(m.model->joints.begin(), m.model->joints.end(), of_joint);
    if (!c.determined && !joint) use += "; the motion does not determine its force";
    // A holonomic constraint is its own integral.
    json of = json::array();
    json integral = c.holonomic() ? json(shown(m, c.psi) + " = 0") : json(nullptr);
    for (const mechanics::Integral& i : m.integrals) {
      if (i.label != c.label) continue;
      integral = shown(m, i.psi) + " = constant";
      for (const std::uint32_t part : i.of) of.push_back(m.constraints[part].label);
    }
    result.push_back({{"name", c.label},
                      {"kind", c.holonomic() ? "holonomic" : "velocity"},
                      {"integrable", mechanics::name(found.integrable)},
                      {"integral", integral},
                      {"redundant", !m.holds(static_cast<std::uint32_t>(k))},
                      {"determined", joint ? json(nullptr) : json(c.determined)},
                      {"use", use},
                      {"reason", found.reason},
                      {"integral_of", of}});
  }
  return result;
}

json joints_of(const mechanics::Mechanics& m) {
  json result = json::array();
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const model::Joint& joint = m.model->joints[i];
    json determined = json::array(), open = json::array();
    for (std::size_t j = 0; j < model::joint_components; ++j) {
      (m.joints[i].determined[j] ? determined : open).push_back(fmt::format("reaction.{}.{}", joint.name, j + 1));
    }
    result.push_back({{"name", joint.name},
                      {"type", joint.type},
                      {"bodies", {m.model->frames[joint.frames[0]].name, m.model->frames[joint.frames[1]].name}},
                      {"axes", m.model->frames[joint.axes].name},
                      {"reactions", determined},
                      {"undetermined", open}});
  }
  return result;
}

json forces_of(mechanics::Mechanics& m) {
  json result = json::array();
  for (const derive::ForceClass& force : derive::classify_forces(m)) {
    json domain = json::array();
    for (const derive::DomainCondition& c : force.domain) domain.push_back(shown(m, c.expression) + " " + c.relation);
    std::string reason = force.reason;
    if (force.work) reason += ", of " + shown(m, *force.work) + " each time";
    result.push_back({{"name", force.name},
                      {"conservative", derive::name(force.conservative)},
                      {"potential", force.potential ? json(shown(m, *force.potential)) : json(nullptr)},
                      {"domain", domain},
                      {"many_valued", force.many_valued},
                      {"in_energy", force.in_energy},
                      {"reason", reason}});
  }
  return result;
}

json contacts_of(const mechanics::Mechanics& m) {
  json result = json::array();
  for (const mechanics::Contact& contact : m.contacts) {
    const std::size_t equations = contact.constraints.size();
    json slip = json::array();
    for (const symbolic::Ref w : contact.slip) slip.push_back(shown(m, w));
    result.push_back({{"name", contact.name},
                      {"kind", equations == 0   ? "coordinate"
                               : equations == 1 ? "surface"
                                                : "curve"},
                      {"law", contact.dimensions() == 0 ? "none"
                              : contact.width           ? "smooth"
                                                        : "coulomb"},
                      {"slip", slip},
                      {"unilateral", contact.unilateral}});
  }
  return result;
}

json singular_of(const mechanics::Mechanics& m, json& left_out) {
  json result = json::array();
  for (const print::Item& item : print::render_singular(m)) {
    if (item.left_out.empty())
      result.push_back({{"set", item.text}, {"approach", item.role}});
    else
      left_out.push_back({{"what", "singular sets: " + item.name}, {"why", item.left_out}});
  }
  return result;
}

json charts_of_model(const mechanics::Mechanics& m) {
  json result = json::array();
  for (const model::SwitchedChart& chart : charts_of(m)) {
    json angles = json::array();
    for (const std::uint32_t q : chart.angles) angles.push_back(m.model->coordinates[q].name);
    result.push_back({{"of", chart.of},
                      {"own", chart.own},
                      {"second", chart.second},
                      {"angles", angles},
                      {"exchanged", chart.refusal.empty()},
                      {"reason", chart.refusal}});
  }
  return result;
}

// A number as a decimal; what other parameters determine as their expression.
std::string value_of(const mechanics::Mechanics& m, symbolic::Ref value) {
  return m.dag->is_constant(value) ? decimal_text(m.dag->value(value)) : shown(m, value);
}

void fill_in(const model::Model& model, json& found) {
  mechanics::Mechanics m = mechanics::build_mechanics(model);
  bool every_unit = true;
  for (std::uint32_t i = 0; i < model.coordinates.size(); ++i) {
    const model::Coordinate& c = model.coordinates[i];
    found["coordinates"].push_back({{"name", c.name}, {"unit", c.unit.text}, {"eliminated", m.is_eliminated(i)}});
    every_unit = every_unit && c.unit.dimension.has_value();
  }
  found["dof"] = m.freedom();
  for (const model::Parameter& p : model.parameters) {
    found["parameters"].push_back({{"name", p.name},
                                   {"unit", p.unit.text},
                                   {"value", value_of(m, m.parameter_value[found["parameters"].size()])},
                                   {"written", p.written}});
    every_unit = every_unit && p.unit.dimension.has_value();
  }
  for (const model::Input& input : model.inputs) {
    found["inputs"].push_back(
        {{"name", input.name},
         {"unit", input.unit.text},
         {"default",
          input.fallback == model::no_node ? "0" : value_of(m, mechanics::lower_scalar(m, input.fallback))}});
    every_unit = every_unit && input.unit.dimension.has_value();
  }
  found["units"] = every_unit ? "checked" : "checked where they are given";
  found["constraints"] = constraints_of(m);
  found["joints"] = joints_of(m);
  found["contacts"] = contacts_of(m);
  found["charts"] = charts_of_model(m);
  found["forces"] = forces_of(m);
  system::EquationSystem system = derive::lagrange(m, system::Approach::two);
  for (const derive::Conserved& c : derive::conserved_quantities(m, system)) {
    found["conserved"].push_back({{"name", c.name},
                                  {"title", c.title},
                                  {"expression", shown(m, c.expression)},
                                  {"certainty", derive::name(c.certainty)}});
  }
  found["singular"] = singular_of(m, found["left_out"]);
}

}  // namespace

json examine(const model::Model& model, bool* interrupted) {
  const work::Stage stage("examining the model");
  json found{{"format", 1}, {"model", model.id}, {"title", model.title}};
  for (const char* key : {"coordinates", "dof", "parameters", "inputs", "constraints", "joints", "forces", "contacts",
                          "conserved", "singular", "charts", "units", "warnings", "left_out"}) {
    found[key] = json::array();
  }
  found["dof"] = 0;
  found["units"] = "checked where they are given";
  for (const Warning& w : model.warnings) {
    found["warnings"].push_back(
        {{"message", w.message}, {"line", w.where.line}, {"column", w.where.column}, {"remedy", w.remedy}});
  }
  try {
    fill_in(model, found);
  } catch (const work::Interrupted&) {
    if (interrupted == nullptr) throw;
    *interrupted = true;
  }
  return found;
}

namespace {

std::string text(const json& value) { return value.get<std::string>(); }

/// "48.85 deg", as the author has it; a bare number with the unit that it was given.
std::string as_written(const json& parameter) {
  const std::string value = text(parameter["value"]), written = text(parameter["written"]),
                    unit = text(parameter["unit"]);
  const bool bare = written.find_first_not_of("0123456789.+-eE") == std::string::npos;
  return bare || written.empty() ? fmt::format("{} {}", value, unit) : written;
}

std::string from_others(const json& constraint) {
  std::string others;
  for (const json& name : constraint["integral_of"]) {
    if (name != constraint["name"]) others += (others.empty() ? "" : ", ") + text(name);
  }
  return others.empty() ? "" : "   (with " + others + ")";
}

void print_joints(const json& found) {
  if (!found["joints"].empty()) fmt::print("\njoints\n");
  for (const json& j : found["joints"]) {
    std::string open;
    for (const json& name : j["undetermined"]) open += (open.empty() ? "" : ", ") + text(name);
    fmt::print("  {:<20} {} of {} and {}{}\n", text(j["name"]), text(j["type"]), text(j["bodies"][0]),
               text(j["bodies"][1]), open.empty() ? "" : "; the motion does not determine " + open);
  }
}

void print_readable(const json& found) {
  const auto heading = [](const char* name) { fmt::print("\n{}\n", name); };
  fmt::print("{}{}{}\n", text(found["model"]), text(found["title"]).empty() ? "" : ": ", text(found["title"]));
  heading("coordinates");
  for (const json& c : found["coordinates"]) {
    fmt::print("  {:<20} {}{}\n", text(c["name"]), text(c["unit"]),
               c["eliminated"].get<bool>() ? "  (fixed by a constraint)" : "");
  }
  fmt::print("  {} degree{} of freedom\n", found["dof"].get<long>(), found["dof"] == 1 ? "" : "s");
  heading("parameters");
  for (const json& p : found["parameters"]) fmt::print("  {:<20} {}\n", text(p["name"]), as_written(p));
  if (!found["inputs"].empty()) heading("inputs");
  for (const json& u : found["inputs"])
    fmt::print("  {:<20} {}  ({} where a scene gives none)\n", text(u["name"]), text(u["unit"]), text(u["default"]));
  if (!found["constraints"].empty()) heading("constraints");
  for (const json& c : found["constraints"]) {
    const bool holonomic = c["kind"] == "holonomic";
    fmt::print("  {:<20} {}({}, {})\n", text(c["name"]), holonomic ? text(c["integral"]) + "   " : "", text(c["kind"]),
               text(c["use"]));
    if (holonomic) continue;
    fmt::print("  {:<20}   integrable: {} ({})\n", "", text(c["integrable"]), text(c["reason"]));
    if (!c["integral"].is_null()) fmt::print("  {:<20}   {}{}\n", "", text(c["integral"]), from_others(c));
  }
  print_joints(found);
  if (!found["forces"].empty()) heading("forces");
  for (const json& f : found["forces"]) {
    fmt::print("  {:<20} conservative: {}", text(f["name"]), text(f["conservative"]));
    if (!f["potential"].is_null())
      fmt::print(", {}U = {}", f["many_valued"].get<bool>() ? "locally " : "", text(f["potential"]));
    for (const json& condition : f["domain"])
      fmt::print("{}{}", &condition == &f["domain"].front() ? " where " : ", ", text(condition));
    if (!text(f["reason"]).empty()) fmt::print(" ({})", text(f["reason"]));
    fmt::print("\n");
  }
  if (!found["contacts"].empty()) heading("contacts");
  for (const json& c : found["contacts"]) {
    std::string slip;
    for (const json& w : c["slip"]) slip += (slip.empty() ? ", slip " : "; ") + text(w);
    const std::string law = c["law"] == "none"     ? "no friction"
                            : c["law"] == "smooth" ? "the smooth law of friction"
                                                   : "Coulomb's law";
    fmt::print("  {:<20} {}, {}{}{}\n", text(c["name"]), text(c["kind"]), law, slip,
               c["unilateral"].get<bool>() ? "; can be left" : "");
  }
  if (!found["conserved"].empty()) heading("conserved");
  for (const json& c : found["conserved"]) {
    fmt::print("  {:<20} {} = {}{}\n", text(c["name"]), text(c["title"]), text(c["expression"]),
               c["certainty"] == "numerical" ? "   (shown by numbers)" : "");
  }
  if (!found["singular"].empty()) heading("singular sets");
  for (const json& s : found["singular"]) fmt::print("  {:<20} (approach {})\n", text(s["set"]), text(s["approach"]));
  if (!found["left_out"].empty()) heading("left out");
  for (const json& l : found["left_out"]) fmt::print("  {}: {}\n", text(l["what"]), text(l["why"]));
  if (!found["charts"].empty()) heading("charts");
  for (const json& c : found["charts"]) {
    const bool exchanged = c["exchanged"].get<bool>();
    fmt::print("  {:<20} {}{}\n", text(c["of"]), text(c["own"]),
               exchanged ? fmt::format(", and {} near where it fails", text(c["second"]))
                         : " everywhere: " + text(c["reason"]));
  }
  fmt::print("\nunits: {}\n", text(found["units"]));
}

}  // namespace

Execute declare_check(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("MODEL", *name, "a model file, or the name of one in models/")->required();
  return [name](const Common& common) {
    const model::Model model = load_model(*name);
    bool interrupted = false;
    json found = examine(model, &interrupted);
    const work::Kept kept;
    if (interrupted) found["left_out"].push_back({{"what", "what is not shown"}, {"why", "interrupted"}});
    if (common.json) {
      print_document(found);
    } else {
      print_readable(found);
    }
    if (interrupted) tell_interrupted(nullptr);
    return interrupted ? exit_interrupted : 0;
  };
}

}  // namespace eomgen::cli
