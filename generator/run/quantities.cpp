// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/quantities.hpp"

#include <cln/float.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>

#include "model/names.hpp"
#include "model/syntax.hpp"
#include "run/scene.hpp"

namespace eomgen::run {
namespace {

using symbolic::Rational;

/// pi, far beyond the digits of any run.
Rational rational_pi() { return cln::rational(cln::pi(cln::float_format(120))); }

/// The length of the decimal number at the start of a text.
std::size_t number_length(const std::string& text) {
  const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  while (digit(at) || (at < text.size() && text[at] == '.')) ++at;
  if (at == text.size() || (text[at] != 'e' && text[at] != 'E')) return at;
  std::size_t exponent = at + 1;
  if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
  if (!digit(exponent)) return at;
  while (digit(exponent)) ++exponent;
  return exponent;
}

}  // namespace

Quantity parse_quantity(const std::string& stage, const std::string& text, const std::string& shown) {
  const std::size_t length = number_length(text), unit = text.find_first_not_of(' ', length);
  Quantity result{symbolic::parse_decimal(text.substr(0, length), shown), std::nullopt};
  if (unit == std::string::npos) return result;
  const std::string written = text.substr(unit);
  result.unit = model::parse_unit(written);
  if (!result.unit) {
    std::string remedy = model::unit_hint(written);
    if (remedy.empty()) remedy = "write a unit such as 30deg or 5mm, or a number in SI units";
    throw Error(stage, {}, fmt::format("{} ends with {}, which is no unit", model::quote(shown), model::quote(written)),
                remedy);
  }
  result.value = result.value * result.unit->scale;
  for (int i = 0; i < result.unit->pi_power; ++i) result.value = result.value * rational_pi();
  for (int i = 0; i > result.unit->pi_power; --i) result.value = result.value / rational_pi();
  return result;
}

StatedUnit stated_unit(const model::Model& model, const std::string& name) {
  if (const auto start = find_start(model, name)) {
    std::optional<model::Dimension> dimension = model.coordinates[start->first].unit.dimension;
    if (dimension && start->second == 1) dimension = model::quotient(*dimension, model::dimension_of("s"));
    return {dimension, std::nullopt};
  }
  if (const auto state = find_state(model, name)) return {model.states[*state].unit.dimension, std::nullopt};
  for (const model::Input& input : model.inputs) {
    if (input.name == name) return {input.unit.dimension, std::nullopt};
  }
  const auto named = [&name](const model::Parameter& p) { return p.name == name; };
  const auto found = std::find_if(model.parameters.begin(), model.parameters.end(), named);
  if (found == model.parameters.end()) return {};
  std::optional<model::MeasuredUnit> unit = model::trailing_unit(found->written);
  if (unit && unit->scale == 1 && unit->pi_power == 0) unit.reset();
  return {found->unit.dimension, unit};
}

std::string si_unit(const model::Dimension& dimension) {
  return model::is_one(dimension) ? "rad" : model::text_of(dimension);
}

void require_dimension(const std::string& stage, const std::string& name, const model::MeasuredUnit& unit,
                       const StatedUnit& stated) {
  if (!stated.dimension || model::same(unit.dimension, *stated.dimension)) return;
  const std::string si = si_unit(*stated.dimension);
  throw Error(stage, {}, fmt::format("{} is set in {}, and the model has it in {}", model::quote(name), unit.text, si),
              fmt::format("give a value in {} or a multiple of it", si));
}

}  // namespace eomgen::run
