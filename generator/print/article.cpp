// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/article.hpp"

#include <algorithm>

#include "model/names.hpp"
#include "print/article_parts.hpp"

namespace eomgen::print {

using mechanics::Mechanics;
using reading::Formula;
using symbolic::SymbolKind;

bool Article::approaches_differ() const {
  const auto fixes = [](const reading::DisplayConstraint& c) { return c.fixes.has_value(); };
  return std::any_of(two.constraints.begin(), two.constraints.end(), fixes);
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

namespace {

bool uses_amssymb(const model::Model& model) {
  const auto in = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& named) { return model::needs_amssymb(named.tex); });
  };
  return in(model.parameters) || in(model.inputs) || in(model.functions) || in(model.coordinates) || in(model.states);
}

}  // namespace

std::string bold(const std::string& name) { return "\\textbf{" + escape_user_text(name) + "}"; }

std::string latex_document(const Mechanics& m, const reading::DisplayForm& one, const reading::DisplayForm& two,
                           const std::optional<Findings>& findings) {
  const Notation notation(m);
  LatexWriter out(notation);
  const model::Model& model = *m.model;
  Article article{m, model, one, two, findings ? &*findings : nullptr, out};
  if (findings) article.left_out = findings->left_out;
  if (uses_amssymb(model)) out.use_package("amssymb");
  out.title(model.title.empty() ? model.id : model.title);
  if (!model.notes.empty()) out.paragraph(escape_user_text(model.notes));
  write_system(article);
  write_coordinates(article);
  write_energies(article);
  write_equations(article);
  write_constraint_forces(article);
  write_contacts(article);
  if (findings) {
    write_conserved_quantities(article);
    write_routh(article);
    write_steady_motions(article);
  }
  write_singular_sets(article);
  write_certificate(article);
  return out.finish();
}

}  // namespace eomgen::print
