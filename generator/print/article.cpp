// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/article.hpp"

#include <algorithm>

#include "model/names.hpp"
#include "print/article_parts.hpp"
#include "print/named_lengths.hpp"

namespace eomgen::print {

bool Article::approaches_differ() const {
  const auto fixes = [](const reading::DisplayConstraint& c) { return c.fixes.has_value(); };
  return std::any_of(two.constraints.begin(), two.constraints.end(), fixes);
}

bool Article::omits(std::string_view part) const {
  return std::find(omitted.begin(), omitted.end(), part) != omitted.end();
}

std::string Article::coordinate_math(std::uint32_t coordinate, std::uint8_t order) const {
  return out.math(reading::symbol({SymbolKind::coordinate, coordinate, order}));
}

std::vector<Formula> Article::formulas(const std::vector<Statement>& statements) {
  std::vector<Formula> result;
  for (const Statement& s : statements) {
    if (s.left_out.empty())
      result.push_back(s.formula);
    else
      left_out.push_back({s.name + (s.role.empty() ? "" : ", " + s.role), s.left_out});
  }
  return result;
}

void Article::find_lengths() {
  std::vector<Statement> all;
  for (const reading::DisplayForm* form : {&one, &two}) {
    if (form->is_unexpanded) continue;
    add_energies(m, *form, all);
    add_equations(m, *form, all);
  }
  const auto size = static_cast<std::ptrdiff_t>(all.size());
  name_lengths(m, all, &letters);
  lengths.assign(all.begin() + size, all.end());
}

Formula Article::with_letters(Formula formula) const {
  LengthLetters known = letters;
  std::vector<Statement> all{{"equations", "", "", "", formula}};
  name_lengths(m, all, &known);
  return all.size() == 1 ? all[0].formula : formula;  // others would have no definition
}

namespace {

bool uses_amssymb(const model::Model& model) {
  const auto in = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& named) { return model::needs_amssymb(named.tex); });
  };
  return in(model.parameters) || in(model.inputs) || in(model.functions) || in(model.coordinates) || in(model.states);
}

}  // namespace

std::string bold(const std::string& name) { return "\\textbf{" + escape_user_text(name) + "}"; }

void require_document_parts(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const DocumentPart& part : document_parts) known.emplace_back(part.name);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw Error("document", {}, "a document has no part " + model::quote(name) + " that can be omitted",
                model::suggest_choice(name, known));
  }
}

std::string latex_document(const Mechanics& m, const reading::DisplayForm& one, const reading::DisplayForm& two,
                           const std::optional<Findings>& findings, const std::vector<std::string>& omitted) {
  const Notation notation(m);
  LatexWriter out(notation);
  const model::Model& model = *m.model;
  Article article{m, model, one, two, findings ? &*findings : nullptr, out, omitted};
  if (findings) article.left_out = findings->left_out;
  article.powers = reading::powers_of_sums(m);
  article.find_lengths();
  for (const DocumentPart& part : document_parts) {
    if (article.omits(part.name)) article.left_out.push_back({std::string(part.what), "omitted on request"});
  }
  if (uses_amssymb(model)) out.use_package("amssymb");
  out.title(model.title.empty() ? model.id : model.title);
  if (!model.notes.empty()) out.paragraph(escape_user_text(model.notes));
  write_system(article);
  write_coordinates(article);
  write_energies(article);
  write_equations(article);
  if (!article.omits("constraint_forces")) write_constraint_forces(article);
  write_contacts(article);
  if (findings && !article.omits("conserved")) write_conserved_quantities(article);
  if (findings && !article.omits("routh")) write_routh(article);
  if (findings && !article.omits("steady")) write_steady_motions(article);
  if (!article.omits("singular")) write_singular_sets(article);
  write_certificate(article);
  return out.finish();
}

}  // namespace eomgen::print
