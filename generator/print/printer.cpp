// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/printer.hpp"

#include <algorithm>

namespace eomgen::print {
namespace {

using reading::Form;
using reading::Formula;
using reading::Op;

class Walk {
 public:
  Walk(const Style& style, const Notation& notation) : style_(style), notation_(notation) {}

  Piece operator()(const Formula& f) const {
    switch (f.form) {
      case Form::number: return f.word.empty() ? style_.number(f.number) : style_.literal(f.word);
      case Form::pi: return style_.pi();
      case Form::symbol: return symbol(f.symbol);
      case Form::mark: return style_.mark(f.word, texts(f.lower), texts(f.upper));
      case Form::call: return style_.call(f.op, pieces(f.args));
      case Form::power: return power(f);
      case Form::negative: return {style_.leading_minus() + at_least(f.args[0], Piece::product), Piece::sum};
      case Form::product: return product(f);
      case Form::fraction: return style_.fraction((*this)(f.args[0]), (*this)(f.args[1]));
      case Form::sum: return {joined(signed_terms(f)), Piece::sum};
      case Form::rate: return style_.rate((*this)(f.args[0]));
      case Form::partial: return style_.partial((*this)(f.args[0]), (*this)(f.args[1]));
      case Form::dot: return style_.dotted((*this)(f.args[0]), f.order);
      case Form::dot_product: return style_.dot_product({at_least(f.args[0], Piece::product)}, {at_least(f.args[1], Piece::product)});
      case Form::differential: return style_.differential((*this)(f.args[0]));
      case Form::relation: return {listed(f.args, between(f)), Piece::relation};
      case Form::list: return {listed(f.args, style_.comma()), Piece::relation};
    }
    return {};
  }

  std::string between(const Formula& relation) const {
    return relation.word == reading::at_least ? style_.at_least() : style_.equals();
  }

  /// Top-level terms of all sides of a relation, with their signs and the equals signs.
  std::string whole(const Formula& f) const {
    std::vector<std::string> all;
    std::vector<bool> starts;
    const std::vector<Formula> sides = f.form == Form::relation ? f.args : std::vector<Formula>{f};
    for (std::size_t side = 0; side < sides.size(); ++side) {
      std::vector<std::string> terms = broken_terms(sides[side]);
      if (side > 0) terms.front() = between(f) + terms.front();
      if (side > 0 && reading::is_zero(sides[side])) {  // "= 0" does not stand on a line of its own
        all.back() += terms.front();
        continue;
      }
      for (std::size_t i = 0; i < terms.size(); ++i) {
        all.push_back(std::move(terms[i]));
        starts.push_back(i == 0);
      }
    }
    return style_.whole(all, starts);
  }

 private:
  std::string at_least(const Formula& f, Piece::Binding binding) const {
    const Piece piece = (*this)(f);
    return piece.binding < binding ? style_.bracket(piece.text) : piece.text;
  }
  Piece symbol(const reading::Symbol& of) const {
    if (of.kind == symbolic::SymbolKind::integral) {
      if (const auto integrand = notation_.integrand(of.index)) return style_.integral((*this)(*integrand));
    }
    return style_.symbol(notation_(of));
  }
  std::vector<Piece> pieces(const std::vector<Formula>& list) const {
    std::vector<Piece> result;
    for (const Formula& f : list) result.push_back((*this)(f));
    return result;
  }
  std::vector<std::string> texts(const std::vector<Formula>& list) const {
    std::vector<std::string> result;
    for (const Formula& f : list) result.push_back((*this)(f).text);
    return result;
  }
  std::string listed(const std::vector<Formula>& list, const std::string& separator) const {
    std::string result;
    for (std::size_t i = 0; i < list.size(); ++i) result += (i > 0 ? separator : "") + (*this)(list[i]).text;
    return result;
  }
  Piece power(const Formula& f) const {
    const Formula& base = f.args[0];
    const std::string exponent = (*this)(f.args[1]).text;
    const bool whole = f.args[1].form == Form::number && reading::is_integer(f.args[1].number);
    if (base.form == Form::call && whole) {
      switch (base.op) {
        case Op::sin: case Op::cos: case Op::tan: case Op::sinh: case Op::cosh: case Op::tanh:
          return style_.call_power(base.op, pieces(base.args), exponent);
        default: break;
      }
    }
    Piece piece = (*this)(base);
    if (piece.binding < Piece::atom) piece = {style_.bracket(piece.text), Piece::atom};
    return style_.power(piece, exponent);
  }
  Piece product(const Formula& f) const {
    std::vector<Piece> factors;
    for (const Formula& factor : f.args) {
      Piece piece = (*this)(factor);
      if (piece.binding < Piece::product) piece = {style_.bracket(piece.text), Piece::atom};
      factors.push_back(std::move(piece));
    }
    return style_.product(factors);
  }
  std::vector<std::string> signed_terms(const Formula& f) const {
    std::vector<std::string> result;
    const std::vector<Formula> terms = f.form == Form::sum ? f.args : std::vector<Formula>{f};
    for (const Formula& term : terms) {
      const bool minus = term.form == Form::negative;
      const std::string text = at_least(minus ? term.args[0] : term, Piece::product);
      if (result.empty()) result.push_back((minus ? style_.leading_minus() : "") + text);
      else result.push_back((minus ? style_.minus() : style_.plus()) + text);
    }
    return result;
  }
  static std::string joined(const std::vector<std::string>& terms) {
    std::string result;
    for (const std::string& term : terms) result += term;
    return result;
  }
  // d/dt of a long sum may be broken inside.
  std::vector<std::string> broken_terms(const Formula& side) const {
    std::vector<std::string> result;
    const std::vector<Formula> terms = side.form == Form::sum ? side.args : std::vector<Formula>{side};
    if (terms[0].form != Form::rate || terms[0].args[0].form != Form::sum || terms[0].args[0].args.size() < 2) {
      return side.form == Form::relation || side.form == Form::list ? std::vector<std::string>{(*this)(side).text} : signed_terms(side);
    }
    result = signed_terms(terms[0].args[0]);
    result.front() = style_.open_rate() + result.front();
    result.back() += style_.close_rate();
    if (terms.size() == 1) return result;
    std::vector<std::string> rest = signed_terms(side);
    result.insert(result.end(), rest.begin() + 1, rest.end());
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
    case Format::language: style = text_style(true); break;
    case Format::latex: style = latex_style(); break;
    case Format::mathml: style = mathml_style(); break;
  }
  return print(formula, notation, *style);
}

std::string print(const Formula& formula, const Notation& notation, const Style& style) {
  return Walk(style, notation).whole(formula);
}

}  // namespace eomgen::print
