// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths that occur again and again, such as that of a spring between two pendulums, by a letter. In: statements. Out:
// the same with the letter, and its definition.
#pragma once

#include <vector>

#include "print/formulas.hpp"
#include "print/render.hpp"

namespace eomgen::print {

/// Names square roots of at least four terms that energies and equations contain more than once, and the lengths of
/// springs. The definitions have the key "parts". `letters`: of earlier statements, whose definitions are not repeated,
/// or null.
void name_lengths(const mechanics::Mechanics& mechanics, std::vector<Statement>& statements, LengthLetters* letters);

}  // namespace eomgen::print
