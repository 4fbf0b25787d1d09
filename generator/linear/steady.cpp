// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/steady.hpp"

#include <algorithm>

#include "numeric/numbers.hpp"

namespace eomgen::linear {
namespace {

struct PreciseEquations {
  Matrix<Precise> value, jacobian;
};

void add(PreciseEquations& e, const Matrix<Precise>& value, const Matrix<Precise>& jacobian) {
  e.value = stacked(std::move(e.value), value);
  e.jacobian = stacked(std::move(e.jacobian), jacobian);
}

PreciseEquations steady_equations(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                  const State<Precise>& start, const Setting<Precise>& setting,
                                  const ExtraEquations& extra) {
  const Field<Precise> field = flow.at(z, setting);
  PreciseEquations e{field.phi, field.phi_jacobian};
  e.jacobian.cols = field.phi_jacobian.cols;
  add(e, rows_of(field.X, symmetry.constant), rows_of(field.jacobian, symmetry.constant));
  for (const std::size_t i : ignorable_entries(symmetry)) {
    Matrix<Precise> value(1, 1), jacobian(1, field.jacobian.cols);
    value(0, 0) = z[i] - start[i];
    jacobian(0, i) = Precise(1);
    add(e, value, jacobian);
  }
  if (extra) {
    Matrix<Precise> value, jacobian;
    extra(z, value, jacobian);
    if (value.rows > 0) add(e, value, jacobian);
  }
  return e;
}

/// The magnitude of the terms of an equation, estimated from its derivatives.
Precise size_of(const PreciseEquations& e, std::size_t i, const State<Precise>& z) {
  Precise size(1);
  for (std::size_t j = 0; j < e.jacobian.cols; ++j)
    size = size + magnitude(e.jacobian(i, j)) * (Precise(1) + magnitude(z[j]));
  return size;
}

/// Whether every equation holds to so many digits, relative to the magnitude of its terms.
bool is_satisfied(const PreciseEquations& e, const State<Precise>& z, int digits_of_it = 90) {
  for (std::size_t i = 0; i < e.value.rows; ++i) {
    if (magnitude(e.value(i, 0)) > tiny<Precise>(digits_of_it) * size_of(e, i, z)) return false;
  }
  return true;
}

/// Rank tolerances for pivots and for rows or columns, as powers of 1/10.
struct Rank {
  int cutoff, floor;
};

/// Moves z onto the constraints. Off them, redundant constraints of a closed loop are independent, and accelerations
/// are not determined.
State<Precise> on_constraints(const Flow& flow, const State<Precise>& z, const Setting<Precise>& setting) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) columns.push_back(i);
  return move_onto_constraints(flow, z, setting, columns).value_or(z);
}

/// Relative to 1 and the magnitude of the entry; the largest over all entries.
Precise largest_move(const Matrix<Precise>& move, const State<Precise>& z) {
  Precise largest(0);
  for (std::size_t i = 0; i + 1 < z.size(); ++i)
    largest = std::max(largest, magnitude(move(i, 0)) / (Precise(1) + magnitude(z[i])));
  return largest;
}

std::optional<State<Precise>> newton(const Flow& flow, const Symmetry& symmetry, const State<Precise>& start,
                                     const Setting<Precise>& setting, const ExtraEquations& extra, const Rank& rank,
                                     double farthest) {
  constexpr int most_steps = 40, exact = 120;
  constexpr int patience = 4;  // starts are near a root: then a step of more than 1/10 means that there is none
  constexpr int most_repetitions = 12;  // of a step that the return to the constraints takes back
  State<Precise> z = start;
  const Precise limit = number<Precise>(numeric::exact(farthest));
  Precise last(0);
  int repetitions = 0;
  for (int step = 0; step < most_steps; ++step) {
    z = on_constraints(flow, z, setting);
    PreciseEquations e = steady_equations(flow, symmetry, z, start, setting, extra);
    for (std::size_t i = 0; i < e.jacobian.rows; ++i) e.jacobian(i, e.jacobian.cols - 1) = Precise(0);  // t stays
    const Matrix<Precise> move =
        Elimination<Precise>(e.jacobian, tiny<Precise>(rank.cutoff), tiny<Precise>(rank.floor)).solve(e.value);
    const Precise size = largest_move(move, z);
    if (step >= patience && size > Precise(1) / 10) return std::nullopt;
    repetitions = magnitude(size - last) < size / 1000 ? repetitions + 1 : 0;
    if (repetitions == most_repetitions) return std::nullopt;
    last = size;
    bool done = true;
    for (std::size_t i = 0; i + 1 < z.size(); ++i) {
      z[i] = z[i] - move(i, 0);
      if (magnitude(z[i] - start[i]) > limit * (Precise(1) + magnitude(start[i]))) return std::nullopt;
      done = done && magnitude(move(i, 0)) <= tiny<Precise>(exact) * (Precise(1) + magnitude(z[i]));
    }
    if (done) return is_satisfied(e, z) ? std::optional(z) : std::nullopt;  // before the last step, far below tolerance
  }
  return std::nullopt;
}

/// The input of Newton's iteration near a root.
struct Problem {
  const Flow& flow;
  const Symmetry& symmetry;
  const State<Precise>& start;
  const Setting<Precise>& setting;
  const ExtraEquations& extra;

  PreciseEquations at(const State<Precise>& z) const {
    PreciseEquations e = steady_equations(flow, symmetry, z, start, setting, extra);
    for (std::size_t i = 0; i < e.jacobian.rows; ++i) e.jacobian(i, e.jacobian.cols - 1) = Precise(0);  // t stays
    return e;
  }
};

Precise inner(const Matrix<Precise>& a, const Matrix<Precise>& b, const State<Precise>& z) {
  Precise sum(0);
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    const Precise scale = Precise(1) + magnitude(z[i]);
    sum = sum + a(i, 0) * b(i, 0) / (scale * scale);
  }
  return sum;
}

// At a root of multiplicity m, Newton steps shrink by 1 - 1/m each. Once the ratio is constant, the remaining distance
// is their geometric sum.
std::optional<SteadyState> multiple_root(const Problem& p) {
  constexpr int most_steps = 400, exact = 130, cutoff = 130, floor = 150;
  State<Precise> z = p.start;
  std::optional<Matrix<Precise>> before;
  Precise ratio_before(0);
  for (int step = 0; step < most_steps; ++step) {
    const PreciseEquations e = p.at(z);
    const Matrix<Precise> move =
        Elimination<Precise>(e.jacobian, tiny<Precise>(cutoff), tiny<Precise>(floor)).solve(e.value);
    const Precise size = largest_move(move, z);
    if (step > 0 && is_satisfied(e, z, exact)) {
      const double digits_of_z = -to_double(cln::ln(size + tiny<Precise>(known_digits))) / std::log(10.0) - 2;
      return SteadyState{z, 0, std::clamp(static_cast<int>(digits_of_z), 20, known_digits)};
    }
    if (size > Precise(1) / 100) return std::nullopt;
    Precise factor(1);
    const Precise last = before ? inner(*before, *before, z) : Precise(0);
    if (cln::plusp(last)) {
      const Precise ratio = inner(move, *before, z) / last;
      const bool settled =
          magnitude(ratio - ratio_before) < Precise(1) / 50 && ratio > Precise(1) / 4 && ratio < Precise(97) / 100;
      ratio_before = ratio;
      if (settled) factor = Precise(1) / (Precise(1) - ratio);
    }
    before = move;
    if (factor != Precise(1)) before.reset(), ratio_before = Precise(0);
    for (std::size_t i = 0; i + 1 < z.size(); ++i) z[i] = z[i] - factor * move(i, 0);
  }
  return std::nullopt;
}

/// The least relative change of the numbers of the setting with which each equation holds: the largest over the
/// equations.
Precise distance_in_numbers(const Problem& p, const State<Precise>& z) {
  const PreciseEquations e = p.at(z);
  const Precise change = tiny<Precise>(50);
  std::vector<Precise> moved_by(e.value.rows, Precise(0));
  const auto add = [&](std::vector<Precise> Setting<Precise>::*list) {
    for (std::size_t k = 0; k < (p.setting.*list).size(); ++k) {
      if (is_zero((p.setting.*list)[k])) continue;
      Setting<Precise> other = p.setting;
      (other.*list)[k] = (other.*list)[k] * (Precise(1) + change);
      const PreciseEquations there = steady_equations(p.flow, p.symmetry, z, p.start, other, p.extra);
      for (std::size_t i = 0; i < moved_by.size(); ++i)
        moved_by[i] = moved_by[i] + magnitude(there.value(i, 0) - e.value(i, 0)) / change;
    }
  };
  add(&Setting<Precise>::parameters);
  add(&Setting<Precise>::inputs);
  Precise largest(0);
  for (std::size_t i = 0; i < moved_by.size(); ++i) {
    const Precise value = magnitude(e.value(i, 0));
    if (value <= tiny<Precise>(90) * size_of(e, i, z)) continue;
    if (!(moved_by[i] > value)) return Precise(1);
    largest = std::max(largest, value / moved_by[i]);
  }
  return largest;
}

// Least squares of the equations: the minimum is 0 up to rounding of the given numbers.
std::optional<SteadyState> rounded_root(const Problem& p) {
  constexpr int most_steps = 60, exact = 100;
  constexpr double roundings = 1e-12;
  State<Precise> z = p.start;
  for (int step = 0; step < most_steps; ++step) {
    PreciseEquations e = p.at(z);
    for (std::size_t i = 0; i < e.value.rows; ++i) {
      const Precise size = size_of(e, i, z);
      e.value(i, 0) = e.value(i, 0) / size;
      for (std::size_t j = 0; j < e.jacobian.cols; ++j) e.jacobian(i, j) = e.jacobian(i, j) / size;
    }
    const Matrix<Precise> back = transposed(e.jacobian);
    const Matrix<Precise> move =
        Elimination<Precise>(back * e.jacobian, tiny<Precise>(10), tiny<Precise>(14)).solve(back * e.value);
    for (std::size_t i = 0; i + 1 < z.size(); ++i) z[i] = z[i] - move(i, 0);
    const Precise size = largest_move(move, z);
    if (size > Precise(1) / 100) return std::nullopt;
    if (size > tiny<Precise>(exact)) continue;
    const double off = to_double(distance_in_numbers(p, z));
    return off < roundings ? std::optional(SteadyState{z, off, known_digits}) : std::nullopt;
  }
  return std::nullopt;
}

// Sets entries to 0 that are 0 up to the error of the iteration.
void snap_to_zero(const Problem& p, SteadyState& found) {
  State<Precise> z = found.z;
  bool changed = false;
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    if (is_zero(z[i]) || magnitude(z[i]) > tiny<Precise>(std::min(40, found.known / 2))) continue;
    z[i] = number<Precise>(Precise(0));
    changed = true;
  }
  if (!changed || found.parameter_change > 0) return;
  try {
    if (!is_satisfied(p.at(z), z, 120)) return;
    found.z = z;
  } catch (const std::domain_error&) {
    return;
  }
}

}  // namespace

// In a family of steady motions the Jacobian is rank-deficient there, and nearly so nearby: such pivots count as 0. If
// that drops a needed equation, the iteration does not converge, and smaller pivots count.
std::optional<State<Precise>> solve_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                                 const Setting<Precise>& setting, const ExtraEquations& extra,
                                                 double farthest) {
  for (const Rank rank : {Rank{5, 11}, Rank{10, 14}, Rank{20, 30}}) {
    try {
      if (auto found = newton(flow, symmetry, z, setting, extra, rank, farthest)) return found;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return std::nullopt;
}

std::optional<SteadyState> find_steady_state(const Flow& flow, const Symmetry& symmetry, const State<Precise>& z,
                                             const Setting<Precise>& setting, const ExtraEquations& extra,
                                             double farthest) {
  constexpr int near = 7;     // digits of the equations where such a root is sought
  constexpr int exact = 140;  // and after convergence to a simple root
  std::optional<SteadyState> found;
  State<Precise> start = z;
  if (const auto plain = solve_steady_state(flow, symmetry, z, setting, extra, farthest)) {
    found = SteadyState{*plain, 0, known_digits};
    start = *plain;
  }
  const Problem p{flow, symmetry, start, setting, extra};
  try {
    const PreciseEquations e = p.at(start);
    if (found ? !is_satisfied(e, start, exact) : is_satisfied(e, start, near)) {
      if (const auto root = multiple_root(p)) found = root;
    }
    if (!found && is_satisfied(e, start, near)) found = rounded_root(p);
  } catch (const std::domain_error&) {  // at the new point; keep the plain root
  }
  if (found) snap_to_zero(p, *found);
  return found;
}

}  // namespace eomgen::linear
