// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/latex_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/drawing/figure.hpp"
#include "analysis/named_functions.hpp"
#include "analysis/steady_search.hpp"
#include "conservation/conservative.hpp"
#include "derive/formulations/lagrange.hpp"
#include "pipeline/certificate_cache.hpp"
#include "pipeline/pipeline.hpp"
#include "print/article.hpp"
#include "reading/forms.hpp"

namespace eomgen::analysis {
namespace {

using mechanics::Mechanics;
using reading::DisplayForm;

// The cost of a search grows with coordinates and starts. Larger searches are left to `equilibria`.
constexpr std::size_t most_coordinates = 3, starts = 40;

std::vector<print::ForceFinding> forces_of(Mechanics& m) {
  std::vector<print::ForceFinding> result;
  for (const conservation::ForceClassification& f : conservation::classify_forces(m)) {
    result.push_back({conservation::name(f.conservative), f.potential, f.many_valued, f.reason});
  }
  return result;
}

std::vector<print::ConservedFinding> conserved_of(const Mechanics& m, const DisplayForm& two,
                                                  const std::vector<conservation::ConservedQuantity>& conserved) {
  std::vector<print::ConservedFinding> result;
  for (const conservation::ConservedQuantity& c : conserved) {
    result.push_back({c.kind, c.index, c.part, c.title, c.expression, express_in_named_functions(m, two, c),
                      c.certainty == conservation::Certainty::proven});
  }
  return result;
}

verify::Certificate compare_derivations(Mechanics& m, const DisplayForm& one, const DisplayForm& two,
                                        const verify::Options& options, const print::Findings& findings) {
  const std::string identity = pipeline::program_identity(), model = m.model->content_hash;
  const bool is_cached = !identity.empty() && !model.empty();
  const std::string key =
      fmt::format("document\n{}\n{}\n{} {} {}\n", identity, model, options.digits, options.points, options.seed);
  if (is_cached) {
    if (std::optional<verify::Certificate> earlier = pipeline::load_certificate(key)) {
      earlier->options = options;
      return std::move(*earlier);
    }
  }
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(m, &subjects.left_out);
  for (const DisplayForm* form : {&one, &two}) {
    if (!form->is_unexpanded)
      subjects.reading.push_back(
          {fmt::format("display form {}", system::name(form->approach)), reading::residuals_on_dag(*form, m)});
  }
  if (findings.routh) subjects.reading.push_back({"Routh's reduction", reading::residuals_on_dag(*findings.routh, m)});
  verify::Certificate certificate = verify::certify(m, subjects, options);
  if (certificate.interrupted) throw work::Interrupted{};
  if (is_cached) pipeline::store_certificate(key, certificate);
  return certificate;
}

void check_against_oracle(Mechanics& m, const DisplayForm& one, const DisplayForm& two, std::uint64_t seed,
                          print::Findings& findings) {
  const work::Stage stage("holding the derivations against one another");
  const verify::Certificate certificate =
      compare_derivations(m, one, two, {50, pipeline::emission_points, seed, {}}, findings);
  pipeline::require_pass(certificate, *m.model);
  // Omits the measured differences: their last digits depend on the machine's word size, and output must be identical.
  findings.certificate = fmt::format("{} at {} random states in {} digits, {} comparisons", certificate.verdict(),
                                     certificate.points, certificate.options.digits, certificate.comparisons.size());
  for (const std::string& name : certificate.agreeing_forms())
    findings.checked_formulations += (findings.checked_formulations.empty() ? "" : ", ") + name;
}

/// Figure at the start of the default scene.
void draw_figure(Mechanics& m, const system::EquationSystem& system, print::Findings& findings) {
  try {
    findings.figure = figure(m, run::resolve_scene(m, system, m.model->scene("default"), {}));
  } catch (const Error& error) {
    if (error.fault() == ErrorKind::check) throw;
    findings.left_out.push_back({"the figure", error.message()});
  }
}

print::SteadyFinding finding(const SteadyProblem& p, const SteadyMotion& motion) {
  print::SteadyFinding result;
  result.kind = linear::name(motion.l.kind);
  const std::vector<std::uint32_t>& free = p.system().free;
  for (std::size_t i = 0; i < p.system().layout().first_order_begin(); ++i) {
    const bool rate = i >= free.size();
    const double value = display_value(motion.l.z[i]);
    if (rate && value == 0) continue;  // all rates of an equilibrium
    result.values.emplace_back(
        symbolic::Symbol{symbolic::SymbolKind::coordinate, free[i % free.size()], static_cast<std::uint8_t>(rate)},
        value);
  }
  for (const linear::Eigenvalue& e : motion.l.spectrum.values) {
    if (e.im < 0 || (e.re == 0 && e.im == 0)) continue;
    result.eigenvalues.emplace_back(e.re, e.im);
  }
  result.zero_eigenvalues = motion.l.spectrum.zeros;
  result.family_dimension = motion.family_dimension;
  result.stability = linear::in_words(motion.verdict.stability);
  result.reason = motion.verdict.reason;
  return result;
}

void look_for_steady_motions(const Mechanics& m, const DisplayForm& two, std::uint64_t seed,
                             print::Findings& findings) {
  if (m.degrees_of_freedom() <= 0) {
    findings.steady_skip_reason = "the constraints prescribe the motion";
    return;
  }
  if (two.is_unexpanded || two.equations.size() > most_coordinates) {
    findings.steady_skip_reason = "the search takes long for a system of this size; eomgen equilibria makes it";
    return;
  }
  SteadyRequest request;
  request.model = m.model;
  request.starts = starts;
  request.seed = seed;
  try {
    const SteadyMotions found = steady_motions(request);
    if (found.search.interrupted) throw work::Interrupted{};
    for (const SteadyMotion& motion : found.points) findings.steady.push_back(finding(found.problem, motion));
    for (const HeldValue& h : found.held) findings.held.emplace_back(h.name, h.value);
  } catch (const Error& error) {
    if (error.fault() == ErrorKind::check) throw;
    findings.steady_skip_reason = error.message();
  }
}

}  // namespace

std::string latex_document(std::shared_ptr<const model::Model> model, std::uint64_t seed,
                           const std::vector<std::string>& omitted) {
  print::require_document_parts(omitted);
  const work::Stage stage("deriving the equations");
  Mechanics m = mechanics::build_mechanics(std::move(model));
  reading::DisplayForms forms(m);
  const DisplayForm &one = forms(system::Approach::one), &two = forms(system::Approach::two);
  print::Findings findings;
  findings.forces = forces_of(m);
  system::EquationSystem system = derive::lagrange(m, system::Approach::two);
  const std::vector<conservation::ConservedQuantity> conserved = conservation::conserved_quantities(m, system);
  findings.conserved = conserved_of(m, two, conserved);
  const std::vector<std::uint32_t> cyclic = conservation::cyclic_coordinates(conserved);
  if (!cyclic.empty()) findings.routh = forms.routh(cyclic);
  draw_figure(m, system, findings);
  check_against_oracle(m, one, two, seed, findings);
  if (std::find(omitted.begin(), omitted.end(), "steady") == omitted.end())
    look_for_steady_motions(m, two, seed, findings);
  return print::latex_document(m, one, two, findings, omitted);
}

}  // namespace eomgen::analysis
