// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/render.hpp"

#include "print/formulas.hpp"
#include "print/named_lengths.hpp"

namespace eomgen::print {

std::vector<PrintedFormula> render(const mechanics::Mechanics& mechanics, const std::vector<Statement>& all) {
  const Notation notation(mechanics);
  std::vector<PrintedFormula> items;
  for (const Statement& statement : all) {
    PrintedFormula item;
    item.key = statement.key;
    item.name = statement.name;
    item.coordinate = statement.coordinate;
    item.role = statement.role;
    item.left_out = statement.left_out;
    item.text = print(statement.formula, notation, Format::text);
    item.latex = print(statement.formula, notation, Format::latex);
    item.mathml = print(statement.formula, notation, Format::mathml);
    items.push_back(std::move(item));
  }
  return items;
}

std::vector<PrintedFormula> render(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                                   const std::vector<std::string>& show, bool* interrupted, LengthLetters* letters) {
  std::vector<Statement> all;
  std::optional<work::DeferInterrupt> kept;  // partial results are printed after a stop request
  try {
    add_statements(mechanics, form, show, all);
  } catch (const work::Interrupted&) {
    if (interrupted == nullptr) throw;
    kept.emplace();
    *interrupted = true;
  }
  name_lengths(mechanics, all, letters);
  return render(mechanics, all);
}

std::vector<PrintedFormula> render_singular(const mechanics::Mechanics& mechanics) {
  std::vector<Statement> all;
  add_singular(mechanics, all);
  return render(mechanics, all);
}

PrintedFormula render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                                 const reading::Sum& expression) {
  const Notation notation(mechanics);
  PrintedFormula item;
  item.key = std::move(key);
  item.name = std::move(name);
  const reading::Formula formula = reading::arrange(with_powers(expression, reading::powers_of_sums(mechanics)));
  item.text = print(formula, notation, Format::text);
  item.latex = print(formula, notation, Format::latex);
  item.mathml = print(formula, notation, Format::mathml);
  return item;
}

PrintedFormula render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                                 symbolic::Ref expression) {
  try {
    return render_expression(mechanics, key, name, reading::display_sum(mechanics, expression));
  } catch (const work::BudgetExceeded& over) {
    PrintedFormula item;
    item.left_out = over.what();
    item.key = std::move(key);
    item.name = std::move(name);
    item.text = "(too long to be shown)";
    item.latex = "\\text{(too long to be shown)}";
    item.mathml = "<math><mtext>(too long to be shown)</mtext></math>";
    return item;
  }
}

}  // namespace eomgen::print
