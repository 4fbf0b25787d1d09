// SPDX-License-Identifier: GPL-3.0-or-later
// Letters of mechanics that the model does not use for its own names. If a rod has length L, the Lagrangian becomes a
// script L.
#pragma once

#include <algorithm>
#include <string>

#include "mechanics/mechanics.hpp"
#include "print/notation.hpp"
#include "reading/formula.hpp"

namespace eomgen::print {

inline std::string free_letter(const model::Model& model, const char* letter, const char* otherwise) {
  const auto taken = [&](const auto& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& entry) { return split_name(entry.name).base == letter; });
  };
  return taken(model.parameters) || taken(model.coordinates) || taken(model.functions) || taken(model.inputs) ||
                 taken(model.states)
             ? otherwise
             : letter;
}

/// Arguments for reading::mark; with a tilde if constraints are imposed.
struct Letters {
  std::string T, U, L, psi;

  Letters(const model::Model& model, bool constrained)
      : T(free_letter(model, "T", "cal T")),
        U(free_letter(model, "U", "cal U")),
        L(free_letter(model, "L", "cal L")),
        psi(free_letter(model, "psi", "Psi")) {
    if (!constrained) return;
    for (std::string* letter : {&T, &U, &L}) *letter += "~";
  }
};

/// psi of a constraint of Mechanics, with its number if several constraints are active.
inline reading::Formula constraint_letter(const Letters& letters, const mechanics::Mechanics& m,
                                          std::uint32_t constraint) {
  std::size_t held = 0;
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) held += m.is_independent(k) ? 1 : 0;
  return held == 1 ? reading::mark(letters.psi)
                   : reading::mark(letters.psi, {reading::number(static_cast<long>(constraint) + 1)});
}

}  // namespace eomgen::print
