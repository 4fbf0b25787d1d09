// SPDX-License-Identifier: GPL-3.0-or-later
// Printed formulas for `derive`, `check` and documents. In: Mechanics and DisplayForm. Out: printed formulas.
#pragma once

#include <string>
#include <vector>

#include "print/printer.hpp"
#include "reading/linear_form.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"
#include "reading/solved_form.hpp"
#include "results.hpp"

namespace eomgen::print {

using PrintedFormula = eomgen::Formula;

/// The lengths with a letter in the formulas of one reader: s, or s_1, s_2, ...
struct LengthLetters {
  std::vector<std::string> texts;  // of the lengths, in the order of their letters
  bool has_first_alone = false;    // the first is s, not s_1
};

/// The formulas that `show` selects (keys, or "all"); "equations" includes the explicit form. On an interruption it
/// throws work::Interrupted, or, if `interrupted` is given, sets it and returns the formulas so far.
std::vector<PrintedFormula> render(const mechanics::Mechanics& mechanics, const reading::DisplayForm& form,
                                   const std::vector<std::string>& show, bool* interrupted = nullptr,
                                   LengthLetters* letters = nullptr);

/// M, C, K, B under the key "linear": along a motion, or at rest with the equilibrium equations.
std::vector<PrintedFormula> render_linear(const mechanics::Mechanics& mechanics, const reading::LinearForm& form,
                                          LengthLetters* letters = nullptr);

/// The same about one equilibrium, `where` by name, as equations.
std::vector<PrintedFormula> render_linear(const mechanics::Mechanics& mechanics, const reading::LinearEquations& form,
                                          const std::string& where);

/// Accelerations, multipliers, constraint forces and closed forms under the key "solved".
std::vector<PrintedFormula> render_solved(const mechanics::Mechanics& mechanics, const reading::SolvedForm& form,
                                          LengthLetters* letters = nullptr);

/// Routh's reduction under the key "routh": constant momenta, the resulting rates, the Routhian, the reduced equations.
std::vector<PrintedFormula> render_routh(const mechanics::Mechanics& mechanics, const reading::RouthForm& form,
                                         LengthLetters* letters = nullptr);

/// The singular sets, which are not part of `form`.
std::vector<PrintedFormula> render_singular(const mechanics::Mechanics& mechanics);

/// An expression of the Dag, simplified for display: potentials, conserved quantities.
PrintedFormula render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                                 symbolic::Ref expression);

PrintedFormula render_expression(const mechanics::Mechanics& mechanics, std::string key, std::string name,
                                 const reading::Sum& expression);

}  // namespace eomgen::print
