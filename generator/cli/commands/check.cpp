// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/examination.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/stage_monitor.hpp"

namespace eomgen::cli::check_command {
namespace {

std::string text(const Json& value) { return value.get<std::string>(); }

/// The value as in the model file, such as "48.85 deg". A bare number gets its declared unit.
std::string as_written(const Json& parameter) {
  const std::string value = text(parameter["value"]), written = text(parameter["written"]),
                    unit = text(parameter["unit"]);
  const bool bare = written.find_first_not_of("0123456789.+-eE") == std::string::npos;
  return bare || written.empty() ? fmt::format("{} {}", value, unit) : written;
}

std::string from_others(const Json& constraint) {
  std::string others;
  for (const Json& name : constraint["integral_of"]) {
    if (name != constraint["name"]) others += (others.empty() ? "" : ", ") + text(name);
  }
  return others.empty() ? "" : "   (with " + others + ")";
}

void print_joints(const Json& found) {
  if (!found["joints"].empty()) fmt::print("\njoints\n");
  for (const Json& j : found["joints"]) {
    std::string open;
    for (const Json& name : j["undetermined"]) open += (open.empty() ? "" : ", ") + text(name);
    fmt::print("  {:<20} {} of {} and {}{}\n", text(j["name"]), text(j["type"]), text(j["bodies"].front()),
               text(j["bodies"][1]), open.empty() ? "" : "; the motion does not determine " + open);
  }
}

void print_readable(const Json& found) {
  const auto heading = [](const char* name) { fmt::print("\n{}\n", name); };
  fmt::print("{}{}{}\n", text(found["model"]), text(found["title"]).empty() ? "" : ": ", text(found["title"]));
  heading("coordinates");
  for (const Json& c : found["coordinates"]) {
    fmt::print("  {:<20} {}{}\n", text(c["name"]), text(c["unit"]),
               c["eliminated"].get<bool>() ? "  (fixed by a constraint)" : "");
  }
  fmt::print("  {} degree{} of freedom\n", found["dof"].get<long>(), found["dof"] == 1 ? "" : "s");
  if (!found["states"].empty()) heading("states of first order");
  for (const Json& z : found["states"]) {
    fmt::print("  {:<20} {:<10} rate {}{}\n", text(z["name"]), text(z["unit"]), text(z["rate"]),
               z["energy_counted"].get<bool>() ? "" : "  (the energy counts none of it)");
  }
  if (!found["discrete"].empty()) heading("discrete values");
  for (const Json& d : found["discrete"]) fmt::print("  {:<20} {}\n", text(d["name"]), text(d["unit"]));
  if (!found["resets"].empty()) heading("changes of the state");
  for (const Json& r : found["resets"]) {
    const bool sample = r["kind"] == "sample";
    fmt::print("  {:<20} {} {}{}\n", text(r["name"]), sample ? "every" : "sign change of",
               text(r[sample ? "every" : "when"]),
               r["condition"].is_null() ? "" : ", if " + r["condition"].get<std::string>());
    for (const auto& [name, value] : r["set"].items()) fmt::print("  {:<20}   {} := {}\n", "", name, text(value));
  }
  heading("parameters");
  for (const Json& p : found["parameters"]) fmt::print("  {:<20} {}\n", text(p["name"]), as_written(p));
  if (!found["inputs"].empty()) heading("inputs");
  for (const Json& u : found["inputs"])
    fmt::print("  {:<20} {}  ({} where a scene gives none)\n", text(u["name"]), text(u["unit"]), text(u["default"]));
  if (!found["constraints"].empty()) heading("constraints");
  for (const Json& c : found["constraints"]) {
    const bool holonomic = c["kind"] == "holonomic";
    fmt::print("  {:<20} {}({}, {})\n", text(c["name"]), holonomic ? text(c["integral"]) + "   " : "", text(c["kind"]),
               text(c["use"]));
    if (holonomic) continue;
    fmt::print("  {:<20}   integrable: {} ({})\n", "", text(c["integrable"]), text(c["reason"]));
    if (!c["integral"].is_null()) fmt::print("  {:<20}   {}{}\n", "", text(c["integral"]), from_others(c));
  }
  print_joints(found);
  if (!found["forces"].empty()) heading("forces");
  for (const Json& f : found["forces"]) {
    fmt::print("  {:<20} conservative: {}", text(f["name"]), text(f["conservative"]));
    if (!f["potential"].is_null())
      fmt::print(", {}U = {}", f["many_valued"].get<bool>() ? "locally " : "", text(f["potential"]));
    for (const Json& condition : f["domain"])
      fmt::print("{}{}", &condition == &f["domain"].front() ? " where " : ", ", text(condition));
    if (!text(f["reason"]).empty()) fmt::print(" ({})", text(f["reason"]));
    fmt::print("\n");
  }
  if (!found["contacts"].empty()) heading("contacts");
  for (const Json& c : found["contacts"]) {
    std::string slip;
    for (const Json& w : c["slip"]) slip += (slip.empty() ? ", slip " : "; ") + text(w);
    const std::string law = c["law"] == "none"     ? "no friction"
                            : c["law"] == "smooth" ? "the smooth law of friction"
                                                   : "Coulomb's law";
    fmt::print("  {:<20} {}, {}{}{}\n", text(c["name"]), text(c["kind"]), law, slip,
               c["unilateral"].get<bool>() ? "; can be left" : "");
  }
  if (!found["conserved"].empty()) heading("conserved");
  for (const Json& c : found["conserved"]) {
    std::string where;
    const Json none = Json::array();
    for (const Json& parameter : c.contains("where_zero") ? c["where_zero"] : none)
      where += (where.empty() ? "   (where " : " and ") + text(parameter) + " = 0";
    if (!where.empty()) where += ")";
    fmt::print("  {:<20} {} = {}{}{}\n", text(c["name"]), text(c["title"]), text(c["expression"]), where,
               c["certainty"] == "numerical" ? "   (shown by numbers)" : "");
  }
  if (!found["singular"].empty()) heading("singular sets");
  for (const Json& s : found["singular"]) fmt::print("  {:<20} (approach {})\n", text(s["set"]), text(s["approach"]));
  if (!found["left_out"].empty()) heading("left out");
  for (const Json& l : found["left_out"]) fmt::print("  {}: {}\n", text(l["what"]), text(l["why"]));
  if (!found["charts"].empty()) heading("charts");
  for (const Json& c : found["charts"]) {
    const bool exchanged = c["exchanged"].get<bool>();
    fmt::print("  {:<20} {}{}\n", text(c["of"]), text(c["own"]),
               exchanged ? fmt::format(", and {} near where it fails", text(c["second"]))
                         : " everywhere: " + text(c["reason"]));
  }
  fmt::print("\nunits: {}\n", text(found["units"]));
}

}  // namespace

Execute declare(Arguments& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("MODEL", *name, "a model file, or the name of one in models/").required();
  return [name](const CommonOptions& common) {
    const auto model = load_model(*name);
    const analysis::Examination examination = analysis::examine(model, true);
    const work::DeferInterrupt kept;
    Json found = to_json(*model, examination);
    if (examination.interrupted) found["left_out"].push_back({{"what", "what is not shown"}, {"why", "interrupted"}});
    if (common.json) {
      print_document(found);
    } else {
      print_readable(found);
    }
    if (examination.interrupted) print_interrupted(nullptr);
    return examination.interrupted ? exit_interrupted : 0;
  };
}

}  // namespace eomgen::cli::check_command
