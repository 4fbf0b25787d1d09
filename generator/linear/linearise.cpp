// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/linearise.hpp"

#include <algorithm>

namespace eomgen::linear {
namespace {

// A start is known to about 16 digits, the end of a run to its tolerance. A state this close to a steady motion counts
// as on it.
constexpr double nearness = 1e-7;

bool is_near(const State<Precise>& a, const State<Precise>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(to_double(a[i] - b[i])) > nearness * (1 + std::abs(to_double(b[i])))) return false;
  }
  return true;
}

Matrix<Precise> reduced_matrix(const Field<Precise>& field, const Chart& chart, const Matrix<Precise>& T, int known) {
  const Matrix<Precise> with_time = reduced_jacobian(field, chart, T);
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < chart.independent.size(); ++k) columns.push_back(k);
  Matrix<Precise> A = columns_of(with_time, columns);
  Precise largest(0);
  for (const Precise& x : A.a) largest = std::max(largest, magnitude(x));
  for (Precise& x : A.a) {  // cancellation leaves rounding errors
    if (magnitude(x) <= tiny<Precise>(std::min(100, known - 5)) * largest) x = Precise(0);
  }
  return A;
}

/// Zero eigenvalues of the same motion with other parameters; along an unsteady motion also at another of its states.
std::optional<std::size_t> zeros_beside(const Flow& flow, const Linearisation& here, Setting<Precise> setting,
                                        std::uint64_t seed) {
  try {
    setting.leaf = flow.leaf(here.z, setting);
    const auto z = here.kind == MotionKind::motion ? nearby_state(flow, here.z, setting, seed)
                                                   : solve_steady_state(flow, here.symmetry, here.z, setting);
    if (!z) return std::nullopt;
    const Field<Precise> field = flow.at(*z, setting);
    return zero_eigenvalues(reduced_matrix(field, here.symmetry.chart, tangent(field, here.symmetry.chart), here.known),
                            here.known);
  } catch (const std::domain_error&) {
    return std::nullopt;  // no such motion with these parameters
  }
}

}  // namespace

const char* name(MotionKind kind) {
  switch (kind) {
    case MotionKind::equilibrium: return "equilibrium";
    case MotionKind::steady: return "steady motion";
    case MotionKind::motion: break;
  }
  return "motion";
}

Linearisation linearise(const Flow& flow, const State<Precise>& start, const Setting<Precise>& setting,
                        const std::vector<Setting<Precise>>& neighbours, std::uint64_t seed) {
  Linearisation result;
  result.setting = setting;
  const auto on_constraints = project_onto_constraints(flow, start, setting);
  require_domain(on_constraints.has_value(), "the state does not satisfy the constraints");
  result.z = *on_constraints;
  result.symmetry = find_symmetry(flow, result.z, setting, seed);
  // Keeps the independent entries as given.
  if (const auto same = project_onto_constraints(flow, start, setting, result.symmetry.chart.dependent))
    result.z = *same;
  if (result.symmetry.autonomous) {
    const auto steady = find_steady_state(flow, result.symmetry, result.z, setting);
    if (steady && is_near(steady->z, result.z)) {
      result.z = steady->z;
      result.parameter_change = steady->parameter_change;
      result.known = steady->known;
      result.kind = MotionKind::equilibrium;
      for (std::size_t i = 0; i < flow.coordinates(); ++i) {
        if (magnitude(result.z[flow.coordinates() + i]) > tiny<Precise>(std::min(60, result.known - 5)))
          result.kind = MotionKind::steady;
      }
    }
  }
  for (Precise& x : result.z) {
    if (magnitude(x) <= tiny<Precise>(std::min(100, result.known - 5))) x = number<Precise>(Precise(0));
  }
  const Chart& chart = result.symmetry.chart;
  flow.require_regular(result.z, setting);
  result.field = flow.at(result.z, setting);
  result.tangent = tangent(result.field, chart);
  result.A = reduced_matrix(result.field, chart, result.tangent, result.known);
  result.B = rows_of(result.field.input_jacobian, chart.independent);
  result.spectrum = spectrum(result.A, result.known);
  result.structural_zeros = result.spectrum.zeros;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const auto zeros = zeros_beside(flow, result, neighbours[k], 7000 + 100 * seed + k);
    if (zeros) result.structural_zeros = std::min(result.structural_zeros, *zeros);
  }
  return result;
}

}  // namespace eomgen::linear
