// SPDX-License-Identifier: GPL-3.0-or-later
// Values as text with a unit, such as "30 deg", for parameters, inputs and start values of a model. In: a text. Out: a
// number in SI units, after its dimension was compared with that of the model.
#pragma once

#include <optional>
#include <string>

#include "error.hpp"
#include "model/model.hpp"
#include "model/units.hpp"
#include "symbolic/decimal.hpp"

namespace eomgen::run {

/// A value in SI units, and the unit it was written in: "30 deg", "30deg", "0.5".
struct Quantity {
  symbolic::Rational value;
  std::optional<model::MeasuredUnit> unit;
};

/// Parses a decimal number and a unit after it. `shown` stands in messages. Throws Error{stage}.
Quantity parse_quantity(const std::string& stage, const std::string& text, const std::string& shown);

/// What the model states about a name: its dimension, if known, and its unit as written, if it is not SI.
struct StatedUnit {
  std::optional<model::Dimension> dimension;
  std::optional<model::MeasuredUnit> unit;
};

/// Of a parameter, an input, a state, or a coordinate or rate at the start. Empty for other names.
StatedUnit stated_unit(const model::Model& model, const std::string& name);

/// "rad" for a pure number.
std::string si_unit(const model::Dimension& dimension);

/// Throws Error{stage} if a value of `name` was written in a unit of another dimension.
void require_dimension(const std::string& stage, const std::string& name, const model::MeasuredUnit& unit,
                       const StatedUnit& stated);

}  // namespace eomgen::run
