// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/units.hpp"
#include "run/quantities.hpp"
#include "symbolic/decimal.hpp"

namespace eomgen::cli {

using run::Quantity;
using symbolic::decimal_text;
using symbolic::parse_decimal;

/// Parses a decimal number and a unit after it. `shown` stands in messages. Throws Error{stage "cli"}.
Quantity parse_quantity(const std::string& text, const std::string& shown);

/// Parses NAME=VALUE arguments of `option`, such as "theta=30deg"; the last one of a name counts. Throws Error{stage
/// `command`} for anything else.
std::map<std::string, Quantity> parse_assignments(const std::string& command, const std::string& option,
                                                  const std::vector<std::string>& assignments);

/// Requires units of the dimension that the model states for a parameter, or for a coordinate or rate at the start.
/// Prints a warning where a parameter is stated in another unit than SI, such as "30 deg", and is set without one.
std::map<std::string, symbolic::Rational> in_model_units(const std::string& command, const model::Model& model,
                                                         const std::map<std::string, Quantity>& values);

/// Requires `units`, in which the values of `names` were written, to have the dimensions that the model states, as
/// in_model_units. Prints a warning for each name without one that the model states in another unit than SI.
void check_units(const std::string& command, const model::Model& model, const std::vector<std::string>& names,
                 const std::vector<std::optional<model::MeasuredUnit>>& units);

}  // namespace eomgen::cli
