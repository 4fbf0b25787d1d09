// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/chart.hpp"

#include <algorithm>
#include <eom/layout.hpp>
#include <tuple>

namespace eomgen::linear {
namespace {

using Places = std::vector<std::size_t>;

constexpr std::size_t most_charts = 4000;
constexpr double good_chart = 0.02;  // smallest pivot of the dependent columns, relative to 1
constexpr double well_conditioned = 0.3;
constexpr double reach = 0.07;  // relative distance of nearby points
constexpr int sample_points = 3;

Places all_of(std::size_t from, std::size_t to) {
  Places result;
  for (std::size_t i = from; i < to; ++i) result.push_back(i);
  return result;
}

Places without(const Places& all, const Places& some) {
  Places result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result),
               [&](std::size_t i) { return std::find(some.begin(), some.end(), i) == some.end(); });
  return result;
}

Matrix<double> rounded(const Matrix<Precise>& A) {
  Matrix<double> B(A.rows, A.cols);
  std::transform(A.a.begin(), A.a.end(), B.a.begin(), [](const Precise& x) { return to_double(x); });
  return B;
}

/// Candidate sets of dependent columns for a block of constraints, the best first.
struct Candidate {
  Places columns;
  double quality;
};

/// n over k; any value above `most_charts` if it exceeds that.
std::size_t subsets_of(std::size_t n, std::size_t k) {
  std::size_t count = 1;
  for (std::size_t i = 0; i < std::min(k, n - k) && count <= most_charts; ++i) count = count * (n - i) / (i + 1);
  return count;
}

void subsets(std::size_t n, std::size_t size, std::size_t from, Places& chosen, std::vector<Places>& result) {
  if (chosen.size() == size) {
    result.push_back(chosen);
    return;
  }
  for (std::size_t i = from; i + size - chosen.size() <= n; ++i) {
    chosen.push_back(i);
    subsets(n, size, i + 1, chosen, result);
    chosen.pop_back();
  }
}

std::vector<Candidate> candidates(const Matrix<Precise>& block) {
  const Elimination<Precise> whole(block, tiny<Precise>(40), tiny<Precise>(60));
  Places pivots = whole.pivot_columns();
  std::sort(pivots.begin(), pivots.end());
  std::vector<Places> all;
  Places chosen;
  if (subsets_of(block.cols, pivots.size()) > most_charts)
    all = {pivots};
  else
    subsets(block.cols, pivots.size(), 0, chosen, all);
  Matrix<double> A = rounded(block);
  for (std::size_t i = 0; i < A.rows; ++i) {  // relative to the whole row, so that a nearly zero entry is no pivot
    double size = 0;
    for (std::size_t j = 0; j < A.cols; ++j) size = std::max(size, std::abs(A(i, j)));
    for (std::size_t j = 0; j < A.cols && size > 0; ++j) A(i, j) /= size;
  }
  std::vector<Candidate> result;
  Candidate best{pivots, 0};
  for (const Places& columns : all) {
    const Elimination<double> e(columns_of(A, columns), 1e-9, numeric::Pivoting::complete);
    const Candidate candidate{columns, e.rank() < columns.size() ? 0 : e.smallest_pivot()};
    if (candidate.quality >= good_chart) result.push_back(candidate);
    if (candidate.quality > best.quality) best = candidate;
  }
  if (result.empty()) result.push_back(best);
  return result;
}

Chart chart_of(const Flow& flow, const Places& positions, const Places& speeds) {
  const std::size_t n = flow.coordinates();
  Chart chart;
  chart.dependent = positions;
  for (const std::size_t v : speeds) chart.dependent.push_back(n + v);
  chart.independent = without(all_of(0, flow.entries()), chart.dependent);
  chart.positions = n - positions.size();
  chart.first_order = flow.entries() - eom::StateLayout{n}.first_order_begin();
  return chart;
}

template <class T>
using Pattern = std::vector<std::vector<bool>>;

/// Marks entries that are nonzero at one of the points or more.
template <class T>
void join(Pattern<T>& pattern, const Matrix<T>& A, const T& small) {
  pattern.resize(A.rows, std::vector<bool>(A.cols, false));
  T largest(0);
  for (const T& x : A.a) largest = std::max(largest, magnitude(x));
  for (std::size_t i = 0; i < A.rows; ++i) {
    for (std::size_t j = 0; j < A.cols; ++j) pattern[i][j] = pattern[i][j] || magnitude(A(i, j)) > small * largest;
  }
}

/// Drops positions, pure integrals among the states of first order, and the time if no retained entry depends on them.
template <class T>
std::vector<bool> retained_of(const Pattern<T>& depends, std::size_t positions, std::size_t first_order) {
  const std::size_t size = depends.size();
  std::vector<bool> retained(size + 1, true);
  for (std::size_t k = 0; k < positions; ++k) retained[k] = false;
  for (std::size_t k = size - first_order; k < size; ++k) retained[k] = depends[k][k];
  retained[size] = false;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t k = 0; retained[j] && k <= size; ++k) {
        if (!depends[j][k] || retained[k]) continue;
        retained[k] = changed = true;
      }
    }
  }
  return retained;
}

template <class T>
std::vector<bool> retained_in(const std::vector<Field<T>>& fields, const Chart& chart, const T& small) {
  Pattern<T> depends;
  for (const Field<T>& field : fields) join(depends, reduced_jacobian(field, chart, tangent(field, chart)), small);
  return retained_of<T>(depends, chart.positions, chart.first_order);
}

Field<double> rounded(const Field<Precise>& f) {
  return {rounded(f.X), rounded(f.jacobian), rounded(f.input_jacobian), rounded(f.phi), rounded(f.phi_jacobian)};
}

std::uint64_t hash_mix(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// Entries of z that depend on the retained ones alone.
Places constants(const std::vector<Field<Precise>>& fields, const Chart& chart, const std::vector<bool>& retained) {
  Pattern<Precise> depends;
  for (const Field<Precise>& field : fields) join(depends, tangent(field, chart), tiny<Precise>(50));
  Places result;
  for (std::size_t i = 0; i + 1 < depends.size(); ++i) {
    bool kept = true;
    for (std::size_t k = 0; k < retained.size(); ++k) kept = kept && (!depends[i][k] || retained[k]);
    if (kept) result.push_back(i);
  }
  return result;
}

Chart best_chart(const Flow& flow, const Field<Precise>& here, const std::vector<Field<Precise>>& fields) {
  const std::size_t n = flow.coordinates(), p = flow.position_constraint_count();
  const std::vector<Candidate> positions =
      candidates(columns_of(rows_of(here.phi_jacobian, all_of(0, p)), all_of(0, n)));
  const std::vector<Candidate> speeds =
      candidates(columns_of(rows_of(here.phi_jacobian, all_of(p, here.phi_jacobian.rows)),
                            all_of(n, eom::StateLayout{n}.first_order_begin())));
  std::vector<Field<double>> rough;
  for (const Field<Precise>& f : fields) rough.push_back(rounded(f));
  std::optional<std::tuple<std::size_t, std::size_t, double>> best;
  Chart result = chart_of(flow, positions.front().columns, speeds.front().columns);
  if (positions.size() * speeds.size() == 1) return result;
  std::size_t tried = 0;
  for (const Candidate& a : positions) {
    for (const Candidate& b : speeds) {
      if (++tried > most_charts) return result;
      const Chart chart = chart_of(flow, a.columns, b.columns);
      try {
        const std::vector<bool> retained = retained_in<double>(rough, chart, 1e-9);
        const auto count = static_cast<std::size_t>(std::count(retained.begin(), retained.end(), true));
        // Ties: prefer charts with the speeds of the retained coordinates, then the better conditioned (coarsely, so
        // that rounding does not decide), then those whose dependent entries come first in the model.
        const double quality = std::round(20 * std::min({a.quality, b.quality, well_conditioned}));
        const std::tuple<std::size_t, std::size_t, double> score{count, without(a.columns, b.columns).size(), -quality};
        if (best && !(score < *best)) continue;
        best = score;
        result = chart;
      } catch (const std::domain_error&) {
        continue;  // singular at a nearby point
      }
    }
  }
  return result;
}

}  // namespace

double random_number(std::uint64_t seed, std::uint64_t index) {
  return 2 * (static_cast<double>(hash_mix(hash_mix(seed) + index) >> 11) / 9007199254740992.0) - 1;
}

std::vector<std::size_t> ignorable_entries(const Symmetry& s) {
  Places result;
  for (std::size_t k = 0; k < s.chart.independent.size(); ++k) {
    if (!s.retained[k]) result.push_back(s.chart.independent[k]);
  }
  return result;
}

template <class T>
Matrix<T> tangent(const Field<T>& field, const Chart& chart) {
  Places columns = chart.independent;
  columns.push_back(field.jacobian.cols - 1);  // t
  Matrix<T> result(field.jacobian.cols, columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k) result(columns[k], k) = T(1);
  if (chart.dependent.empty()) return result;
  const Elimination<T> solver(columns_of(field.phi_jacobian, chart.dependent), tiny<T>(10));
  require_domain(solver.rank() == chart.dependent.size(), "the constraints do not determine the dependent coordinates");
  const Matrix<T> jacobian = solver.solve(columns_of(field.phi_jacobian, columns));
  for (std::size_t i = 0; i < chart.dependent.size(); ++i) {
    for (std::size_t k = 0; k < columns.size(); ++k) result(chart.dependent[i], k) = -jacobian(i, k);
  }
  return result;
}

template <class T>
Matrix<T> reduced_jacobian(const Field<T>& field, const Chart& chart, const Matrix<T>& tangent) {
  return rows_of(field.jacobian, chart.independent) * tangent;
}

template Matrix<double> tangent(const Field<double>&, const Chart&);
template Matrix<Precise> tangent(const Field<Precise>&, const Chart&);
template Matrix<double> reduced_jacobian(const Field<double>&, const Chart&, const Matrix<double>&);
template Matrix<Precise> reduced_jacobian(const Field<Precise>&, const Chart&, const Matrix<Precise>&);

std::optional<State<Precise>> project_onto_constraints(const Flow& flow, const State<Precise>& z,
                                                       const Setting<Precise>& setting) {
  return project_onto_constraints(flow, z, setting, all_of(0, 2 * flow.coordinates()));
}

std::optional<State<Precise>> project_onto_constraints(const Flow& flow, State<Precise> z,
                                                       const Setting<Precise>& setting, const Places& columns) {
  std::optional<State<Precise>> found = move_onto_constraints(flow, std::move(z), setting, columns);
  if (found) flow.at(*found, setting);  // throws
  return found;
}

std::optional<State<Precise>> move_onto_constraints(const Flow& flow, State<Precise> z, const Setting<Precise>& setting,
                                                    const Places& columns) {
  constexpr int most_steps = 60, exact = 120;
  for (int step = 0; step < most_steps; ++step) {
    const Field<Precise> field = flow.constraints_at(z, setting);
    const Matrix<Precise> move =
        Elimination<Precise>(columns_of(field.phi_jacobian, columns), tiny<Precise>(8), tiny<Precise>(14))
            .solve(field.phi);
    bool done = true;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      z[columns[i]] = z[columns[i]] - move(i, 0);
      done = done && magnitude(move(i, 0)) <= tiny<Precise>(exact) * (Precise(1) + magnitude(z[columns[i]]));
    }
    if (done) return z;
  }
  return std::nullopt;
}

std::optional<State<Precise>> nearby_state(const Flow& flow, const State<Precise>& z, Setting<Precise>& setting,
                                           std::uint64_t seed) {
  double size = reach;
  for (int attempt = 0; attempt < 8; ++attempt, size /= 2) {
    State<Precise> moved = z;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double offset = size * random_number(seed, 64 * i + static_cast<std::size_t>(attempt));
      moved[i] = moved[i] + number<Precise>(Precise(offset)) * (Precise(1) + magnitude(z[i]));
    }
    try {
      setting.leaf = flow.leaf(moved, setting);
      if (auto found = project_onto_constraints(flow, moved, setting)) return found;
    } catch (const std::domain_error&) {
      continue;  // outside of a domain: try a nearer point
    }
  }
  return std::nullopt;
}

Symmetry find_symmetry(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting, std::uint64_t seed) {
  std::vector<Field<Precise>> fields;
  for (int k = 0; k < sample_points; ++k) {
    Setting<Precise> other = setting;
    const auto point = nearby_state(flow, z, other, 1000 * seed + static_cast<std::uint64_t>(k));
    require_domain(point.has_value(), "no points beside it satisfy the constraints");
    fields.push_back(flow.at(*point, other));
  }
  Symmetry result;
  result.chart = best_chart(flow, flow.at(z, setting), fields);
  std::vector<bool> retained = retained_in<Precise>(fields, result.chart, tiny<Precise>(50));
  result.constant = constants(fields, result.chart, retained);
  result.autonomous = !retained.back() && !flow.uses_integrals();
  retained.pop_back();
  result.retained = std::move(retained);
  return result;
}

}  // namespace eomgen::linear
