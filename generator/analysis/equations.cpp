// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/equations.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/named_functions.hpp"
#include "derive/formulations/lagrange.hpp"
#include "error.hpp"
#include "mechanics/dependent_coordinates.hpp"
#include "model/names.hpp"
#include "print/notation.hpp"
#include "reading/forms.hpp"

namespace eomgen::analysis {

const std::vector<std::string>& equation_keys() {
  static const std::vector<std::string> keys{"kinematics", "basis",    "metric",     "christoffel", "line_element",
                                             "frenet",     "energies", "lagrangian", "equations",   "constraints",
                                             "reactions",  "friction", "conserved",  "singular",    "routh",
                                             "linear",     "all"};
  return keys;
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
  for (const conservation::ConservedQuantity& c : conservation::conserved_quantities(mechanics, system)) {
    const auto named = express_in_named_functions(mechanics, form, c);
    print::PrintedFormula item = named ? print::render_expression(mechanics, "conserved", c.name, *named)
                                       : print::render_expression(mechanics, "conserved", c.name, c.expression);
    item.role = c.title;
    items.push_back(std::move(item));
  }
}

// Only on explicit request: another form of equations that `all` shows already.
void add_routh(mechanics::Mechanics& mechanics, reading::DisplayForms& forms, const std::vector<std::string>& show,
               std::vector<print::PrintedFormula>& items, std::vector<std::string>& notes) {
  if (std::find(show.begin(), show.end(), "routh") == show.end()) return;
  system::EquationSystem system = derive::lagrange(mechanics, system::Approach::two);
  const std::vector<std::uint32_t> cyclic =
      conservation::cyclic_coordinates(conservation::conserved_quantities(mechanics, system));
  const reading::RouthForm form = forms.routh(cyclic);
  if (cyclic.empty()) notes.emplace_back("no coordinate is cyclic: there is nothing to reduce");
  if (form.is_unexpanded)
    notes.emplace_back("the reduction is too long to be written out, or the momenta do not give the rates");
  for (print::PrintedFormula& item : print::render_routh(mechanics, form)) items.push_back(std::move(item));
}

// Only on explicit request: n^2 entries of four matrices, twice.
void add_linear(const mechanics::Mechanics& mechanics, reading::DisplayForms& forms,
                const std::vector<std::string>& show, std::vector<print::PrintedFormula>& items) {
  if (std::find(show.begin(), show.end(), "linear") == show.end()) return;
  for (print::PrintedFormula& item : print::render_linear(mechanics, forms.linear())) items.push_back(std::move(item));
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
  result.items = print::render(mechanics, form, request.show, &result.interrupted);
  try {
    if (!result.interrupted) {
      add_conserved(mechanics, forms, request.show, result.items);
      add_routh(mechanics, forms, request.show, result.items, result.notes);
      add_linear(mechanics, forms, request.show, result.items);
    }
  } catch (const work::Interrupted&) {
    result.interrupted = true;
  }
  const work::DeferInterrupt kept;
  result.left_out = omissions_of(result.items, form);
  const bool about_forces = std::any_of(request.show.begin(), request.show.end(), [](const auto& key) {
    return key == "equations" || key == "reactions" || key == "all";
  });
  if (about_forces) result.multipliers = legend(mechanics, form);
  return result;
}

}  // namespace eomgen::analysis
