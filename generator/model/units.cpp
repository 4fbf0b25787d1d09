// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/units.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <vector>

#include "model/names.hpp"

namespace eomgen::model {
namespace {

using Powers = std::array<int, 7>;  // m kg s A K mol cd

struct NamedUnit {
  std::string_view name;
  Powers powers;
  std::int64_t numerator, denominator;
  int pi_power;
  bool prefixes;
};

constexpr std::array<NamedUnit, 37> units{{
    {"1", {}, 1, 1, 0, false},
    {"m", {1}, 1, 1, 0, true},
    {"g", {0, 1}, 1, 1000, 0, true},
    {"s", {0, 0, 1}, 1, 1, 0, true},
    {"A", {0, 0, 0, 1}, 1, 1, 0, true},
    {"K", {0, 0, 0, 0, 1}, 1, 1, 0, true},
    {"mol", {0, 0, 0, 0, 0, 1}, 1, 1, 0, true},
    {"cd", {0, 0, 0, 0, 0, 0, 1}, 1, 1, 0, false},
    {"rad", {}, 1, 1, 0, true},
    {"sr", {}, 1, 1, 0, false},
    {"deg", {}, 1, 180, 1, false},
    {"arcmin", {}, 1, 10800, 1, false},
    {"arcsec", {}, 1, 648000, 1, false},
    {"rev", {}, 2, 1, 1, false},
    {"rpm", {0, 0, -1}, 1, 30, 1, false},
    {"percent", {}, 1, 100, 0, false},
    {"Hz", {0, 0, -1}, 1, 1, 0, true},
    {"N", {1, 1, -2}, 1, 1, 0, true},
    {"Pa", {-1, 1, -2}, 1, 1, 0, true},
    {"J", {2, 1, -2}, 1, 1, 0, true},
    {"W", {2, 1, -3}, 1, 1, 0, true},
    {"C", {0, 0, 1, 1}, 1, 1, 0, true},
    {"V", {2, 1, -3, -1}, 1, 1, 0, true},
    {"F", {-2, -1, 4, 2}, 1, 1, 0, true},
    {"Ohm", {2, 1, -3, -2}, 1, 1, 0, true},
    {"S", {-2, -1, 3, 2}, 1, 1, 0, true},
    {"Wb", {2, 1, -2, -1}, 1, 1, 0, true},
    {"T", {0, 1, -2, -1}, 1, 1, 0, true},
    {"H", {2, 1, -2, -2}, 1, 1, 0, true},
    {"L", {3}, 1, 1000, 0, true},
    {"bar", {-1, 1, -2}, 100000, 1, 0, true},
    {"tonne", {0, 1}, 1000, 1, 0, false},
    {"min", {0, 0, 1}, 60, 1, 0, false},
    {"h", {0, 0, 1}, 3600, 1, 0, false},
    {"day", {0, 0, 1}, 86400, 1, 0, false},
    {"ha", {2}, 10000, 1, 0, false},
    {"au", {1}, 149597870700, 1, 0, false},
}};

struct Prefix {
  std::string_view name;
  int exponent;
};
constexpr std::array<Prefix, 20> prefixes{{{"da", 1},  {"Y", 24},  {"Z", 21},  {"E", 18},  {"P", 15},
                                           {"T", 12},  {"G", 9},   {"M", 6},   {"k", 3},   {"h", 2},
                                           {"d", -1},  {"c", -2},  {"m", -3},  {"u", -6},  {"n", -9},
                                           {"p", -12}, {"f", -15}, {"a", -18}, {"z", -21}, {"y", -24}}};

Rational ten_to(int exponent) { return cln::expt(Rational(10), cln::cl_I(exponent)); }

MeasuredUnit measured(const NamedUnit& unit, int prefix) {
  MeasuredUnit result;
  for (std::size_t k = 0; k < 7; ++k) result.dimension.exponents[k] = unit.powers[k];
  result.scale = Rational(cln::cl_I(unit.numerator)) / cln::cl_I(unit.denominator) * ten_to(prefix);
  result.pi_power = unit.pi_power;
  return result;
}

std::optional<MeasuredUnit> single_unit(std::string_view name) {
  for (const NamedUnit& unit : units) {
    if (unit.name == name) return measured(unit, 0);
  }
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.name)) continue;
    for (const NamedUnit& unit : units) {
      if (unit.prefixes && unit.name == name.substr(prefix.name.size())) return measured(unit, prefix.exponent);
    }
  }
  return std::nullopt;
}

// unit = factor { ("*"|"/") factor }, factor = (name | "(" unit ")") [ "^" ( ["-"|"+"] digit | "(" ["-"] digit "/"
// digit ")" ) ]
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  std::optional<MeasuredUnit> all() {
    auto result = unit(0);
    if (!result || at_ != text_.size()) return std::nullopt;
    result->text = std::string(text_);
    return result;
  }

 private:
  std::optional<MeasuredUnit> unit(int depth) {
    auto result = factor(depth);
    while (result && at_ < text_.size() && (text_[at_] == '*' || text_[at_] == '/')) {
      const bool over = text_[at_++] == '/';
      const auto next = factor(depth);
      if (!next) return std::nullopt;
      result->dimension =
          over ? quotient(result->dimension, next->dimension) : product(result->dimension, next->dimension);
      result->scale = over ? result->scale / next->scale : result->scale * next->scale;
      result->pi_power += over ? -next->pi_power : next->pi_power;
    }
    return result;
  }

  std::optional<MeasuredUnit> factor(int depth) {
    std::optional<MeasuredUnit> result;
    if (at_ < text_.size() && text_[at_] == '(') {
      ++at_;
      result = depth < 4 ? unit(depth + 1) : std::nullopt;
      if (!result || at_ >= text_.size() || text_[at_++] != ')') return std::nullopt;
    } else {
      const std::size_t begin = at_;
      while (at_ < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[at_])) != 0)) ++at_;
      if (at_ == begin && at_ < text_.size() && text_[at_] == '1') ++at_;
      result = single_unit(text_.substr(begin, at_ - begin));
    }
    if (!result || at_ >= text_.size() || text_[at_] != '^') return result;
    ++at_;
    const bool negative = at_ < text_.size() && text_[at_] == '-';
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) ++at_;
    if (!negative && at_ < text_.size() && text_[at_] == '(') return fraction(*result);
    if (!is_digit()) return std::nullopt;
    const int exponent = (negative ? -1 : 1) * (text_[at_++] - '0');  // one digit suffices
    result->dimension = raised(result->dimension, exponent);
    result->scale = cln::expt(result->scale, cln::cl_I(exponent));
    result->pi_power *= exponent;
    return result;
  }

  // m^(1/2), as in dimensions; only for units without a factor, because the root of a factor would not be exact.
  std::optional<MeasuredUnit> fraction(MeasuredUnit unit) {
    ++at_;
    const bool negative = at_ < text_.size() && text_[at_] == '-';
    if (negative) ++at_;
    if (!is_digit()) return std::nullopt;
    const Rational above = text_[at_++] - '0';
    if (at_ >= text_.size() || text_[at_++] != '/' || !is_digit()) return std::nullopt;
    const Rational below = text_[at_++] - '0';
    if (at_ >= text_.size() || text_[at_++] != ')' || unit.scale != 1 || unit.pi_power != 0) return std::nullopt;
    unit.dimension = raised(unit.dimension, negative ? -above / below : above / below);
    return unit;
  }

  bool is_digit() const { return at_ < text_.size() && text_[at_] >= '1' && text_[at_] <= '9'; }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<MeasuredUnit> parse_unit(std::string_view text) {
  constexpr std::size_t longest = 64;  // also limits the factor
  if (text.empty() || text.size() > longest) return std::nullopt;
  return UnitParser(text).all();
}

std::optional<std::string> suggest_unit(std::string_view text) {
  std::string result;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool after_letter = k > 0 && std::isalpha(static_cast<unsigned char>(text[k - 1])) != 0;
    const bool raised_sign =
        text[k] == '-' && k + 1 < text.size() && std::isdigit(static_cast<unsigned char>(text[k + 1])) != 0;
    if (after_letter && (std::isdigit(static_cast<unsigned char>(text[k])) != 0 || raised_sign)) result += '^';
    if (text.substr(k).starts_with("**")) {
      result += '^';
      ++k;
    } else if (text.substr(k).starts_with("\xc2\xb2") ||
               text.substr(k).starts_with("\xc2\xb3")) {  // superscript 2 and 3
      result += text[++k] == '\xb2' ? "^2" : "^3";
    } else if (text.substr(k).starts_with("\xc2\xb7")) {  // a dot in the middle
      result += '*';
      ++k;
    } else {
      result += text[k] == '.' && after_letter ? '*' : text[k];
    }
  }
  return result != text && parse_unit(result) ? std::optional(result) : std::nullopt;
}

std::string unit_hint(std::string_view text) {
  if (const auto meant = suggest_unit(text)) return "did you mean '" + *meant + "'?";
  std::vector<std::string> names;
  for (const NamedUnit& unit : units) names.emplace_back(unit.name);
  for (const char* common : {"kg", "mm", "cm", "km", "ms", "kN", "N*m", "m/s", "m/s^2", "rad/s", "N/m", "N*s/m"}) {
    names.emplace_back(common);
  }
  return did_you_mean(text, names);
}

bool same(const Dimension& a, const Dimension& b) {
  for (std::size_t k = 0; k < 7; ++k) {
    if (a.exponents[k] != b.exponents[k]) return false;
  }
  return true;
}

bool is_one(const Dimension& dimension) { return same(dimension, Dimension{}); }

Dimension product(const Dimension& a, const Dimension& b) {
  Dimension result;
  for (std::size_t k = 0; k < 7; ++k) result.exponents[k] = a.exponents[k] + b.exponents[k];
  return result;
}

Dimension quotient(const Dimension& a, const Dimension& b) { return product(a, raised(b, -1)); }

Dimension raised(const Dimension& a, const Rational& exponent) {
  Dimension result;
  for (std::size_t k = 0; k < 7; ++k) result.exponents[k] = a.exponents[k] * exponent;
  return result;
}

Dimension dimension_of(std::string_view unit) {
  const auto parsed = parse_unit(unit);
  return parsed ? parsed->dimension : Dimension{};
}

}  // namespace eomgen::model
