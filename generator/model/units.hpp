// SPDX-License-Identifier: GPL-3.0-or-later
// Units of measurement: exact factors to SI, and the algebra of dimensions.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "model/model.hpp"

namespace eomgen::model {

/// A unit as written: value in SI = value * scale * pi^pi_power.
struct MeasuredUnit {
  std::string text;
  Dimension dimension;
  Rational scale = 1;
  int pi_power = 0;
};

/// "m/s^2", "N*m", "1/s", "kg/(m*s)", "deg"; nothing if it is not made of known units.
std::optional<MeasuredUnit> parse_unit(std::string_view text);
/// What was meant by "m/s2", "m/s**2", "kg.m": the same with the signs that are missing; nothing if that is no unit
/// either.
std::optional<std::string> completed_unit(std::string_view text);
/// The units near to a misspelt one, for did-you-mean.
std::string unit_hint(std::string_view text);

bool same(const Dimension& a, const Dimension& b);
bool is_one(const Dimension& dimension);
Dimension product(const Dimension& a, const Dimension& b);
Dimension quotient(const Dimension& a, const Dimension& b);
Dimension raised(const Dimension& a, const Rational& exponent);
/// Canonical SI text: "m/s^2", "N", "1".
std::string text_of(const Dimension& dimension);
/// The dimension of a unit that is known to be right: dimension_of("kg*m^2").
Dimension dimension_of(std::string_view unit);
/// Unit of a quantity whose dimension is `dimension`.
Unit unit_of(const std::optional<Dimension>& dimension);

}  // namespace eomgen::model
