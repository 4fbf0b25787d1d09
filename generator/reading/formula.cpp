// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/formula.hpp"

namespace eomgen::reading {

Formula number(const Rational& value) {
  Formula f;
  f.number = cln::abs(value);
  return cln::minusp(value) ? negative(std::move(f)) : f;
}

Formula symbol(const Symbol& s) {
  Formula f;
  f.kind = FormulaKind::symbol;
  f.symbol = s;
  return f;
}

Formula mark(std::string word, std::vector<Formula> lower, std::vector<Formula> upper) {
  Formula f;
  f.kind = FormulaKind::mark;
  f.word = std::move(word);
  f.lower = std::move(lower);
  f.upper = std::move(upper);
  return f;
}

Formula make_formula(FormulaKind form, std::vector<Formula> args) {
  Formula f;
  f.kind = form;
  f.args = std::move(args);
  return f;
}

bool is_zero(const Formula& f) { return f.kind == FormulaKind::number && cln::zerop(f.number); }

Formula negative(Formula a) {
  if (a.kind == FormulaKind::negative) {
    Formula inside = std::move(a.args[0]);
    return inside;
  }
  if (is_zero(a)) return a;
  return make_formula(FormulaKind::negative, {std::move(a)});
}

Formula product(std::vector<Formula> factors) {
  bool minus = false;
  Rational number = 1;
  std::vector<Formula> flat;
  for (Formula& f : factors) {
    if (f.kind == FormulaKind::negative) {
      minus = !minus;
      Formula inside = std::move(f.args[0]);
      f = std::move(inside);
    }
    std::vector<Formula> parts;
    if (f.kind == FormulaKind::product)
      parts = std::move(f.args);
    else
      parts.push_back(std::move(f));
    for (Formula& part : parts) {
      if (part.kind == FormulaKind::number)
        number = number * part.number;
      else
        flat.push_back(std::move(part));
    }
  }
  if (cln::zerop(number)) return reading::number(0);
  if (flat.empty() || !is_one(number)) flat.insert(flat.begin(), reading::number(number));
  Formula result = flat.size() == 1 ? flat[0] : make_formula(FormulaKind::product, std::move(flat));
  return minus ? negative(std::move(result)) : result;
}

Formula fraction(Formula above, Formula below) {
  if (below.kind == FormulaKind::number && is_one(below.number)) return above;
  if (above.kind == FormulaKind::negative) return negative(fraction(std::move(above.args[0]), std::move(below)));
  return make_formula(FormulaKind::fraction, {std::move(above), std::move(below)});
}

Formula sum(std::vector<Formula> terms) {
  std::vector<Formula> flat;
  for (Formula& f : terms) {
    if (is_zero(f)) continue;
    if (f.kind == FormulaKind::sum)
      flat.insert(flat.end(), f.args.begin(), f.args.end());
    else
      flat.push_back(std::move(f));
  }
  if (flat.empty()) return number(0);
  if (flat.size() == 1) return flat[0];
  return make_formula(FormulaKind::sum, std::move(flat));
}

Formula relation(std::vector<Formula> sides) { return make_formula(FormulaKind::relation, std::move(sides)); }

}  // namespace eomgen::reading
