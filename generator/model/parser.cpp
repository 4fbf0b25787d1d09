// SPDX-License-Identifier: GPL-3.0-or-later
// A precedence-climbing parser: sums of products of signed powers of atoms.
#include <fmt/format.h>

#include <algorithm>

#include "model/names.hpp"
#include "model/syntax.hpp"
#include "model/units.hpp"

namespace eomgen::model {
namespace {

struct Term {
  bool inverse = false;  // subtracted, or a divisor
  std::uint32_t node = 0;
  Span span;  // of the operator
};

class Parser {
 public:
  explicit Parser(const SourceText& text) : text_(text), tokens_(tokenize(text)) {}

  /// comparison: whether it may be one, as an argument of a call may.
  Syntax all(bool comparison = false) {
    if (now().kind == TokenKind::end)
      fail(now(), "an expression is missing", "write a number, a name or an expression");
    syntax_.root = comparison ? argument() : sum();
    if (now().kind != TokenKind::end) unexpected();
    const Token& last = tokens_[tokens_.size() - 2];
    syntax_.whole = text_.span(tokens_[0].at, last.at + last.length - tokens_[0].at);
    return std::move(syntax_);
  }

 private:
  const Token& now() const { return tokens_[at_]; }
  bool is(std::string_view symbol) const { return now().kind == TokenKind::symbol && now().text == symbol; }
  bool take(std::string_view symbol) {
    if (!is(symbol)) return false;
    ++at_;
    return true;
  }
  Span span(const Token& token) const { return text_.span(token.at, token.length); }

  [[noreturn]] void fail(const Token& token, const std::string& what, const std::string& remedy) const {
    text_.source->fail(span(token), what, remedy);
  }

  [[noreturn]] void unexpected() const {
    const Token& token = now();
    if (token.kind == TokenKind::end) fail(token, "the expression ends too early", "something is missing at its end");
    const bool operand_before = at_ > 0 && (tokens_[at_ - 1].kind != TokenKind::symbol || tokens_[at_ - 1].text == ")");
    if (operand_before && (token.kind != TokenKind::symbol || token.text == "(")) {
      const bool inside = at_ + 1 < tokens_.size() && (tokens_[at_ + 1].text == ")" || tokens_[at_ + 1].text == ",");
      if (inside && tokens_[at_ - 1].kind == TokenKind::number && token.kind == TokenKind::name &&
          parse_unit(token.text)) {
        fail(token, fmt::format("an operator is missing before {}", quote(token.text)),
             fmt::format("inside of an expression a unit stands in brackets: {}[{}]", tokens_[at_ - 1].text,
                         token.text));
      }
      fail(token, fmt::format("an operator is missing before {}", quote(token.text)),
           "there is no implicit multiplication: write a*b; a unit stands last, without blanks in it, as in \"9.81 "
           "m/s^2\"");
    }
    if (token.text == "," && at_ > 0 && at_ + 1 < tokens_.size() && tokens_[at_ - 1].kind == TokenKind::number &&
        tokens_[at_ + 1].kind == TokenKind::number) {
      fail(token, "a comma is no decimal point",
           fmt::format("write {}.{}", tokens_[at_ - 1].text, tokens_[at_ + 1].text));
    }
    if (token.text.starts_with('<') || token.text.starts_with('>'))
      fail(token, fmt::format("{} does not fit here", quote(token.text)),
           "a condition stands in if(a > b, x, y); what is to become 0, as at an event, is a difference: a - b");
    fail(token, fmt::format("{} does not fit here", quote(token.text)),
         token.text == ")" ? "there is no open parenthesis for it" : "check the expression up to this place");
  }

  std::uint32_t add(SyntaxKind kind, Span place, std::vector<std::uint32_t> children) {
    SyntaxNode node;
    node.kind = kind;
    node.span = place;
    node.children = std::move(children);
    syntax_.nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(syntax_.nodes.size() - 1);
  }

  std::uint32_t sum() {
    std::vector<Term> terms{{false, product(), {}}};
    while (is("+") || is("-")) {
      const Token& token = tokens_[at_++];
      terms.push_back({token.text == "-", product(), span(token)});
    }
    return combine(terms, SyntaxKind::add);
  }

  std::uint32_t product() {
    std::vector<Term> terms{{false, signed_power(), {}}};
    while (is("*") || is("/")) {
      const Token& token = tokens_[at_++];
      terms.push_back({token.text == "/", signed_power(), span(token)});
    }
    return combine(terms, SyntaxKind::multiply);
  }

  // Left to right. Long sums and products become balanced trees of runs, which limits the depth of recursion.
  std::uint32_t combine(std::vector<Term> terms, SyntaxKind kind) {
    constexpr std::size_t run = 16;
    const bool sum = kind == SyntaxKind::add;
    const SyntaxKind inverse = sum ? SyntaxKind::subtract : SyntaxKind::divide;
    while (true) {
      std::vector<Term> runs;
      for (std::size_t begin = 0; begin < terms.size(); begin += run) {
        Term result = terms[begin];
        if (result.inverse && begin > 0) {  // a run that starts with -x or /x
          result.node = sum ? add(SyntaxKind::negate, result.span, {result.node})
                            : add(SyntaxKind::divide, result.span, {one(result.span), result.node});
          result.inverse = false;
        }
        for (std::size_t k = begin + 1; k < std::min(begin + run, terms.size()); ++k) {
          result.node = add(terms[k].inverse ? inverse : kind, terms[k].span, {result.node, terms[k].node});
        }
        runs.push_back(result);
      }
      if (runs.size() == 1) return runs[0].node;
      terms = std::move(runs);
    }
  }

  std::uint32_t one(Span place) {
    const std::uint32_t id = add(SyntaxKind::number, place, {});
    syntax_.nodes[id].value = 1;
    return id;
  }

  std::uint32_t signed_power() {
    if (++depth_ > max_nesting) {
      fail(now(), fmt::format("the expression is nested more than {} deep", max_nesting),
           "split it with [definitions]");
    }
    std::uint32_t result = 0;
    const Token& token = now();
    if (take("-")) {
      result = add(SyntaxKind::negate, span(token), {signed_power()});
    } else if (take("+")) {
      result = signed_power();
    } else {
      result = power();
    }
    --depth_;
    return result;
  }

  std::uint32_t power() {
    const std::uint32_t base = atom();
    const Token& token = now();
    if (token.kind == TokenKind::symbol && token.text == "*" && tokens_[at_ + 1].text == "*") {
      fail(token, "'**' is no operator", "write a^b for a power");
    }
    if (!take("^")) return base;
    return add(SyntaxKind::power, span(token), {base, signed_power()});
  }

  std::uint32_t atom() {
    const Token& token = now();
    if (token.kind == TokenKind::number) {
      ++at_;
      const std::uint32_t id = add(SyntaxKind::number, span(token), {});
      syntax_.nodes[id].value = token.value;
      syntax_.nodes[id].unit = token.unit;
      return id;
    }
    if (token.kind == TokenKind::name) {
      return tokens_[at_ + 1].kind == TokenKind::symbol && tokens_[at_ + 1].text == "(" ? call() : name();
    }
    if (!take("(")) unexpected();
    const std::uint32_t inside = sum();
    if (!take(")")) {
      if (now().kind == TokenKind::end) fail(token, "this parenthesis is not closed", "add the missing ')'");
      unexpected();
    }
    return inside;
  }

  std::uint32_t name() {
    const Token& first = tokens_[at_++];
    std::vector<std::string> parts{std::string(first.text)};
    std::size_t primes = 0;
    while (take(".")) {
      if (now().kind == TokenKind::number && parts.size() == 2 && parts[0] == "reaction") {  // reaction.NAME.1
        parts.emplace_back(text_.text.substr(now().at, now().length));
        ++at_;
        continue;
      }
      if (now().kind != TokenKind::name)
        fail(now(), "a name is missing after '.'", "write NAME.part, such as P.e_theta");
      parts.emplace_back(tokens_[at_++].text);
    }
    while (take("'")) ++primes;
    const Token& last = tokens_[at_ - 1];
    const std::uint32_t id = add(SyntaxKind::name, text_.span(first.at, last.at + last.length - first.at), {});
    syntax_.nodes[id].parts = std::move(parts);
    syntax_.nodes[id].primes = primes;
    return id;
  }

  std::uint32_t call() {
    const Token& function = tokens_[at_];
    at_ += 2;
    std::vector<std::uint32_t> arguments;
    if (!take(")")) {
      arguments.push_back(argument());
      while (take(",")) arguments.push_back(argument());
      if (!take(")")) {
        if (now().kind == TokenKind::end) fail(function, "this call is not closed", "add the missing ')'");
        unexpected();
      }
    }
    const std::uint32_t id = add(SyntaxKind::call, span(function), std::move(arguments));
    syntax_.nodes[id].parts = {std::string(function.text)};
    return id;
  }

  // An argument of if() may be a comparison; elsewhere the resolver rejects one.
  std::uint32_t argument() {
    const std::uint32_t left = sum();
    const Token& token = now();
    SyntaxKind kind = SyntaxKind::less;
    if (is("<=")) kind = SyntaxKind::less_equal;
    if (is(">")) kind = SyntaxKind::greater;
    if (is(">=")) kind = SyntaxKind::greater_equal;
    if (kind == SyntaxKind::less && !is("<")) return left;
    ++at_;
    return add(kind, span(token), {left, sum()});
  }

  const SourceText& text_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Syntax syntax_;
};

bool ends_an_operand(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == ')' || c == ']' || c == '_' || c == '\'';
}

}  // namespace

Syntax parse_expression(const SourceText& text) { return Parser(text).all(); }

Syntax parse_comparison(const SourceText& text) { return Parser(text).all(true); }

namespace {

// The last word of a text after an operand: "m/s^2" of "9.81 m/s^2", nothing of "a + b".
struct LastWord {
  std::string_view before, word;
};
std::optional<LastWord> last_word(std::string_view all) {
  constexpr std::string_view blanks = " \t\r\n";
  while (!all.empty() && blanks.find(all.back()) != std::string_view::npos) all.remove_suffix(1);
  const std::size_t blank = all.find_last_of(blanks);
  const std::size_t end = blank == std::string_view::npos ? blank : all.find_last_not_of(blanks, blank);
  if (end == std::string_view::npos || !ends_an_operand(all[end])) return std::nullopt;
  return LastWord{all.substr(0, end + 1), all.substr(blank + 1)};
}

}  // namespace

std::optional<MeasuredUnit> trailing_unit(std::string_view text) {
  const auto last = last_word(text);
  return last ? parse_unit(last->word) : std::nullopt;
}

std::string bracket_unit(std::string_view text) {
  const auto last = last_word(text);
  if (!last || !parse_unit(last->word)) return std::string(text);
  return fmt::format("({})*1[{}]", last->before, last->word);
}

Syntax parse_quantity(const SourceText& text) {
  const auto last = last_word(text.text);
  if (!last) return parse_expression(text);
  const auto at = static_cast<std::size_t>(last->word.data() - text.text.data());
  auto unit = parse_unit(last->word);
  if (!unit) {
    // "2 fm/s": the message calls it a unit, as it cannot be anything else.
    const bool unit_like =
        suggest_unit(last->word).has_value() || (std::isalpha(static_cast<unsigned char>(last->word[0])) != 0 &&
                                                 last->word.find_first_of("(),+-<>.") == std::string_view::npos);
    if (unit_like) {
      const std::string hint = unit_hint(last->word);
      const bool is_name =
          last->word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") ==
          std::string_view::npos;
      text.source->fail(text.span(at, last->word.size()), fmt::format("{} is not a unit", quote(last->word)),
                        hint.empty() ? "write a unit such as m/s^2, N*m, rad/s, or an operator before the name"
                        : is_name    ? fmt::format("{}; a product is written with an operator: 2*{}", hint, last->word)
                                     : hint);
    }
    return parse_expression(text);
  }
  SourceText value = text;
  value.text = last->before;
  Syntax syntax = parse_expression(value);
  syntax.unit = std::move(unit);
  syntax.unit_span = text.span(at, last->word.size());
  return syntax;
}

}  // namespace eomgen::model
