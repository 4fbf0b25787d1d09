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

constexpr std::size_t fewest_terms = 4, fewest_places = 2;

bool is_root_of_sum(const Formula& f) {
  return f.kind == FormulaKind::call && f.op == symbolic::Op::sqrt && f.args[0].kind == FormulaKind::sum;
}

bool is_shortened(const Statement& s) {
  return s.left_out.empty() && (s.key == "energies" || s.key == "lagrangian" || s.key == "equations" ||
                                s.key == "explicit" || s.key == "solved" || s.key == "linear" || s.key == "routh");
}

/// `of_spring`: inside a bracket of the model, s - l0.
void visit(Formula& f, const std::function<void(Formula&, bool)>& action, bool of_spring = false) {
  if (is_root_of_sum(f)) return action(f, of_spring);
  for (auto* list : {&f.args, &f.lower, &f.upper}) {
    for (Formula& part : *list) visit(part, action, of_spring || f.keeps_sign);
  }
}

struct Length {
  Formula formula;
  std::size_t places = 0;
  bool of_spring = false;
  std::size_t number = 0;  // of those with a letter, from 1

  bool has_letter() const {
    return places >= fewest_places && (of_spring || formula.args[0].args.size() >= fewest_terms);
  }
};

}  // namespace

void name_lengths(const mechanics::Mechanics& m, std::vector<Statement>& statements, LengthLetters* given) {
  LengthLetters own;
  LengthLetters& letters = given != nullptr ? *given : own;
  const Notation notation(m);
  std::map<std::string, Length> lengths;  // by their text
  std::vector<std::string> order;         // of their first places
  const auto each = [&](const std::function<void(Formula&, Length&, bool)>& action) {
    for (Statement& s : statements) {
      if (!is_shortened(s)) continue;
      visit(s.formula, [&](Formula& f, bool of_spring) {
        const std::string text = print(f, notation, Format::text);
        if (!lengths.contains(text)) order.push_back(text);
        action(f, lengths[text], of_spring);
      });
    }
  };
  each([](Formula& f, Length& length, bool of_spring) {
    if (length.places++ == 0) length.formula = f;
    length.of_spring = length.of_spring || of_spring;
  });
  const std::vector<std::string> earlier = letters.texts;
  for (const std::string& text : order) {
    const auto known = std::find(letters.texts.begin(), letters.texts.end(), text);
    lengths[text].number = static_cast<std::size_t>(known - letters.texts.begin()) + 1;
    if (known != letters.texts.end()) continue;
    if (lengths[text].has_letter())
      letters.texts.push_back(text);
    else
      lengths[text].number = 0;
  }
  if (earlier.empty()) letters.has_first_alone = letters.texts.size() == 1;
  if (letters.texts.empty()) return;
  const std::string letter = free_letter(*m.model, "s", "sigma");
  const auto named = [&](const Length& length) {
    return length.number == 1 && letters.has_first_alone
               ? reading::mark(letter)
               : reading::mark(letter, {reading::number(static_cast<long>(length.number))});
  };
  each([&](Formula& f, Length& length, bool) {
    if (length.number > 0) f = named(length);
  });
  for (const std::string& text : order) {
    const Length& length = lengths[text];
    if (length.number > earlier.size())
      statements.push_back({"parts", "", "", "length", reading::relation({named(length), length.formula})});
  }
}

}  // namespace eomgen::print
