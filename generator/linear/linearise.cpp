// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/linearise.hpp"

#include <algorithm>

namespace eomgen::linear {
namespace {

// A start is known to some 16 digits, the end of a run to its tolerance: what is this near to a steady motion is on it.
constexpr double nearness = 1e-7;

struct Equations {
  Matrix<Precise> value, slope;
};

void add(Equations& e, const Matrix<Precise>& value, const Matrix<Precise>& slope) {
  e.value = stacked(std::move(e.value), value);
  e.slope = stacked(std::move(e.slope), slope);
}

Equations steady_equations(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z, const State<Precise>& start,
                           const Setting<Precise>& setting, const Extra& extra) {
  const Field<Precise> field = flow.at(z, setting);
  Equations e{field.phi, field.phi_slope};
  e.slope.cols = field.phi_slope.cols;
  add(e, rows_of(field.X, symmetry.constant), rows_of(field.slope, symmetry.constant));
  for (const std::size_t i : ignored_positions(symmetry)) {
    Matrix<Precise> value(1, 1), slope(1, field.slope.cols);
    value(0, 0) = z[i] - start[i];
    slope(0, i) = Precise(1);
    add(e, value, slope);
  }
  if (extra) {
    Matrix<Precise> value, slope;
    extra(z, value, slope);
    if (value.rows > 0) add(e, value, slope);
  }
  return e;
}

/// Every equation holds in many digits, against the size of its terms.
bool holds(const Equations& e, const State<Precise>& z) {
  for (std::size_t i = 0; i < e.value.rows; ++i) {
    Precise size(1);
    for (std::size_t j = 0; j < e.slope.cols; ++j) size = size + magnitude(e.slope(i, j)) * (Precise(1) + magnitude(z[j]));
    if (magnitude(e.value(i, 0)) > tiny<Precise>(90) * size) return false;
  }
  return true;
}

/// What counts as no pivot and as no row or column, as powers of 1/10.
struct Rank {
  int cutoff, floor;
};

std::optional<State<Precise>> newton(const Flow& flow, const Symmetry& symmetry, const State<Precise>& start,
                                     const Setting<Precise>& setting, const Extra& extra, const Rank& rank) {
  constexpr int most_steps = 40, exact = 120;
  State<Precise> z = start;
  for (int step = 0; step < most_steps; ++step) {
    Equations e = steady_equations(flow, symmetry, z, start, setting, extra);
    for (std::size_t i = 0; i < e.slope.rows; ++i) e.slope(i, e.slope.cols - 1) = Precise(0);  // t stays
    const Matrix<Precise> move = Elimination<Precise>(e.slope, tiny<Precise>(rank.cutoff), tiny<Precise>(rank.floor)).solve(e.value);
    bool done = true;
    for (std::size_t i = 0; i + 1 < z.size(); ++i) {
      z[i] = z[i] - move(i, 0);
      if (magnitude(move(i, 0)) > Precise(1000) * (Precise(1) + magnitude(start[i]))) return std::nullopt;
      done = done && magnitude(move(i, 0)) <= tiny<Precise>(exact) * (Precise(1) + magnitude(z[i]));
    }
    if (done) return holds(steady_equations(flow, symmetry, z, start, setting, extra), z) ? std::optional(z) : std::nullopt;
  }
  return std::nullopt;
}

bool is_near(const State<Precise>& a, const State<Precise>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(to_double(a[i] - b[i])) > nearness * (1 + std::abs(to_double(b[i])))) return false;
  }
  return true;
}

Matrix<Precise> reduced_matrix(const Field<Precise>& field, const Chart& chart, const Matrix<Precise>& T) {
  const Matrix<Precise> with_time = reduced(field, chart, T);
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < chart.independent.size(); ++k) columns.push_back(k);
  Matrix<Precise> A = columns_of(with_time, columns);
  Precise largest(0);
  for (const Precise& x : A.a) largest = std::max(largest, magnitude(x));
  for (Precise& x : A.a) {  // what cancels leaves a rounding
    if (magnitude(x) <= tiny<Precise>(100) * largest) x = Precise(0);
  }
  return A;
}

/// Zeros of the same motion with other parameters; along a motion that is not steady, at another of its states too.
std::optional<std::size_t> zeros_beside(const Flow& flow, const Linearisation& here, Setting<Precise> setting, std::uint64_t seed) {
  try {
    setting.leaf = flow.leaf(here.z, setting);
    const auto z = here.kind == Kind::motion ? beside(flow, here.z, setting, seed) : steady_state(flow, here.symmetry, here.z, setting);
    if (!z) return std::nullopt;
    const Field<Precise> field = flow.at(*z, setting);
    return zero_eigenvalues(reduced_matrix(field, here.symmetry.chart, tangent(field, here.symmetry.chart)));
  } catch (const std::domain_error&) {
    return std::nullopt;  // no such motion with these parameters
  }
}

}  // namespace

const char* name(Kind kind) {
  switch (kind) {
    case Kind::equilibrium: return "equilibrium";
    case Kind::steady: return "steady motion";
    case Kind::motion: break;
  }
  return "motion";
}

// In a family of steady motions the slopes lose rank there, and all but lose it beside: such pivots count as none. Where that
// throws an equation away that is needed, the iteration does not end, and smaller pivots count.
std::optional<State<Precise>> steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                           const Setting<Precise>& setting, const Extra& extra) {
  for (const Rank rank : {Rank{5, 11}, Rank{10, 14}, Rank{20, 30}}) {
    try {
      if (auto found = newton(flow, symmetry, z, setting, extra, rank)) return found;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return std::nullopt;
}

Linearisation linearise(const Flow& flow, const State<Precise>& start, const Setting<Precise>& setting,
                        const std::vector<Setting<Precise>>& neighbours, std::uint64_t seed) {
  Linearisation result;
  result.setting = setting;
  const auto on_constraints = projected(flow, start, setting);
  require_domain(on_constraints.has_value(), "the state does not satisfy the constraints");
  result.z = *on_constraints;
  result.symmetry = find_symmetry(flow, result.z, setting, seed);
  // The independent entries as they were given.
  if (const auto same = projected(flow, start, setting, result.symmetry.chart.dependent)) result.z = *same;
  if (result.symmetry.autonomous) {
    const auto steady = steady_state(flow, result.symmetry, result.z, setting);
    if (steady && is_near(*steady, result.z)) {
      result.z = *steady;
      result.kind = Kind::equilibrium;
      for (std::size_t i = 0; i < flow.coordinates(); ++i) {
        if (magnitude(result.z[flow.coordinates() + i]) > tiny<Precise>(60)) result.kind = Kind::steady;
      }
    }
  }
  for (Precise& x : result.z) {
    if (magnitude(x) <= tiny<Precise>(100)) x = number<Precise>(Precise(0));
  }
  const Chart& chart = result.symmetry.chart;
  result.field = flow.at(result.z, setting);
  result.tangent = tangent(result.field, chart);
  result.A = reduced_matrix(result.field, chart, result.tangent);
  result.B = rows_of(result.field.by_inputs, chart.independent);
  result.spectrum = spectrum(result.A);
  result.structural_zeros = result.spectrum.zeros;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const auto zeros = zeros_beside(flow, result, neighbours[k], 7000 + 100 * seed + k);
    if (zeros) result.structural_zeros = std::min(result.structural_zeros, *zeros);
  }
  return result;
}

}  // namespace eomgen::linear
