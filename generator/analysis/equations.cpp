// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/equations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <variant>

#include "analysis/named_functions.hpp"
#include "conservation/zero_parameters.hpp"
#include "derive/formulations/lagrange.hpp"
#include "error.hpp"
#include "mechanics/dependent_coordinates.hpp"
#include "model/names.hpp"
#include "print/notation.hpp"
#include "reading/forms.hpp"

namespace eomgen::analysis {

const std::vector<std::string>& equation_keys() {
  static const std::vector<std::string> keys{
      "kinematics", "regressor", "basis",       "metric",        "christoffel", "line_element", "frenet",   "energies",
      "lagrangian", "equations", "constraints", "reactions",     "friction",    "conserved",    "singular", "routh",
      "linear",     "solved",    "forces",      "contravariant", "balance",     "all"};
  return keys;
}

bool is_part_of_all(const std::string& key) {
  static const std::vector<std::string> on_request{"kinematics", "regressor", "linear",        "routh",
                                                   "solved",     "forces",    "contravariant", "balance"};
  return std::find(on_request.begin(), on_request.end(), key) == on_request.end();
}

namespace {

void require_keys(const std::vector<std::string>& show) {
  for (const std::string& key : show) {
    if (std::find(equation_keys().begin(), equation_keys().end(), key) == equation_keys().end()) {
      throw Error("derive", {}, fmt::format("there is nothing called {} to show", model::quote(key)),
                  model::suggest_choice(key, equation_keys()));
    }
  }
}

std::string name_of(const print::PrintedFormula& item) {
  std::string name = item.key;
  for (const std::string* part : {&item.name, &item.coordinate, &item.role}) {
    if (!part->empty()) name += (name == item.key ? ": " : ", ") + *part;
  }
  return name;
}

/// Items that exceeded their budget, and equations that are shown in parts.
std::vector<work::LeftOut> omissions_of(const std::vector<print::PrintedFormula>& items,
                                        const reading::DisplayForm& form) {
  std::vector<work::LeftOut> result;
  if (form.is_unexpanded) result.push_back({"equations written out", form.unexpanded_reason});
  if (!form.rotations_skip_reason.empty()) result.push_back({"angular velocities", form.rotations_skip_reason});
  for (const print::PrintedFormula& item : items) {
    if (!item.left_out.empty()) result.push_back({name_of(item), item.left_out});
  }
  return result;
}

/// Meaning of the multipliers, if there are several.
std::vector<Multiplier> legend(const mechanics::Mechanics& m, const reading::DisplayForm& form) {
  std::vector<Multiplier> result;
  const print::Notation notation(m);
  const auto stands = [&](std::uint32_t k) {
    const auto has = [k](const reading::Equation& e) {
      return std::any_of(e.multipliers.begin(), e.multipliers.end(),
                         [k](const auto& term) { return term.constraint == k; });
    };
    return form.is_unexpanded || std::any_of(form.equations.begin(), form.equations.end(), has);
  };
  for (const print::MultiplierDescription& meaning : print::multiplier_descriptions(m)) {
    if (!stands(meaning.constraint)) continue;
    const print::Glyph glyph = notation.multiplier(meaning.constraint);
    result.push_back({glyph.name, print::latex(glyph), m.constraints[meaning.constraint].label, meaning.text});
  }
  return result;
}

void add_conserved(mechanics::Mechanics& mechanics, reading::DisplayForms& forms, const std::vector<std::string>& show,
                   std::vector<print::PrintedFormula>& items) {
  const bool wanted =
      std::any_of(show.begin(), show.end(), [](const auto& key) { return key == "conserved" || key == "all"; });
  if (!wanted) return;
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
  const reading::DisplayForm& form = forms(system::Approach::two, reading::Extent::equations);
  std::vector<conservation::ConservedQuantity> all = conservation::conserved_quantities(mechanics, system);
  for (conservation::ConservedQuantity& c : conservation::conserved_where_zero(mechanics, system, all))
    all.push_back(std::move(c));
  for (const conservation::ConservedQuantity& c : all) {
    const auto named = express_in_named_functions(mechanics, form, c);
    print::PrintedFormula item = named ? print::render_expression(mechanics, "conserved", c.name, *named)
                                       : print::render_expression(mechanics, "conserved", c.name, c.expression);
    item.role = c.title;
    for (const std::uint32_t p : c.zero_parameters) {
      item.role += p == c.zero_parameters.front() ? ", where " : " and ";
      item.role += mechanics.model->parameters[p].name + " = 0";
    }
    items.push_back(std::move(item));
  }
}

// Only on explicit request: another form of equations that `all` shows already.
void add_routh(mechanics::Mechanics& mechanics, reading::DisplayForms& forms, const std::vector<std::string>& show,
               print::LengthLetters& letters, std::vector<print::PrintedFormula>& items,
               std::vector<std::string>& notes) {
  if (std::find(show.begin(), show.end(), "routh") == show.end()) return;
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
  const std::vector<std::uint32_t> cyclic =
      conservation::cyclic_coordinates(conservation::conserved_quantities(mechanics, system));
  const reading::RouthForm form = forms.routh(cyclic);
  if (cyclic.empty()) notes.emplace_back("no coordinate is cyclic: there is nothing to reduce");
  if (form.is_unexpanded)
    notes.emplace_back("the reduction is too long to be written out, or the momenta do not give the rates");
  for (print::PrintedFormula& item : print::render_routh(mechanics, form, &letters)) items.push_back(std::move(item));
}

/// The values of coordinates and inputs at the start of a scene, as formulas. Rates are 0 in an equilibrium.
std::map<reading::Symbol, reading::Sum> start_of_scene(mechanics::Mechanics& m, const std::string& name) {
  const model::Model& model = *m.model;
  const auto scene =
      std::find_if(model.scenes.begin(), model.scenes.end(), [&](const model::Scene& s) { return s.name == name; });
  if (scene == model.scenes.end()) {
    std::vector<std::string> names;
    for (const model::Scene& s : model.scenes) names.push_back(s.name);
    throw Error("derive", {}, fmt::format("there is no scene {}", model::quote(name)),
                model::suggest_choice(name, names));
  }
  std::map<reading::Symbol, reading::Sum> values;
  const auto value = [&](model::NodeId expression) {
    return reading::display_sum(m, mechanics::lower_scalar(m, expression));
  };
  for (const model::InitialValue& initial : scene->initial) {
    if (initial.order == 0) values[{reading::SymbolKind::coordinate, initial.coordinate, 0}] = value(initial.value);
  }
  for (std::uint32_t u = 0; u < model.inputs.size(); ++u) {
    model::NodeId signal = model.inputs[u].default_value;
    for (const model::SceneInput& input : scene->inputs) {
      if (input.input != u) continue;
      const auto* constant = std::get_if<model::NodeId>(&input.signal);
      if (constant == nullptr)
        throw Error("derive", model.where(input.span), "an input that changes leaves no equilibrium",
                    "name a scene in which this input is constant");
      signal = *constant;
    }
    if (signal != model::no_node) values[{reading::SymbolKind::input, u, 0}] = value(signal);
  }
  return values;
}

// Only on explicit request: n^2 entries of four matrices, twice.
void add_linear(mechanics::Mechanics& mechanics, reading::DisplayForms& forms, const EquationsRequest& request,
                print::LengthLetters& letters, std::vector<print::PrintedFormula>& items) {
  const std::vector<std::string>& show = request.show;
  if (std::find(show.begin(), show.end(), "linear") == show.end()) {
    if (request.about.empty()) return;
    throw Error("derive", {}, "an equilibrium is named, but no linearised equations are shown", "add --show linear");
  }
  if (!request.about.empty()) {
    const reading::LinearEquations form =
        reading::linear_equations(mechanics, forms.linear(), start_of_scene(mechanics, request.about));
    for (print::PrintedFormula& item : print::render_linear(mechanics, form, request.about))
      items.push_back(std::move(item));
    return;
  }
  for (print::PrintedFormula& item : print::render_linear(mechanics, forms.linear(), &letters))
    items.push_back(std::move(item));
}

// Only on explicit request: the equations that `all` shows, solved.
void add_solved(const mechanics::Mechanics& mechanics, reading::DisplayForms& forms,
                const std::vector<std::string>& show, print::LengthLetters& letters,
                std::vector<print::PrintedFormula>& items) {
  if (std::find(show.begin(), show.end(), "solved") == show.end()) return;
  std::vector<reading::FrictionMode> modes{reading::FrictionMode::given};
  if (reading::can_hold(mechanics)) modes.push_back(reading::FrictionMode::holding);
  for (const reading::FrictionMode mode : modes) {
    for (print::PrintedFormula& item : print::render_solved(mechanics, forms.solved(mode), &letters))
      items.push_back(std::move(item));
  }
}

system::Approach displayed_approach(const mechanics::Mechanics& m) {
  const bool one = !mechanics::eliminate_dependent_coordinates(m).fixed.empty() || !m.contacts.empty();
  return one ? system::Approach::one : system::Approach::two;
}

}  // namespace

reading::DisplayForm displayed_form(const mechanics::Mechanics& m) {
  return reading::derive_display_form(m, displayed_approach(m));
}

Equations equations(std::shared_ptr<const model::Model> model, const EquationsRequest& request) {
  using pipeline::ApproachChoice;
  require_keys(request.show);
  const work::Stage stage("deriving the equations");
  mechanics::Mechanics mechanics = mechanics::build_mechanics(std::move(model));
  reading::DisplayForms forms(mechanics);
  const reading::DisplayForm& form = forms(request.approach == ApproachChoice::automatic ? displayed_approach(mechanics)
                                           : request.approach == ApproachChoice::one     ? system::Approach::one
                                                                                         : system::Approach::two);
  Equations result;
  result.approach = form.approach;
  print::LengthLetters letters;
  result.items = print::render(mechanics, form, request.show, &result.interrupted, &letters);
  try {
    if (!result.interrupted) {
      add_conserved(mechanics, forms, request.show, result.items);
      add_routh(mechanics, forms, request.show, letters, result.items, result.notes);
      add_linear(mechanics, forms, request, letters, result.items);
      add_solved(mechanics, forms, request.show, letters, result.items);
    }
  } catch (const work::Interrupted&) {
    result.interrupted = true;
  }
  const work::DeferInterrupt kept;
  result.left_out = omissions_of(result.items, form);
  const bool about_forces = std::any_of(request.show.begin(), request.show.end(), [](const auto& key) {
    return key == "equations" || key == "reactions" || key == "solved" || key == "all";
  });
  if (about_forces) result.multipliers = legend(mechanics, form);
  return result;
}

}  // namespace eomgen::analysis
