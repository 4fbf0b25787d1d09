// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "model/letters.hpp"

namespace eomgen::model {
namespace {

constexpr std::size_t many = 64;
// Names and numbers of arguments are those of symbolic/functions.hpp. This stage, and the oracle, which reads Fn, do
// not depend on that file; tests/mechanics compares the two. min and max take more than two arguments here, as nested
// calls.
constexpr std::array<FunctionSignature, 17> scalar_functions{{
    {"sin", Fn::sin, 1, 1},
    {"cos", Fn::cos, 1, 1},
    {"tan", Fn::tan, 1, 1},
    {"asin", Fn::asin, 1, 1},
    {"acos", Fn::acos, 1, 1},
    {"atan", Fn::atan, 1, 1},
    {"atan2", Fn::atan2, 2, 2},
    {"sinh", Fn::sinh, 1, 1},
    {"cosh", Fn::cosh, 1, 1},
    {"tanh", Fn::tanh, 1, 1},
    {"exp", Fn::exp, 1, 1},
    {"log", Fn::log, 1, 1},
    {"sqrt", Fn::sqrt, 1, 1},
    {"abs", Fn::abs, 1, 1},
    {"sign", Fn::sign, 1, 1},
    {"min", Fn::min, 2, many},
    {"max", Fn::max, 2, many},
}};
constexpr std::array<std::string_view, 13> other_functions{
    "if",           "ddt",   "diff", "integral", "initial", "position", "velocity",
    "acceleration", "omega", "dot",  "cross",    "norm",    "unit"};
constexpr std::array<std::string_view, 7> reserved_names{"t", "pi", "origin", "ground", "E1", "E2", "E3"};

}  // namespace

bool is_identifier(std::string_view text) {
  if (text.empty() || !letter(text.front())) return false;
  return std::all_of(text.begin(), text.end(), [](char c) { return letter(c) || digit(c) || c == '_'; });
}

bool is_reserved(std::string_view name) {
  if (std::find(reserved_names.begin(), reserved_names.end(), name) != reserved_names.end()) return true;
  const auto& functions = function_names();
  return std::find(functions.begin(), functions.end(), name) != functions.end();
}

std::optional<std::string> name_error(std::string_view name) {
  if (!is_identifier(name)) return "a name starts with a letter and has letters, digits and underscores";
  if (name.size() > max_name_length) return fmt::format("a name has at most {} characters", max_name_length);
  if (is_reserved(name)) return fmt::format("'{}' is reserved", name);
  if (split_derivative(name).order > 0) return "names that end with _dot and _ddot are time derivatives";
  return std::nullopt;
}

Derivative split_derivative(std::string_view name) {
  if (name.size() > 5 && name.ends_with("_ddot")) return {name.substr(0, name.size() - 5), 2};
  if (name.size() > 4 && name.ends_with("_dot")) return {name.substr(0, name.size() - 4), 1};
  return {name, 0};
}

std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t limit) {
  const std::size_t gap = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (gap > limit || a.size() > 2 * max_name_length || b.size() > 2 * max_name_length) return limit + 1;
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = last[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return std::min(last[b.size()], limit + 1);
}

std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& candidates) {
  // The limit grows with the length: one edit for up to four letters, then two, then three.
  const std::size_t limit = name.size() <= 4 ? 1 : name.size() <= 8 ? 2 : 3;
  std::optional<std::string> best;
  std::size_t best_distance = limit + 1;
  const auto lowered = [](std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return result;
  };
  for (const std::string& candidate : candidates) {
    if (candidate == name) continue;
    if (candidate.size() == name.size() && lowered(candidate) == lowered(name)) return candidate;
    if (name.size() == 1 && candidate.size() == 1) continue;
    const std::size_t distance = edit_distance(name, candidate, limit);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates) {
  const auto meant = nearest(name, candidates);
  return meant ? fmt::format("did you mean '{}'?", *meant) : std::string();
}

std::string suggest_choice(const std::string& name, const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  const std::string all = fmt::format("choose from: {}", fmt::join(known, ", "));
  return hint.empty() ? all : hint + " " + all;
}

bool looks_misspelt(std::string_view name, std::string_view known) {
  if (std::min(name.size(), known.size()) < 2 || std::max(name.size(), known.size()) < 3) return false;
  const std::size_t shortest = std::min(name.size(), known.size());
  const bool after_underscore = name.size() > 2 && name[name.size() - 2] == '_';
  // Compare the parts between the common prefix and the common suffix.
  while (!name.empty() && !known.empty() && name.front() == known.front()) {
    name.remove_prefix(1);
    known.remove_prefix(1);
  }
  while (!name.empty() && !known.empty() && name.back() == known.back()) {
    name.remove_suffix(1);
    known.remove_suffix(1);
  }
  const bool transposed = name.size() == 2 && known.size() == 2 && name[0] == known[1] && name[1] == known[0];
  if (transposed) return !(digit(name[0]) && digit(name[1]));  // x12 and x21
  if (name.size() > 1 || known.size() > 1) return false;
  // Different numbers are different names, and so are phi and psi, thetaA and thetaB, x_cart and y_cart, phi_a and
  // phi_b.
  if ((!name.empty() && digit(name[0])) || (!known.empty() && digit(known[0]))) return false;
  if (name.size() != known.size()) return true;
  const auto upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto axis = [](char c) { return c >= 'u' && c <= 'z'; };
  const bool labels = (upper(name[0]) && upper(known[0])) || (axis(name[0]) && axis(known[0])) || after_underscore;
  return shortest >= 4 && !labels;
}

std::string quote(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (std::size_t k = 0; k < text.size() && k < longest; ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    result += c < 0x20 || c == 0x7f ? ' ' : text[k];
  }
  if (text.size() > longest) {
    // Not in the middle of a UTF-8 sequence.
    while (!result.empty() && (static_cast<unsigned char>(result.back()) & 0xc0u) == 0x80u) result.pop_back();
    if (!result.empty() && static_cast<unsigned char>(result.back()) >= 0xc0u) result.pop_back();
    result += "...";
  }
  return result + "'";
}

const FunctionSignature* find_function(std::string_view name) {
  for (const FunctionSignature& function : scalar_functions) {
    if (function.name == name) return &function;
  }
  return nullptr;
}

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const FunctionSignature& function : scalar_functions) result.emplace_back(function.name);
    for (std::string_view name : other_functions) result.emplace_back(name);
    return result;
  }();
  return names;
}

}  // namespace eomgen::model
