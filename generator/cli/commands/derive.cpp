// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "analysis/equations.hpp"
#include "analysis/latex_document.hpp"
#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/shared_options.hpp"
#include "cli/stage_monitor.hpp"
#include "cli/usage.hpp"
#include "print/article.hpp"

namespace eomgen::cli::derive_command {
namespace {

struct Options {
  std::string model, approach = "auto", format = "text", document, about;
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"}, omit;
};

void require_format(const std::string& format) {
  const std::vector<std::string> known{"text", "latex", "mathml"};
  if (std::find(known.begin(), known.end(), format) != known.end()) return;
  throw Error("derive", {}, fmt::format("there is no format {}", model::quote(format)), suggest_choice(format, known));
}

const std::string& in_format(const print::PrintedFormula& item, const std::string& format) {
  return format == "latex" ? item.latex : format == "mathml" ? item.mathml : item.text;
}

Json to_json(const std::vector<print::PrintedFormula>& items, const std::string& approach,
             const std::vector<std::string>& show, const std::vector<work::LeftOut>& left_out) {
  Json result{{"format", 1}, {"approach", approach}, {"equations", Json::array()}, {"reactions", Json::array()}};
  const bool all = std::find(show.begin(), show.end(), "all") != show.end();
  for (const std::string& key : analysis::equation_keys()) {
    const bool wanted =
        std::find(show.begin(), show.end(), key) != show.end() || (all && analysis::is_part_of_all(key));
    if (wanted && key != "all") result[key] = Json::array();  // present even if there is nothing to show
  }
  for (const print::PrintedFormula& item : items) {
    if (!item.left_out.empty()) continue;
    Json entry;
    if (!item.coordinate.empty()) entry["coordinate"] = item.coordinate;
    if (!item.name.empty()) entry["name"] = item.name;
    if (!item.role.empty()) entry["role"] = item.role;
    entry["text"] = item.text;
    entry["latex"] = item.latex;
    entry["mathml"] = item.mathml;
    result[item.key].push_back(entry);
  }
  result["left_out"] = cli::to_json(left_out);
  return result;
}

std::string solved_heading(const print::PrintedFormula& item) {
  const bool of_place = item.role.starts_with("constraint ");
  if (item.role == "closed form") return "closed form of the motion, from initial values at t = 0";
  return (of_place ? fmt::format("{} on '{}'", item.role, item.name) : item.role) + ", as a function of the state";
}

/// Whether such formulas are of a particle, a body, or the configuration manifold.
bool is_geometry(const std::string& key) {
  return key == "basis" || key == "metric" || key == "line_element" || key == "christoffel";
}

/// Heading of a group of formulas.
std::string heading_of(const print::PrintedFormula& item) {
  const auto named = [&](const std::string& what) {
    return item.name.empty() ? what : fmt::format("{} '{}'", what, item.name);
  };
  if (item.key == "equations" || item.key == "explicit") {
    return (item.role == "motion" ? "equations of motion" : "equations that give the constraint forces") +
           std::string(item.key == "explicit" ? ", written out" : "");
  }
  if (item.key == "constraints")
    return item.role == "function of time" ? "functions of time"
                                           : fmt::format("{}, {}", named("constraint"), item.role);
  if (item.key == "reactions")
    return item.role.empty() ? "multipliers" : fmt::format("{} on '{}'", item.role, item.name);
  if (item.key == "friction") {  // some items describe the contact, not its friction
    const bool of_contact = item.role.starts_with("is closed") || item.role.starts_with("is open") ||
                            item.role == "impact" || item.role == "normal force";
    return fmt::format("{}, {}", named(of_contact ? "contact" : "friction at"), item.role);
  }
  if (item.key == "singular")
    return item.role == "both" ? "where both approaches fail" : fmt::format("where approach {} fails", item.role);
  if (item.key == "conserved") return "conserved, " + item.role;
  if (item.key == "solved") return solved_heading(item);
  if (item.key == "forces") return fmt::format("'{}', {}", item.name, item.role);
  if (item.key == "kinematics") return fmt::format("'{}', {}", item.name, item.role);
  if (item.key == "regressor")
    return item.name.empty() ? item.key
                             : fmt::format("'{}', {}{}", item.name, item.role,
                                           item.coordinate.empty() ? "" : ", equation of " + item.coordinate);
  if (item.key == "parts") return "where";
  if (item.key == "states") return "states of first order";
  if (item.key == "resets") return fmt::format("new values at {} '{}', from those before", item.role, item.name);
  if (is_geometry(item.key) && !item.name.empty() && item.name != "system") {
    const std::string what = item.role.empty() ? item.key : item.key + ": " + item.role;
    return item.name == "configuration manifold" ? what + " of the configuration manifold"
                                                 : fmt::format("{} of '{}'", what, item.name);
  }
  if (item.role.empty()) return item.key;
  return item.key + ": " + item.role;
}

/// `asked`: items that were named one by one; the text lists those that the model lacks.
std::string readable(const std::vector<print::PrintedFormula>& items, const std::string& approach,
                     const std::string& format, const std::vector<work::LeftOut>& left_out,
                     const std::vector<Multiplier>& multipliers, const std::vector<std::string>& asked) {
  std::string text = fmt::format("Approach {}\n", approach), heading;
  for (const print::PrintedFormula& item : items) {
    if (!item.left_out.empty()) continue;
    const std::string next = heading_of(item);
    if (next != heading) text += fmt::format("\n{}\n", next);
    heading = next;
    text += fmt::format("  {}\n", in_format(item, format));
  }
  for (const std::string& key : asked) {
    const auto is_of_key = [&](const auto& item) { return item.key == key; };
    if (std::none_of(items.begin(), items.end(), is_of_key)) text += fmt::format("\n{}\n  none\n", key);
  }
  if (!left_out.empty()) text += "\nleft out\n";
  for (const work::LeftOut& l : left_out) text += fmt::format("  {}: {}\n", l.what, l.why);
  if (!multipliers.empty()) text += "\nmeaning of the multipliers\n";
  for (const Multiplier& entry : multipliers) text += fmt::format("  {}: {}\n", entry.name, entry.meaning);
  return text;
}

Json to_json(const std::vector<Multiplier>& multipliers) {
  return list_of(multipliers, [](const Multiplier& m) -> Json {
    return {{"name", m.name}, {"of", m.constraint}, {"meaning", m.meaning}, {"latex", m.latex}};
  });
}

int execute(const Options& options, const CommonOptions& common) {
  require_format(options.format);
  const analysis::EquationsRequest request{pipeline::parse_approach(options.approach), options.show, options.about};
  if (!options.document.empty())
    require_writable_targets({{"--document", options.document, ".tex"}}, locate_model(options.model), common.json);
  if (!options.omit.empty() && options.document.empty())
    throw Error("usage", {}, "--omit is for documents, and none is written",
                "add --document F.tex, or leave --omit out");
  print::require_document_parts(options.omit);
  const auto model = load_model(options.model);
  analysis::Equations found = analysis::equations(model, request);
  for (const std::string& note : found.notes) print_message(note + "\n");
  bool written = false;
  try {
    if (!found.interrupted && !options.document.empty()) {
      const std::string document = analysis::latex_document(model, common.seed, options.omit);
      const work::DeferInterrupt whole;
      write_text(options.document, document);
      written = true;
    }
  } catch (const work::Interrupted&) {
    found.interrupted = true;
  }
  const work::DeferInterrupt kept;
  if (found.interrupted) found.left_out.push_back({"what is not shown", "interrupted"});
  const std::string approach = system::name(found.approach);
  if (common.json) {
    Json result = to_json(found.items, approach, options.show, found.left_out);
    result["multipliers"] = to_json(found.multipliers);
    if (!options.document.empty()) result["document"] = written ? Json(options.document) : Json(nullptr);
    print_document(result);
  } else {
    const bool taken = is_standard_output(options.document);
    std::vector<std::string> asked;
    if (options.show != Options{}.show && !found.interrupted) asked = options.show;
    std::erase(asked, "all");
    print_readable(readable(found.items, approach, options.format, found.left_out, found.multipliers, asked), taken);
    if (written && !taken) print_readable(fmt::format("\nwrote {}\n", options.document), taken);
  }
  if (found.interrupted) print_interrupted(nullptr);
  return found.interrupted ? exit_interrupted : 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_approach(app, options->approach);
  app.add_list("--show", options->show,
               fmt::format("what to show; a list of {}", fmt::join(analysis::equation_keys(), ", ")))
      .suggest_values(analysis::equation_keys());
  app.add_option("--about", options->about, "the scene whose start is the equilibrium of --show linear");
  app.add_option("--format", options->format, "text, latex or mathml")
      .show_default()
      .suggest_values({"text", "latex", "mathml"});
  app.add_output_path("--document", options->document, "the whole derivation as a LaTeX document, F.tex");
  add_omit(app, options->omit);
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::derive_command
