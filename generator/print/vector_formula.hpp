// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of the model in terms of named vectors: positions r of places, axes e of bodies, E. In: an expression of the
// model. Out: a formula, and the places whose positions it contains.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/reading.hpp"

namespace eomgen::print {

class VectorFormula {
 public:
  /// `scalar`: the formula of a scalar factor; nothing if it is too long.
  VectorFormula(mechanics::Mechanics& mechanics, std::function<std::optional<reading::Formula>(model::NodeId)> scalar)
      : m_(mechanics), scalar_(std::move(scalar)) {}

  /// Returns nothing for other vectors, such as unit vectors of a chart or cross products.
  std::optional<reading::Formula> operator()(model::NodeId vector);

  const std::vector<std::uint32_t>& places() const { return places_; }

 private:
  std::optional<std::vector<reading::Formula>> terms(model::NodeId vector);
  std::optional<reading::Formula> axis(const model::Node& node);

  mechanics::Mechanics& m_;
  std::function<std::optional<reading::Formula>(model::NodeId)> scalar_;
  std::vector<std::uint32_t> places_;
};

}  // namespace eomgen::print
