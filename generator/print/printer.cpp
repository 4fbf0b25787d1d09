// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/printer.hpp"

#include <cln/integer.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "lists.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::print {
namespace {

using reading::Formula;
using reading::FormulaKind;
using reading::Op;

/// Abbreviation of terms that are too long for a line. Lines break between terms, never within roots or fractions.
class Shortener {
 public:
  /// `text`: prints a term. `fits`: whether that text fits on a line.
  Shortener(std::function<std::string(const reading::Formula&)> text, std::function<bool(const std::string&)> fits)
      : text_(std::move(text)), fits_(std::move(fits)) {}

  bool fits(const reading::Formula& term) const { return fits_(text_(term)); }

  /// Replaces the longest sums within the term by S_1, S_2, ... until it fits.
  Formula operator()(Formula term) {
    while (!fits(term)) {
      Formula* longest = nullptr;
      std::size_t length = 0;
      const std::function<void(Formula&)> visit = [&](Formula& f) {
        if (f.kind == FormulaKind::sum) {
          const std::size_t here = text_(f).size();
          if (here > length) longest = &f, length = here;
          return;
        }
        for (Formula& arg : f.args) visit(arg);
      };
      visit(term);
      if (!longest) break;
      *longest = name_of(*longest);
    }
    return term;
  }

  /// The abbreviated sums so far; S_1 is the first.
  const std::vector<reading::Formula>& definitions() const { return definitions_; }
  static Formula abbreviation(std::size_t index) {
    return reading::mark("cal S", {reading::number(static_cast<long>(index) + 1)});
  }

 private:
  Formula name_of(const Formula& sum) {
    const std::string text = text_(sum);
    const auto known = std::find(texts_.begin(), texts_.end(), text);
    const auto index = static_cast<std::size_t>(known - texts_.begin());
    if (known == texts_.end()) texts_.push_back(text), definitions_.push_back(sum);
    return abbreviation(index);
  }

  std::function<std::string(const reading::Formula&)> text_;
  std::function<bool(const std::string&)> fits_;
  std::vector<reading::Formula> definitions_;
  std::vector<std::string> texts_;  // texts of the sums: equal sums share a name
};

/// 9.81 instead of 981/100: fractions with denominators from 100 on that end within four decimals; otherwise nothing.
std::optional<std::string> as_decimal(const reading::Rational& value, long least_denominator = 100) {
  constexpr long most = 10000;
  const cln::cl_I bottom = cln::denominator(value);
  if (bottom < least_denominator || cln::mod(most, bottom) != 0) return std::nullopt;
  const cln::cl_I shifted = cln::numerator(value) * cln::exquo(cln::cl_I(most), bottom),
                  whole = cln::floor1(shifted, most);
  if (whole > most) return std::nullopt;
  std::string decimals = std::to_string(cln::cl_I_to_long(most + cln::mod(shifted, most))).substr(1);
  decimals.erase(decimals.find_last_not_of('0') + 1);
  return std::to_string(cln::cl_I_to_long(whole)) + "." + decimals;
}

/// The degrees of a fraction of pi with a denominator from 100 on, if they end within four decimals.
std::optional<std::string> as_degrees(const reading::Rational& of_pi) {
  if (cln::denominator(of_pi) < 100) return std::nullopt;
  std::optional<std::string> degrees = as_decimal(180 * of_pi, 1);
  if (degrees && degrees->ends_with('.')) degrees->pop_back();
  return degrees;
}

/// 48.85 for 977 pi/3600.
std::optional<std::string> as_degrees(const Formula& f) {
  if (f.kind != FormulaKind::fraction || f.args[1].kind != FormulaKind::number) return std::nullopt;
  const Formula& above = f.args[0];
  const bool scaled = above.kind == FormulaKind::product && above.args.size() == 2 &&
                      above.args[0].kind == FormulaKind::number && above.args[1].kind == FormulaKind::pi;
  if (!scaled && above.kind != FormulaKind::pi) return std::nullopt;
  return as_degrees((scaled ? above.args[0].number : reading::Rational(1)) / f.args[1].number);
}

class FormulaPrinter {
 public:
  FormulaPrinter(const Style& style, const Notation& notation) : style_(style), notation_(notation) {}

  Piece operator()(const Formula& f) const {
    switch (f.kind) {
      case FormulaKind::number: return number(f);
      case FormulaKind::pi: return style_.pi();
      case FormulaKind::symbol: return symbol(f.symbol);
      case FormulaKind::mark: return style_.mark(f.word, texts(f.lower), texts(f.upper));
      case FormulaKind::call: return style_.call(f.op, arguments(f));
      case FormulaKind::power: return power(f);
      case FormulaKind::negative: return {style_.leading_minus() + at_least(f.args[0], Piece::product), Piece::sum};
      case FormulaKind::product: return product(f);
      case FormulaKind::fraction: return style_.fraction((*this)(f.args[0]), (*this)(f.args[1]));
      case FormulaKind::sum: return f.keeps_sign ? angle(f) : Piece{joined(signed_terms(f)), Piece::sum};
      case FormulaKind::rate: return style_.time_derivative((*this)(f.args[0]));
      case FormulaKind::partial: return style_.partial((*this)(f.args[0]), (*this)(f.args[1]));
      case FormulaKind::dot: return style_.dotted((*this)(f.args[0]), f.order);
      case FormulaKind::dot_product:
        return style_.dot_product({at_least(f.args[0], Piece::product)}, {at_least(f.args[1], Piece::product)});
      case FormulaKind::differential: return style_.differential((*this)(f.args[0]));
      case FormulaKind::relation: return {listed(f.args, between(f)), Piece::relation};
      case FormulaKind::list: return {listed(f.args, style_.comma()), Piece::relation};
    }
    return {};
  }

  std::string between(const Formula& relation) const {
    return relation.word == reading::at_least ? style_.at_least() : style_.equals();
  }

  /// Top-level terms of all sides of a relation with signs and equals signs, then the definitions of abbreviations.
  std::string lay_out(const Formula& f) const {
    std::vector<std::string> all;
    std::vector<PieceStart> starts;
    const auto add = [&](std::vector<std::string> terms, const std::string& before, PieceStart start) {
      terms.front() = before + terms.front();
      for (std::size_t i = 0; i < terms.size(); ++i) {
        all.push_back(std::move(terms[i]));
        starts.push_back(i == 0 ? start : PieceStart::none);
      }
    };
    Shortener shortener([this](const Formula& term) { return at_least(term, Piece::product); },
                        [this](const std::string& text) { return style_.fits(text); });
    const std::vector<Formula> sides = f.kind == FormulaKind::relation ? f.args : std::vector<Formula>{f};
    for (std::size_t side = 0; side < sides.size(); ++side) {
      if (side > 0 && reading::is_zero(sides[side])) {  // "= 0" stays on the last line
        all.back() += between(f) + (*this)(sides[side]).text;
      } else {
        add(broken_terms(sides[side], shortener), side > 0 ? between(f) : "", PieceStart::side);
      }
    }
    for (std::size_t i = 0; i < shortener.definitions().size(); ++i) {
      all.back() += ",";
      const Formula meaning = shortener.definitions()[i];
      add(broken_terms(meaning, shortener), (*this)(Shortener::abbreviation(i)).text + style_.equals(),
          PieceStart::abbreviation);
    }
    return style_.lay_out(all, starts);
  }

 private:
  std::string at_least(const Formula& f, Piece::Precedence precedence) const {
    const Piece piece = (*this)(f);
    return piece.precedence < precedence ? style_.bracket(piece.text) : piece.text;
  }
  Piece number(const Formula& f) const {
    if (!f.word.empty()) return style_.literal(f.word);
    if (const auto decimal = as_decimal(f.number)) return style_.literal(*decimal);
    return style_.number(f.number);
  }
  Piece symbol(const reading::Symbol& of) const {
    if (of.kind == symbolic::SymbolKind::integral) {
      if (const auto integrand = notation_.integrand(of.index)) return style_.integral((*this)(*integrand));
    }
    return style_.symbol(notation_(of));
  }
  /// The arguments of a call. Those of trigonometric functions are angles, in degrees where these are shorter.
  std::vector<Piece> arguments(const Formula& call) const {
    using symbolic::Op;
    if (call.op == Op::sin || call.op == Op::cos || call.op == Op::tan) return {angle(call.args[0])};
    return pieces(call.args);
  }
  /// An angle, or a sum of some, such as the bracket of a torsion spring.
  Piece angle(const Formula& f) const {
    if (const auto degrees = as_degrees(f)) return style_.degrees(*degrees);
    if (f.kind != FormulaKind::sum && f.kind != FormulaKind::negative) return (*this)(f);
    std::vector<std::string> terms;
    add_signed(f, [&](const Formula& term, bool minus) {
      const auto degrees = as_degrees(term);
      terms.push_back(sign(minus, terms.empty()) +
                      (degrees ? style_.degrees(*degrees).text : at_least(term, Piece::product)));
    });
    return {joined(terms), Piece::sum};
  }
  std::vector<Piece> pieces(const std::vector<Formula>& list) const {
    return mapped(list, [&](const Formula& f) { return (*this)(f); });
  }
  std::vector<std::string> texts(const std::vector<Formula>& list) const {
    return mapped(list, [&](const Formula& f) { return (*this)(f).text; });
  }
  std::string listed(const std::vector<Formula>& list, const std::string& separator) const {
    std::string result;
    for (std::size_t i = 0; i < list.size(); ++i) result += (i > 0 ? separator : "") + (*this)(list[i]).text;
    return result;
  }
  Piece power(const Formula& f) const {
    const Formula& base = f.args[0];
    const std::string exponent = (*this)(f.args[1]).text;
    const bool whole = f.args[1].kind == FormulaKind::number && reading::is_integer(f.args[1].number);
    if (base.kind == FormulaKind::call && whole && symbolic::function_of(base.op).raised)
      return style_.call_power(base.op, arguments(base), exponent);
    Piece piece = (*this)(base);
    if (piece.precedence < Piece::atom) piece = {style_.bracket(piece.text), Piece::atom};
    return style_.power(piece, exponent);
  }
  Piece product(const Formula& f) const {
    std::vector<Piece> factors;
    std::size_t first = 0;
    const bool of_pi = f.args.size() > 2 && f.args[0].kind == FormulaKind::number && f.args[1].kind == FormulaKind::pi;
    if (const auto degrees = of_pi ? as_degrees(f.args[0].number) : std::nullopt) {  // 48.85 deg times the rest
      factors.push_back({style_.degrees(*degrees).text, Piece::atom});
      first = 2;
    }
    for (std::size_t i = first; i < f.args.size(); ++i) {
      Piece piece = (*this)(f.args[i]);
      if (piece.precedence < Piece::product) piece = {style_.bracket(piece.text), Piece::atom};
      factors.push_back(std::move(piece));
    }
    return style_.product(factors);
  }
  static void add_signed(const Formula& sum, const std::function<void(const Formula&, bool)>& add) {
    for (const Formula& term : sum.kind == FormulaKind::sum ? sum.args : std::vector<Formula>{sum}) {
      const bool minus = term.kind == FormulaKind::negative;
      add(minus ? term.args[0] : term, minus);
    }
  }
  std::string sign(bool minus, bool leads) const {
    return leads ? minus ? style_.leading_minus() : "" : minus ? style_.minus() : style_.plus();
  }
  std::vector<std::string> signed_terms(const Formula& f) const {
    std::vector<std::string> result;
    add_signed(f, [&](const Formula& term, bool minus) {
      result.push_back(sign(minus, result.empty()) + at_least(term, Piece::product));
    });
    return result;
  }
  /// Pieces between which a line may break: terms, and the terms of a bracket that is too long for a line.
  std::vector<std::string> line_pieces(const Formula& f, Shortener& shortener, bool leads = true) const {
    std::vector<std::string> result;
    add_signed(f, [&](const Formula& term, bool minus) {
      std::vector<std::string> pieces =
          shortener.fits(term) ? std::vector<std::string>{} : bracket_pieces(term, shortener);
      if (pieces.empty()) pieces = {at_least(shortener(term), Piece::product)};
      pieces.front() = sign(minus, leads && result.empty()) + pieces.front();
      result.insert(result.end(), pieces.begin(), pieces.end());
    });
    return result;
  }
  /// Pieces of a product with one sum as a factor, broken within the sum; empty for other terms.
  std::vector<std::string> bracket_pieces(const Formula& term, Shortener& shortener) const {
    const auto is_sum = [](const Formula& f) { return f.kind == FormulaKind::sum; };
    if (term.kind != FormulaKind::product || std::count_if(term.args.begin(), term.args.end(), is_sum) != 1) return {};
    const auto at =
        static_cast<std::size_t>(std::find_if(term.args.begin(), term.args.end(), is_sum) - term.args.begin());
    const std::string place = "\x1a";  // no printed text has this character
    std::vector<Piece> factors = pieces(term.args);
    for (Piece& factor : factors) {
      if (factor.precedence < Piece::product) factor = {style_.bracket(factor.text), Piece::atom};
    }
    factors[at] = {place, Piece::atom};
    const std::string around = style_.product(factors).text;
    std::vector<std::string> result = line_pieces(term.args[at], shortener);
    result.front() = around.substr(0, around.find(place)) + style_.open_bracket() + result.front();
    result.back() += style_.close_bracket() + around.substr(around.find(place) + place.size());
    return result;
  }
  static std::string joined(const std::vector<std::string>& terms) {
    std::string result;
    for (const std::string& term : terms) result += term;
    return result;
  }
  // d/dt of a long sum may break inside.
  std::vector<std::string> broken_terms(const Formula& side, Shortener& shortener) const {
    if (side.kind == FormulaKind::relation || side.kind == FormulaKind::list) return {(*this)(side).text};
    const Formula& first = side.kind == FormulaKind::sum ? side.args[0] : side;
    if (first.kind != FormulaKind::rate || first.args[0].kind != FormulaKind::sum || first.args[0].args.size() < 2) {
      return line_pieces(side, shortener);
    }
    std::vector<std::string> result = line_pieces(first.args[0], shortener);
    result.front() = style_.open_time_derivative() + result.front();
    result.back() += style_.close_time_derivative();
    if (side.kind != FormulaKind::sum) return result;
    for (std::size_t i = 1; i < side.args.size(); ++i) {
      for (std::string& piece : line_pieces(side.args[i], shortener, false)) result.push_back(std::move(piece));
    }
    return result;
  }

  const Style& style_;
  const Notation& notation_;
};

}  // namespace

std::string print(const Formula& formula, const Notation& notation, Format format) {
  std::unique_ptr<Style> style;
  switch (format) {
    case Format::text: style = text_style(false); break;
    case Format::model_language: style = text_style(true); break;
    case Format::latex: style = latex_style(); break;
    case Format::mathml: style = mathml_style(); break;
  }
  return print(formula, notation, *style);
}

std::string print(const Formula& formula, const Notation& notation, const Style& style) {
  return FormulaPrinter(style, notation).lay_out(formula);
}

}  // namespace eomgen::print
