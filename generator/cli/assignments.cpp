// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/assignments.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"
#include "error.hpp"
#include "model/names.hpp"
#include "model/syntax.hpp"

namespace eomgen::cli {
using run::require_dimension;
using run::si_unit;
using run::stated_unit;
using run::StatedUnit;
using symbolic::Rational;

Quantity parse_quantity(const std::string& text, const std::string& shown) {
  return run::parse_quantity("cli", text, shown);
}

std::map<std::string, Quantity> parse_assignments(const std::string& command, const std::string& option,
                                                  const std::vector<std::string>& assignments) {
  std::map<std::string, Quantity> result;
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Error(command, {}, fmt::format("{} sets nothing", model::quote(assignment)),
                  fmt::format("write {0} NAME=VALUE, such as {0} m=2.5", option));
    }
    result[assignment.substr(0, equals)] = parse_quantity(assignment.substr(equals + 1), assignment);
  }
  return result;
}

std::map<std::string, Rational> in_model_units(const std::string& command, const model::Model& model,
                                               const std::map<std::string, Quantity>& values) {
  std::map<std::string, Rational> result;
  for (const auto& [name, quantity] : values) {
    result[name] = quantity.value;
    const StatedUnit stated = stated_unit(model, name);
    if (quantity.unit) require_dimension(command, name, *quantity.unit, stated);
    if (!quantity.unit && stated.unit) {
      const std::string value = symbolic::decimal_text(quantity.value), si = si_unit(stated.unit->dimension);
      print_message(format_warning(
          {SourceLocation{},
           fmt::format("the model states {} in {}, and --set takes {} as {}", name, stated.unit->text, value, si),
           fmt::format("write --set {0}={1}{2}, or --set {0}={1}{3} if this is meant", name, value, stated.unit->text,
                       si)}));
    }
  }
  return result;
}

void check_units(const std::string& command, const model::Model& model, const std::vector<std::string>& names,
                 const std::vector<std::optional<model::MeasuredUnit>>& units) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const StatedUnit stated = stated_unit(model, names[i]);
    if (units[i]) require_dimension(command, names[i], *units[i], stated);
    if (units[i] || !stated.unit) continue;
    const std::string si = si_unit(stated.unit->dimension);
    print_message(format_warning(
        {SourceLocation{},
         fmt::format("the model states {} in {}, and {} takes its values as {}", names[i], stated.unit->text, command,
                     si),
         fmt::format("write its values with a unit, or state {} in {} in the model if they are", names[i], si)}));
  }
}

}  // namespace eomgen::cli
