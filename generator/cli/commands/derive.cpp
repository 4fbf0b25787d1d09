// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/article.hpp"
#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/named_functions.hpp"
#include "cli/output.hpp"
#include "cli/pipeline.hpp"
#include "cli/usage.hpp"
#include "cli/watch.hpp"
#include "derive/lagrange.hpp"
#include "mechanics/dependent.hpp"
#include "model/names.hpp"
#include "print/notation.hpp"
#include "print/render.hpp"

namespace eomgen::cli {
namespace {

using json = nlohmann::ordered_json;

struct Options {
  std::string model, approach = "auto", format = "text", document;
  std::vector<std::string> show{"equations", "constraints", "reactions", "friction"};
};

const std::vector<std::string>& show_keys() {
  static const std::vector<std::string> keys{
      "basis",       "metric",    "christoffel", "line_element", "frenet",   "energies", "lagrangian", "equations",
      "constraints", "reactions", "friction",    "conserved",    "singular", "routh",    "linear",     "all"};
  return keys;
}

void require_keys(const std::vector<std::string>& show) {
  for (const std::string& key : show) {
    if (std::find(show_keys().begin(), show_keys().end(), key) == show_keys().end()) {
      throw Error("derive", {}, fmt::format("there is nothing called {} to show", model::quote(key)),
                  choice_of(key, show_keys()));
    }
  }
}

void require_format(const std::string& format) {
  const std::vector<std::string> known{"text", "latex", "mathml"};
  if (std::find(known.begin(), known.end(), format) != known.end()) return;
  throw Error("derive", {}, fmt::format("there is no format {}", model::quote(format)), choice_of(format, known));
}

const std::string& in_format(const print::Item& item, const std::string& format) {
  return format == "latex" ? item.latex : format == "mathml" ? item.mathml : item.text;
}

std::string name_of(const print::Item& item) {
  std::string name = item.key;
  for (const std::string* part : {&item.name, &item.coordinate, &item.role}) {
    if (!part->empty()) name += (name == item.key ? ": " : ", ") + *part;
  }
  return name;
}

/// Items that took more than their budget, and the equations where they are shown by parts.
std::vector<work::LeftOut> left_out_of(const std::vector<print::Item>& items, const reading::ReadingForm& form) {
  std::vector<work::LeftOut> result;
  if (form.by_parts) result.push_back({"equations written out", form.why_by_parts});
  if (!form.no_spins.empty()) result.push_back({"angular velocities", form.no_spins});
  for (const print::Item& item : items) {
    if (!item.left_out.empty()) result.push_back({name_of(item), item.left_out});
  }
  return result;
}

json to_json(const std::vector<print::Item>& items, const std::string& approach, const std::vector<std::string>& show,
             const std::vector<work::LeftOut>& left_out) {
  json result{{"format", 1}, {"approach", approach}, {"equations", json::array()}, {"reactions", json::array()}};
  const bool all = std::find(show.begin(), show.end(), "all") != show.end();
  for (const std::string& key : show_keys()) {
    const bool wanted =
        std::find(show.begin(), show.end(), key) != show.end() || (all && key != "linear" && key != "routh");
    if (wanted && key != "all") result[key] = json::array();  // also where there turns out to be nothing to show
  }
  for (const print::Item& item : items) {
    if (!item.left_out.empty()) continue;
    json entry;
    if (!item.coordinate.empty()) entry["coordinate"] = item.coordinate;
    if (!item.name.empty()) entry["name"] = item.name;
    if (!item.role.empty()) entry["role"] = item.role;
    entry["text"] = item.text;
    entry["latex"] = item.latex;
    entry["mathml"] = item.mathml;
    result[item.key].push_back(entry);
  }
  result["left_out"] = json::array();
  for (const work::LeftOut& l : left_out) result["left_out"].push_back({{"what", l.what}, {"why", l.why}});
  return result;
}

/// What stands there.
std::string heading_of(const print::Item& item) {
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
  if (item.key == "friction") {  // a contact that can be left is no friction
    const bool of_contact = item.role.starts_with("touches") || item.role.starts_with("is apart") ||
                            item.role == "impact" || item.role == "normal force";
    return fmt::format("{}, {}", named(of_contact ? "contact" : "friction at"), item.role);
  }
  if (item.key == "singular")
    return item.role == "both" ? "where both approaches fail" : fmt::format("where approach {} fails", item.role);
  if (item.key == "conserved") return "conserved, " + item.role;
  if (item.role.empty()) return item.key;
  return item.key + ": " + item.role;
}

/// Which multiplier is which, where there are several.
json legend(const mechanics::Mechanics& m, const reading::ReadingForm& form) {
  json result = json::array();
  const print::Notation notation(m);
  const auto stands = [&](std::uint32_t k) {
    const auto has = [k](const reading::Equation& e) {
      return std::any_of(e.multipliers.begin(), e.multipliers.end(),
                         [k](const auto& term) { return term.constraint == k; });
    };
    return form.by_parts || std::any_of(form.equations.begin(), form.equations.end(), has);
  };
  for (const print::MultiplierMeaning& meaning : print::multiplier_meanings(m)) {
    if (!stands(meaning.constraint)) continue;
    const print::Glyph glyph = notation.multiplier(meaning.constraint);
    result.push_back({{"name", glyph.name},
                      {"of", m.constraints[meaning.constraint].label},
                      {"meaning", meaning.text},
                      {"latex", print::latex(glyph)}});
  }
  return result;
}

std::string readable(const std::vector<print::Item>& items, const std::string& approach, const std::string& format,
                     const std::vector<work::LeftOut>& left_out, const json& multipliers) {
  std::string text = fmt::format("Approach {}\n", approach), heading;
  for (const print::Item& item : items) {
    if (!item.left_out.empty()) continue;
    const std::string next = heading_of(item);
    if (next != heading) text += fmt::format("\n{}\n", next);
    heading = next;
    text += fmt::format("  {}\n", in_format(item, format));
  }
  if (!left_out.empty()) text += "\nleft out\n";
  for (const work::LeftOut& l : left_out) text += fmt::format("  {}: {}\n", l.what, l.why);
  if (!multipliers.empty()) text += "\nwhich multiplier is which\n";
  for (const json& entry : multipliers)
    text += fmt::format("  {}: {}\n", entry["name"].get<std::string>(), entry["meaning"].get<std::string>());
  return text;
}

void add_conserved(mechanics::Mechanics& mechanics, const std::vector<std::string>& show,
                   std::vector<print::Item>& items) {
  const bool wanted =
      std::any_of(show.begin(), show.end(), [](const auto& key) { return key == "conserved" || key == "all"; });
  if (!wanted) return;
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
  const reading::ReadingForm form = reading::derive_reading(mechanics, system::Approach::two);
  for (const derive::Conserved& c : derive::conserved_quantities(mechanics, system)) {
    const auto named = in_named_functions(mechanics, form, c);
    print::Item item = named ? print::render_expression(mechanics, "conserved", c.name, *named)
                             : print::render_expression(mechanics, "conserved", c.name, c.expression);
    item.role = c.title;
    items.push_back(std::move(item));
  }
}

// Only on request: it is another form of the equations that `all` shows already.
void add_routh(mechanics::Mechanics& mechanics, const std::vector<std::string>& show, std::vector<print::Item>& items) {
  if (std::find(show.begin(), show.end(), "routh") == show.end()) return;
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
  const std::vector<std::uint32_t> cyclic = derive::cyclic_coordinates(derive::conserved_quantities(mechanics, system));
  const reading::RouthForm form = reading::routh_form(mechanics, cyclic);
  if (cyclic.empty()) tell("no coordinate is cyclic: there is nothing to reduce\n");
  if (form.by_parts) tell("the reduction is too long to be written out, or the momenta do not give the rates\n");
  for (print::Item& item : print::render_routh(mechanics, form)) items.push_back(std::move(item));
}

// Only on request: n^2 entries of four matrices, twice.
void add_linear(const mechanics::Mechanics& mechanics, const std::vector<std::string>& show,
                std::vector<print::Item>& items) {
  if (std::find(show.begin(), show.end(), "linear") == show.end()) return;
  for (print::Item& item : print::render_linear(mechanics, reading::linear_form(mechanics)))
    items.push_back(std::move(item));
}

int execute(const Options& options, const Common& common) {
  require_keys(options.show);
  require_format(options.format);
  const ApproachChoice choice = approach_choice(options.approach);
  if (!options.document.empty())
    require_places({{"--document", options.document, ".tex"}}, locate_model(options.model), common.json);
  const work::Stage stage("deriving the equations");
  model::Model model = load_model(options.model);
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  // Approach I shows the constraint forces too, so it is what `auto` means wherever something is eliminated.
  const bool one = choice == ApproachChoice::one ||
                   (choice == ApproachChoice::automatic &&
                    !(mechanics::impose_dependent(mechanics).fixed.empty() && mechanics.contacts.empty()));
  const system::Approach approach = one ? system::Approach::one : system::Approach::two;
  const reading::ReadingForm form = reading::derive_reading(mechanics, approach);
  bool interrupted = false, written = false;
  std::vector<print::Item> items = print::render(mechanics, form, options.show, &interrupted);
  try {
    if (!interrupted) {
      add_conserved(mechanics, options.show, items);
      add_routh(mechanics, options.show, items);
      add_linear(mechanics, options.show, items);
      if (!options.document.empty()) {
        const ArticleText document = article(options.model, common.seed);
        const work::Kept whole;
        write_text(options.document, document.text);
        written = true;
      }
    }
  } catch (const work::Interrupted&) {
    interrupted = true;
  }
  const work::Kept kept;
  std::vector<work::LeftOut> left_out = left_out_of(items, form);
  if (interrupted) left_out.push_back({"what is not shown", "interrupted"});
  const bool about_forces = std::any_of(options.show.begin(), options.show.end(), [](const auto& key) {
    return key == "equations" || key == "reactions" || key == "all";
  });
  const json multipliers = about_forces ? legend(mechanics, form) : json::array();
  if (common.json) {
    json result = to_json(items, system::name(approach), options.show, left_out);
    result["multipliers"] = multipliers;
    if (!options.document.empty()) result["document"] = written ? json(options.document) : json(nullptr);
    print_document(result);
  } else {
    const bool taken = is_standard_output(options.document);
    print_readable(readable(items, system::name(approach), options.format, left_out, multipliers), taken);
    if (written && !taken) print_readable(fmt::format("\nwrote {}\n", options.document), taken);
  }
  if (interrupted) tell_interrupted(nullptr);
  return interrupted ? exit_interrupted : 0;
}

}  // namespace

Execute declare_derive(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--approach", options->approach, "auto, I or II")->capture_default_str();
  add_list(app, "--show", options->show, fmt::format("what to show; a list of {}", fmt::join(show_keys(), ", ")));
  app.add_option("--format", options->format, "text, latex or mathml")->capture_default_str();
  add_place(app, "--document", options->document, "the whole derivation as a LaTeX document, F.tex");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli
