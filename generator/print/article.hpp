// SPDX-License-Identifier: GPL-3.0-or-later
// The derivation of one model as a paper has it. In: Mechanics, both reading forms, and what later stages have found.
// Out: a LaTeX document.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "print/figure.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"

namespace eomgen::print {

/// A force of the model, in its order.
struct ForceFinding {
  std::string conservative;  // "yes", "no", "unknown"
  std::optional<symbolic::Ref> potential;
  bool many_valued = false;
  std::string reason;
};

struct ConservedFinding {
  system::OutputKind kind;  // as conservation::Conserved has them
  std::uint32_t index, part;
  std::string title;
  symbolic::Ref expression;
  std::optional<reading::Sum> named;  // the same, where functions of time keep their names
  bool proven = true;
};

/// An equilibrium or a steady motion.
struct SteadyFinding {
  std::string kind;
  std::vector<std::pair<symbolic::Symbol, double>> values;  // of coordinates and rates
  std::vector<std::complex<double>> eigenvalues;            // that are not 0, of a pair the one above the axis
  std::size_t zeros = 0, family = 0;
  std::string stability, reason;
};

/// What the sections after the equations are made of.
struct Findings {
  std::optional<Figure> figure;
  std::vector<ForceFinding> forces;
  std::vector<ConservedFinding> conserved;
  std::optional<reading::RouthForm> routh;  // where a coordinate is cyclic
  std::vector<SteadyFinding> steady;
  std::vector<std::pair<std::string, double>> held;  // what the search held, by name
  std::string no_steady;                             // why none is looked for; empty where the search was made
  std::string certificate;                           // the verdict of the comparison
  std::string judged;  // what was compared with d'Alembert's principle: "lagrange I, lagrange II, ..."
  std::vector<work::LeftOut> left_out;
};

/// Without findings: the sections as far as the equations, the constraint forces and the singular sets.
std::string latex_document(const mechanics::Mechanics& mechanics, const reading::ReadingForm& one,
                           const reading::ReadingForm& two, const std::optional<Findings>& findings = {});

}  // namespace eomgen::print
