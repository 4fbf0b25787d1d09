// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/named_lengths.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "print/letters.hpp"
#include "print/printer.hpp"

namespace eomgen::print {
namespace {

using reading::Formula;
using reading::FormulaKind;

constexpr std::size_t fewest_terms = 4, fewest_places = 2;

bool is_length(const Formula& f) {
  return f.kind == FormulaKind::call && f.op == symbolic::Op::sqrt && f.args[0].kind == FormulaKind::sum &&
         f.args[0].args.size() >= fewest_terms;
}

bool is_shortened(const Statement& s) {
  return s.left_out.empty() &&
         (s.key == "energies" || s.key == "lagrangian" || s.key == "equations" || s.key == "explicit" ||
          s.key == "solved");
}

void visit(Formula& f, const std::function<void(Formula&)>& action) {
  if (is_length(f)) return action(f);
  for (auto* list : {&f.args, &f.lower, &f.upper}) {
    for (Formula& part : *list) visit(part, action);
  }
}

struct Length {
  Formula formula;
  std::size_t places = 0;
  std::size_t number = 0;  // of those with a letter, from 1
};

}  // namespace

void name_lengths(const mechanics::Mechanics& m, std::vector<Statement>& statements) {
  const Notation notation(m);
  std::map<std::string, Length> lengths;  // by their text
  std::vector<std::string> order;         // of their first places
  const auto each = [&](const std::function<void(Formula&, Length&)>& action) {
    for (Statement& s : statements) {
      if (!is_shortened(s)) continue;
      visit(s.formula, [&](Formula& f) {
        const std::string text = print(f, notation, Format::text);
        if (!lengths.contains(text)) order.push_back(text);
        action(f, lengths[text]);
      });
    }
  };
  each([](Formula& f, Length& length) {
    if (length.places++ == 0) length.formula = f;
  });
  std::size_t count = 0;
  for (const std::string& text : order) {
    if (lengths[text].places >= fewest_places) lengths[text].number = ++count;
  }
  if (count == 0) return;
  const std::string letter = free_letter(*m.model, "s", "sigma");
  const auto named = [&](const Length& length) {
    return count == 1 ? reading::mark(letter)
                      : reading::mark(letter, {reading::number(static_cast<long>(length.number))});
  };
  each([&](Formula& f, Length& length) {
    if (length.number > 0) f = named(length);
  });
  for (const std::string& text : order) {
    const Length& length = lengths[text];
    if (length.number > 0)
      statements.push_back({"parts", "", "", "length", reading::relation({named(length), length.formula})});
  }
}

}  // namespace eomgen::print
