// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/steady.hpp"

#include "analysis/output_slopes.hpp"
#include "analysis/steady_search.hpp"
#include "eomgen/call.hpp"
#include "eomgen/model.hpp"
#include "eomgen/validation.hpp"

namespace eomgen {
namespace {

std::vector<double> entries(const linear::Matrix<linear::Precise>& A) {
  std::vector<double> result;
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.cols; ++j) result.push_back(analysis::display_value(A(i, j)));
  }
  return result;
}

std::vector<std::complex<double>> eigenvalues(const linear::Spectrum& spectrum) {
  std::vector<std::complex<double>> result;
  for (const linear::Eigenvalue& e : spectrum.values) result.emplace_back(e.re, e.im);
  return result;
}

}  // namespace

Linearisation Model::linearise(const LineariseOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener&) {
    run::Overrides overrides;
    overrides.values = exact_rationals(options.parameters);
    const analysis::SteadyProblem problem = analysis::steady_problem(
        "linearize", read_, options.scene, overrides, options.time, options.seed, analysis::Contacts::held);
    Linearisation result;
    const linear::Linearisation l = analysis::linearise_at_state(problem, options.seed);
    result.kind = linear::name(l.kind);
    for (const std::size_t i : l.symmetry.chart.independent) result.states.push_back(problem.flow->names()[i]);
    result.A = entries(l.A);
    result.B = entries(l.B);
    const analysis::OutputSlopes slopes = analysis::linearise_outputs(problem, l, options.outputs);
    result.outputs = slopes.names;
    for (const linear::Precise& value : slopes.values) result.output_values.push_back(analysis::display_value(value));
    result.C = entries(slopes.C);
    result.D = entries(slopes.D);
    result.eigenvalues = eigenvalues(l.spectrum);
    result.structural_zeros = l.structural_zeros;
    result.inputs = inputs();
    result.certificate = problem.certificate;
    return result;
  });
}

SteadyMotions Model::steady_motions(const SteadyOptions& options, const CallControl& control) const {
  require_valid(options);
  return with_lock(control, [&](CallListener& call) {
    analysis::SteadyRequest request;
    request.model = read_;
    request.scene = options.scene;
    request.overrides.values = exact_rationals(options.parameters);
    request.hold = exact_rationals(options.hold);
    request.starts = options.starts;
    request.seed = options.seed;
    request.progress = call.progress();
    const analysis::SteadyMotions found = analysis::steady_motions(request);
    SteadyMotions result;
    for (const analysis::SteadyMotion& from : found.points) {
      SteadyMotion motion;
      motion.kind = linear::name(from.l.kind);
      const std::vector<std::string>& names = found.problem.flow->names();
      for (std::size_t i = 0; i + 1 < from.l.z.size(); ++i)
        motion.state[names[i]] = analysis::display_value(from.l.z[i]);
      motion.stability = linear::name(from.verdict.stability);
      motion.reason = from.verdict.reason;
      motion.eigenvalues = eigenvalues(from.l.spectrum);
      motion.family_dimension = from.family_dimension;
      result.motions.push_back(std::move(motion));
    }
    for (const analysis::HeldValue& h : found.held) result.held[h.name] = h.value;
    result.interrupted = found.search.interrupted;
    result.certificate = found.problem.certificate;
    return result;
  });
}

}  // namespace eomgen
