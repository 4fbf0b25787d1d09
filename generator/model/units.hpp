// SPDX-License-Identifier: GPL-3.0-or-later
// Units of measurement: exact conversion factors to SI, and the algebra of dimensions.
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

/// Parses "m/s^2", "N*m", "1/s", "kg/(m*s)" or "deg"; nothing if it is not composed of known units.
std::optional<MeasuredUnit> parse_unit(std::string_view text);
/// A correction of "m/s2", "m/s**2" or "kg.m" with the missing operators; nothing if that is not a unit either.
std::optional<std::string> suggest_unit(std::string_view text);
/// Suggests units similar to a misspelt one.
std::string unit_hint(std::string_view text);

bool same(const Dimension& a, const Dimension& b);
bool is_one(const Dimension& dimension);
Dimension product(const Dimension& a, const Dimension& b);
Dimension quotient(const Dimension& a, const Dimension& b);
Dimension raised(const Dimension& a, const Rational& exponent);
/// Canonical SI text: "m/s^2", "N", "1".
std::string text_of(const Dimension& dimension);
/// The dimension of a valid unit: dimension_of("kg*m^2").
Dimension dimension_of(std::string_view unit);
/// The SI unit of a dimension.
Unit unit_of(const std::optional<Dimension>& dimension);

}  // namespace eomgen::model
