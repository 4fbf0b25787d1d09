// SPDX-License-Identifier: GPL-3.0-or-later
// The derivation of one model as a paper. In: Mechanics, the display forms of both approaches, and the findings of
// later stages. Out: a LaTeX document.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "print/figure.hpp"
#include "reading/reading.hpp"
#include "reading/routh.hpp"

namespace eomgen::print {

/// Findings on a force, in the order of the model.
struct ForceFinding {
  std::string conservative;  // "yes", "no", "unknown"
  std::optional<symbolic::Ref> potential;
  bool many_valued = false;
  std::string reason;
};

struct ConservedFinding {
  system::OutputKind kind;  // as in conservation::ConservedQuantity
  std::uint32_t index, part;
  std::string title;
  symbolic::Ref expression;
  std::optional<reading::Sum> named;  // the same with functions of time by name
  bool proven = true;
};

/// An equilibrium or a steady motion.
struct SteadyFinding {
  std::string kind;
  std::vector<std::pair<symbolic::Symbol, double>> values;  // coordinates and rates
  std::vector<std::complex<double>> eigenvalues;            // nonzero; for a pair the one in the upper half-plane
  std::size_t zero_eigenvalues = 0, family_dimension = 0;
  std::string stability, reason;
};

/// Data of the sections after the equations.
struct Findings {
  std::optional<Figure> figure;
  std::vector<ForceFinding> forces;
  std::vector<ConservedFinding> conserved;
  std::optional<reading::RouthForm> routh;  // if a coordinate is cyclic
  std::vector<SteadyFinding> steady;
  std::vector<std::pair<std::string, double>> held;  // names and values that the search kept fixed
  std::string steady_skip_reason;                    // reason if no search was made, else empty
  std::string certificate;                           // the verdict of the comparison
  std::string checked_formulations;  // compared with d'Alembert's principle: "lagrange I, lagrange II, ..."
  std::vector<work::LeftOut> left_out;
};

/// A part that a document can omit.
struct DocumentPart {
  std::string_view name, what;
};
inline constexpr std::array<DocumentPart, 7> document_parts{{
    {"constraint_derivatives", "time derivatives of the constraints"},
    {"energy_derivatives", "partial derivatives of the energies"},
    {"constraint_forces", "constraint forces"},
    {"conserved", "conserved quantities"},
    {"routh", "Routh's reduction"},
    {"steady", "equilibria and steady motions"},
    {"singular", "singular sets"},
}};
/// Throws Error{stage "document"} if a name is not that of a part.
void require_document_parts(const std::vector<std::string>& names);

/// Returns the document. Without findings it contains the sections up to the equations, the constraint forces and the
/// singular sets. `omitted`: names of document_parts, which it lists as left out.
std::string latex_document(const mechanics::Mechanics& mechanics, const reading::DisplayForm& one,
                           const reading::DisplayForm& two, const std::optional<Findings>& findings = {},
                           const std::vector<std::string>& omitted = {});

}  // namespace eomgen::print
