// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/render.hpp"

#include <algorithm>

#include "print/formulas.hpp"
#include "print/named_lengths.hpp"

namespace eomgen::print {
namespace {

// Of a formula in one line: somewhat more than an equation of 300 terms has, the longest that is written out.
constexpr std::size_t most_factors = 3000, most_parts = 10000;

/// Subtracts the parts of a formula from `left`; false if there are more.
bool take_parts(const reading::Formula& formula, std::size_t& left) {
  if (left == 0) return false;
  --left;
  const auto fits = [&](const reading::Formula& part) { return take_parts(part, left); };
  return std::all_of(formula.args.begin(), formula.args.end(), fits) &&
         std::all_of(formula.lower.begin(), formula.lower.end(), fits) &&
         std::all_of(formula.upper.begin(), formula.upper.end(), fits);
}

}  // namespace

std::vector<PrintedFormula> render(const mechanics::Mechanics& mechanics, const std::vector<Statement>& statements) {
  std::vector<Statement> all = statements;
  for (Statement& statement : all) {
    std::size_t left = most_parts;
    if (take_parts(statement.formula, left)) continue;
    statement.formula = reading::mark("...");
    if (statement.left_out.empty()) statement.left_out = reading::TermBudget().what();
  }
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
    const reading::Sum sum = reading::display_sum(mechanics, expression);
    if (reading::has_more_factors(sum, most_factors)) throw reading::TermBudget();
    return render_expression(mechanics, key, name, sum);
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
