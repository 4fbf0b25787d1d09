// SPDX-License-Identifier: GPL-3.0-or-later
// Typography of model names and letters of mechanics: theta1_dot is theta with index 1 and a dot. User names reach
// LaTeX and MathML only through this file (the model reader validates `tex` overrides).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/reading.hpp"

namespace eomgen::print {

/// A letter or word with indices.
struct Glyph {
  std::string base;                // "theta", "x", "length"
  std::vector<std::string> index;  // "1", "max"
  int dots = 0;
  std::string name;  // plain, "theta1_dot"
  std::string tex;   // override of base and index, or empty
};

/// "theta1" -> theta, 1; "m_P" -> m, P; "x1_ref" -> x, 1, ref; "length" -> length.
Glyph split_name(std::string_view name);

/// The names of one model's symbols.
class Notation {
 public:
  explicit Notation(const mechanics::Mechanics& mechanics);
  Glyph operator()(const symbolic::Symbol& symbol) const;
  /// The integrand of an integral of the model; nothing if it cannot be written as one formula.
  std::optional<reading::Formula> integrand(std::uint32_t integral) const;
  /// lambda, or lambda_2 if there are several. For the joint "pin": lambda_pin_F1 (a force), lambda_pin_M2 (a moment).
  Glyph multiplier(std::uint32_t constraint) const;

 private:
  const model::Model* model_;
  std::size_t multipliers_;
  std::vector<std::optional<Glyph>> of_joints_;  // per constraint
  std::string momentum_letter_ = "p";            // p_theta: momentum of a cyclic coordinate; Pi if the model has a p
  std::string omega_letter_ = "omega";           // components of an angular velocity; varpi if the model has an omega
  std::string cosine_letter_ = "gamma";          // direction cosines; Gamma if the model has a gamma
  std::string multiplier_letter_;                // mu if the model has a lambda
};

/// "\theta_{1}", "\dot{\theta}_{1}", "\mathrm{length}".
std::string latex(const Glyph& glyph);
/// "<msub><mi>θ</mi><mn>1</mn></msub>".
std::string mathml(const Glyph& glyph);

/// The meaning of a multiplier, for a legend: "of the constraint 'wire.2'", "force of the joint 'pin' on 'second' along
/// E1".
struct MultiplierDescription {
  std::uint32_t constraint;
  std::string text;
};
/// Descriptions for the active constraints; empty if there is only one.
std::vector<MultiplierDescription> multiplier_descriptions(const mechanics::Mechanics& mechanics);

/// The Greek letter with this name in UTF-8; empty if there is none.
std::string_view greek(std::string_view name);

/// Escapes user text for LaTeX or HTML.
std::string escape_latex(std::string_view text);
std::string escape_html(std::string_view text);

}  // namespace eomgen::print
