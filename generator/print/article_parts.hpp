// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a document, in order. Each section writes to `out`. Formulas that exceed their budget are listed in
// `left_out`.
#pragma once

#include "print/article.hpp"
#include "print/formulas.hpp"
#include "print/latex_writer.hpp"
#include "print/letters.hpp"
#include "print/render.hpp"
#include "reading/partials.hpp"

namespace eomgen::print {

struct Article {
  const mechanics::Mechanics& m;
  const model::Model& model;
  const reading::DisplayForm &one, &two;
  const Findings* findings;
  LatexWriter& out;
  const std::vector<std::string>& omitted;  // names of document_parts
  std::vector<work::LeftOut> left_out = {};
  std::vector<reading::PowerOfSum> powers = {};  // of the potential, without constraints imposed
  LengthLetters letters = {};                    // of lengths in energies and equations
  std::vector<Statement> lengths = {};           // their definitions

  /// Whether the equations of approach II differ from those of approach I.
  bool approaches_differ() const;
  bool omits(std::string_view part) const;
  std::string coordinate_math(std::uint32_t coordinate, std::uint8_t order = 0) const;  // $\theta$
  /// The formulas of statements; omitted ones are listed in `left_out`.
  std::vector<reading::Formula> formulas(const std::vector<Statement>& statements);
  /// Fills in `letters` and `lengths`.
  void find_lengths();
  /// The formula with these letters.
  reading::Formula with_letters(reading::Formula formula) const;
};

/// \textbf{..}
std::string bold(const std::string& name);

void write_system(Article& article);
void write_coordinates(Article& article);
void write_energies(Article& article);
/// d/dt dT/dqdot - dT/dq + dU/dq = Q_q + ..
void write_lagrange_law(Article& article);
/// dT/dqdot, its rate, dT/dq, dU/dq, Q of each coordinate. Approach I fills `first`; approach II shows only those that
/// differ from `first`.
void write_partial_derivatives(Article& article, const reading::DisplayForm& form,
                               std::vector<reading::PartialDerivatives>& first);
void write_equations(Article& article);
void write_constraint_forces(Article& article);
void write_contacts(Article& article);
void write_conserved_quantities(Article& article);
void write_routh(Article& article);
void write_steady_motions(Article& article);
void write_singular_sets(Article& article);
void write_certificate(Article& article);

}  // namespace eomgen::print
