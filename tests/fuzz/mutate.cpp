// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutate.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <regex>

namespace eomgen::fuzz {
namespace {

enum class Kind { number, name, function, sign };
struct Token {
  Kind kind;
  bool quoted;
  std::size_t at, size;
};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; }

std::size_t below(std::size_t count, Random& random) { return count == 0 ? 0 : random() % count; }
template <typename List>
const auto& any(const List& list, Random& random) {
  return list[below(list.size(), random)];
}

/// Whether the strings of a line are not expressions.
bool is_plain_text(const std::string& text, std::size_t line) {
  static constexpr std::array keys{"format", "title", "note",   "name",    "unit", "tex",
                                   "type",   "from",  "solver", "outputs", "#",    "["};
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string_view key) { return text.compare(line, key.size(), key) == 0; });
}

/// The tokens of expressions and values, to the right of '='.
std::vector<Token> tokens(const std::string& text) {
  std::vector<Token> result;
  bool value = false, quoted = false;
  for (std::size_t i = 0; i < text.size();) {
    if (i == 0 || text[i - 1] == '\n') {
      value = quoted = false;
      if (is_plain_text(text, i)) {
        i = std::min(text.find('\n', i), text.size() - 1) + 1;
        continue;
      }
    }
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (c == '#' && !quoted) {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '=' && !quoted) value = true;
    std::size_t end = i + 1;
    if (value && (is_digit(c) || (quoted && is_word(c)))) {
      const auto exponent = [&](std::size_t at) {
        return is_digit(c) && text[at - 1] == 'e' && (text[at] == '-' || text[at] == '+');
      };
      while (end < text.size() && (is_word(text[end]) || exponent(end))) ++end;
      const bool called = end < text.size() && text[end] == '(';
      result.push_back({is_digit(c) ? Kind::number : called ? Kind::function : Kind::name, quoted, i, end - i});
    } else if (quoted && std::string_view("+-*/^").find(c) != std::string_view::npos) {
      result.push_back({Kind::sign, quoted, i, 1});
    }
    i = end;
  }
  return result;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    result.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return result;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string result;
  for (const std::string& line : lines) result += line + "\n";
  return result;
}

std::string key_of(const std::string& line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos || line[0] == '#') return "";
  return line.substr(0, line.find_last_not_of(" \t", equals - 1) + 1);
}

/// The lines of a random section, from its header to the next.
std::vector<std::string> section(const std::string& text, Random& random) {
  const std::vector<std::string> all = lines(text);
  std::vector<std::size_t> heads;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].empty() && all[i][0] == '[') heads.push_back(i);
  }
  if (heads.empty()) return {};
  const std::size_t begin = any(heads, random);
  std::size_t end = begin + 1;
  while (end < all.size() && (all[end].empty() || all[end][0] != '[')) ++end;
  return {all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end)};
}

std::string exchanged(const std::string& text, const Token& token, const std::string& by) {
  const std::string put = token.quoted ? by : '"' + by + '"';
  return text.substr(0, token.at) + put + text.substr(token.at + token.size);
}

std::string other_token(const std::string& text, const std::string& source, Random& random) {
  const std::vector<Token> all = tokens(text), others = tokens(source);
  if (all.empty() || others.empty()) return text;
  const Token& token = any(all, random);
  for (int tries = 0; tries < 20; ++tries) {
    const Token& other = any(others, random);
    if (other.kind == token.kind) return exchanged(text, token, source.substr(other.at, other.size));
  }
  return text;
}

std::string extreme_number(const std::string& text, Random& random) {
  static constexpr std::array numbers{"0",  "1",  "2",    "3",  "0.5",  "-1",  "0.1",  "0.3", "1/3",  "7",
                                      "64", "pi", "-0.5", "10", "1e-3", "1e4", "1e-9", "1e9", "1e300"};
  std::vector<Token> all = tokens(text);
  std::erase_if(all, [](const Token& token) { return token.kind != Kind::number; });
  return all.empty() ? text : exchanged(text, any(all, random), any(numbers, random));
}

std::string wrapped(const std::string& text, Random& random) {
  static constexpr std::array forms{"sin(@)",       "cos(@)",    "abs(@)",      "sqrt(@)",         "exp(@)",
                                    "(@)^2",        "(@)^-1",    "(@ - @)",     "(@ + t)",         "0*@",
                                    "(-@)",         "max(@, 0)", "tanh(@)",     "if(@ < 0, 1, @)", "atan2(@, 1)",
                                    "(@)^(1/2)",    "ddt(@)",    "sign(@)",     "log(@)",          "@*@",
                                    "norm(@)",      "unit(@)",   "velocity(@)", "dot(@, E1)",      "integral(@)",
                                    "cross(@, E3)", "(1 + @^2)", "asin(@)",     "min(@, t)",       "diff(@, t)"};
  std::vector<Token> all = tokens(text);
  std::erase_if(all, [](const Token& token) { return token.kind == Kind::sign || token.kind == Kind::function; });
  if (all.empty()) return text;
  const Token token = any(all, random);
  const std::string inner = text.substr(token.at, token.size);
  std::string form = any(forms, random);
  for (std::size_t at = form.find('@'); at != std::string::npos; at = form.find('@', at + inner.size()))
    form.replace(at, 1, inner);
  return exchanged(text, token, form);
}

/// A value of the same key, from a donor that has this key.
std::string other_value(const std::string& text, const std::string& source, Random& random) {
  std::vector<std::string> own = lines(text);
  const std::vector<std::string> others = lines(source);
  for (int tries = 0; tries < 40 && !own.empty() && !others.empty(); ++tries) {
    std::string& line = own[below(own.size(), random)];
    const std::string& other = any(others, random);
    if (key_of(line).empty() || key_of(line) != key_of(other)) continue;
    line = other;
    return joined(own);
  }
  return text;
}

bool is_header(const std::string& line) { return !line.empty() && line[0] == '['; }
std::string header(const std::string& line) { return line.substr(0, line.find_last_of(']') + 1); }

std::string with_section(const std::string& text, const std::string& source, Random& random) {
  std::vector<std::string> added = section(source, random), own = lines(text);
  if (added.empty()) return text;
  const auto same = std::find_if(own.begin(), own.end(), [&](const std::string& line) {
    return is_header(line) && header(line) == header(added[0]);
  });
  // A section that may occur only once is extended by keys that it does not have yet.
  if (!added[0].starts_with("[[") && same != own.end()) {
    const auto end = std::find_if(same + 1, own.end(), is_header);
    std::erase_if(added, [&](const std::string& line) {
      return std::any_of(same, end, [&](const std::string& there) { return key_of(there) == key_of(line); });
    });
    own.insert(same + 1, added.begin(), added.end());
  } else {
    own.insert(own.end(), added.begin(), added.end());
  }
  return joined(own);
}

std::string moved_line(const std::string& text, Random& random) {
  std::vector<std::string> own = lines(text);
  if (own.size() < 3) return text;
  const std::size_t from = below(own.size(), random);
  switch (below(3, random)) {
    case 0: own.erase(own.begin() + static_cast<std::ptrdiff_t>(from)); break;
    case 1: own.insert(own.begin() + static_cast<std::ptrdiff_t>(from), own[from]); break;
    default: std::swap(own[from], own[below(own.size(), random)]);
  }
  return joined(own);
}

}  // namespace

std::string without_units(const std::string& text) {
  static const std::regex value(R"re("(-?[0-9.]+(?:e-?[0-9]+)?) [A-Za-z/^*0-9()-]+")re"),
      bracket(R"re(([0-9)])\[[A-Za-z/^*0-9()-]+\])re"), key(R"re(, *unit *= *"[^"]*"|unit *= *"[^"]*" *,?)re");
  return std::regex_replace(std::regex_replace(std::regex_replace(text, value, "$1"), bracket, "$1"), key, "");
}

Mutator::Mutator(std::vector<std::string> donors) : donors_(std::move(donors)) {
  if (donors_.empty()) std::abort();
}

std::string Mutator::donor(Random& random) const {
  const std::string& text = any(donors_, random);
  return below(4, random) == 0 ? text : without_units(text);
}

std::string Mutator::changed(const std::string& text, Random& random) const {
  switch (below(16, random)) {
    case 0:
    case 1:
    case 2: return other_token(text, text, random);
    case 3: return other_token(text, donor(random), random);
    case 4:
    case 5: return extreme_number(text, random);
    case 6:
    case 7:
    case 8: return wrapped(text, random);
    case 9:
    case 10: return other_value(text, donor(random), random);
    case 11:
    case 12: return with_section(text, donor(random), random);
    case 13: return moved_line(text, random);
    case 14: return without_units(text);
    default: return with_section(text, text, random);
  }
}

std::string Mutator::operator()(std::string text, Random& random) const {
  if (text.size() < 40 || below(50, random) == 0) text = donor(random);
  for (std::size_t count = 1 + below(3, random); count > 0; --count) text = changed(text, random);
  return text;
}

}  // namespace eomgen::fuzz
