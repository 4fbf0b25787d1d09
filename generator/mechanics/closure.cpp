// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/closure.hpp"

#include <cln/float.h>
#include <cln/rational.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "mechanics/imposition.hpp"
#include "mechanics/pfaffian.hpp"
#include "mechanics/small.hpp"
#include "numeric/dense.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;

constexpr int digits = 50;
constexpr int steps = 120;             // near dependent rows, Newton steps halve the distance down to `dependent`
constexpr double dependent = 1e-6;     // rows closer to dependence deflect steps
constexpr int closed_digits = 38;      // |psi| of a configuration
constexpr double longest_step = 0.7;   // of a coordinate, in units of its scale: angles of 40 degrees
constexpr double stride = 0.25;        // between configurations of a motion, in the same units
constexpr double other_values = 0.04;  // how far parameters are varied, relative

constexpr int plain_steps = 40;               // of Newton's method in binary64
constexpr double plain_tolerance = 1e-10;     // of psi in binary64
constexpr double plainly_independent = 1e-7;  // a row's part outside the span of the others

cl_R exact(double value) { return cln::cl_float(numeric::exact(value), cln::float_format(digits)); }

using numeric::is_zero;
using std::sqrt;

template <class T>
T dot(const std::vector<T>& a, const std::vector<T>& b) {
  T sum(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!is_zero(a[i]) && !is_zero(b[i])) sum = sum + a[i] * b[i];  // most entries are 0
  }
  return sum;
}

std::vector<std::vector<double>> rounded(const std::vector<Row>& rows) {
  const cl_R nothing = small(300);
  std::vector<std::vector<double>> result(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (const cl_R& x : rows[k]) result[k].push_back(cln::abs(x) < nothing ? 0 : cln::double_approx(x));
  }
  return result;
}

bool is_angle(const model::Unit& unit) { return unit.text == "rad" || unit.text == "1"; }

/// Scales of the coordinates: one for each unit; 1 for angles.
std::vector<double> scales(const Mechanics& m, const std::vector<cl_R>& q) {
  std::vector<double> result;
  for (const model::Coordinate& c : m.model->coordinates) {
    double size = 0;
    for (std::size_t k = 0; k < q.size(); ++k) {
      if (m.model->coordinates[k].unit.text == c.unit.text) size = std::max(size, std::abs(cln::double_approx(q[k])));
    }
    result.push_back(is_angle(c.unit) || size == 0 ? 1 : size);
  }
  return result;
}

/// `vanishing`: the length below which a row counts as 0 and is nonzero only because the constraints hold
/// approximately.
template <class T>
RowSelection select_rows(const std::vector<std::vector<T>>& rows, const std::vector<RowPriority>& priorities,
                         const T& tolerance, const T& vanishing, const T& hair) {
  std::vector<std::vector<T>> left = rows;
  std::vector<T> length, outside;  // of each row, and of its part outside the span of the used rows
  for (const auto& row : rows) length.push_back(sqrt(dot(row, row)));
  outside = length;
  std::vector<bool> used(rows.size(), false);
  RowSelection result;
  for (const RowPriority priority : {RowPriority::always, RowPriority::first, RowPriority::last}) {
    for (;;) {
      std::optional<std::size_t> best;
      T largest = tolerance;
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (used[k] || priorities[k] != priority || length[k] < vanishing) continue;
        const T part = outside[k] / length[k];
        // Equal parts of different rows differ by rounding; a small margin favours the first.
        if (part > largest * hair) largest = part, best = k;
      }
      if (!best) break;
      used[*best] = true;
      const std::vector<T> chosen = left[*best];
      const T square = dot(chosen, chosen);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        if (used[k]) continue;
        std::vector<T>& row = left[k];
        const T along = dot(row, chosen);
        if (is_zero(along)) continue;
        const T factor = along / square;
        for (std::size_t i = 0; i < row.size(); ++i) {
          if (!is_zero(chosen[i])) row[i] = row[i] - factor * chosen[i];
        }
        outside[k] = sqrt(dot(row, row));
      }
    }
  }
  for (std::size_t k = 0; k < rows.size(); ++k) (used[k] ? result.selected : result.rest).push_back(k);
  return result;
}

}  // namespace

RowSelection select_independent(const std::vector<Row>& rows, const std::vector<RowPriority>& priorities,
                                const cl_R& tolerance) {
  return select_rows<cl_R>(rows, priorities, tolerance, small(25), cl_R(cln::cl_RA(1000001) / 1000000));
}

ClosureSolver::ClosureSolver(Mechanics& m, Lowering& lower) : m_(m), lower_(lower) {
  symbolic::Substitution written = time_function_substitution(m);
  for (const JointReaction& joint : m.joints) {
    for (const auto& direction : joint.along)
      reaction_directions_.insert(reaction_directions_.end(), direction.begin(), direction.end());
  }
  for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
    const Constraint& c = m.constraints[k];
    for (const Ref slope : c.gradient) all_.push_back(written(slope));
    rates_.push_back(written(c.rate));
    if (!c.holonomic() || c.unilateral || c.redundancy == Redundancy::identity) continue;
    bound_.push_back(k);
    psi_.push_back(written(c.psi));
    gradient_.insert(gradient_.end(), all_.end() - static_cast<std::ptrdiff_t>(m.q.size()), all_.end());
  }
}

std::vector<cl_R> ClosureSolver::values(const std::vector<Ref>& expressions, const Configuration& at) const {
  const auto lookup = [&](const Symbol& s) -> cl_R {
    switch (s.kind) {
      case SymbolKind::parameter: return at.parameters.at(s.index);
      case SymbolKind::coordinate:
        if (s.order > 0) throw std::domain_error("a velocity");
        return at.q.at(s.index);
      case SymbolKind::time: return at.t;
      case SymbolKind::integral: return exact(0);  // integrals start at 0
      default: throw std::domain_error("no value");
    }
  };
  return symbolic::evaluate(*m_.dag, expressions, lookup, digits);
}

std::vector<Row> ClosureSolver::jacobian_rows(const Configuration& at) const {
  const std::vector<cl_R> entries = values(all_, at);
  std::vector<Row> result;
  for (std::size_t k = 0; k < m_.constraints.size(); ++k) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(k * m_.q.size());
    result.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(m_.q.size()));
  }
  return result;
}

double ClosureSolver::uniform(std::uint64_t& state) const {  // in (-1, 1)
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 11) / 4503599627370496.0 - 1;
}

// Parameters as given by the file and the default scene; with a seed, independent ones are varied.
void ClosureSolver::set_parameters(Configuration& at, std::uint64_t seed) const {
  const model::Model& model = *m_.model;
  std::vector<Ref> value = m_.parameter_value;
  std::vector<bool> known(value.size(), false);
  for (const auto& [index, node] : model.scenes.front().parameters) value[index] = lower_.scalar(node);
  at.parameters.assign(value.size(), exact(0));
  const std::function<void(std::uint32_t)> settle_one = [&](std::uint32_t i) {
    if (known[i]) return;
    known[i] = true;
    const std::vector<Symbol> others = m_.dag->symbols({value[i]});
    for (const Symbol& other : others) {
      if (other.kind == SymbolKind::parameter) settle_one(other.index);
    }
    at.parameters[i] = values({value[i]}, at)[0];
    if (!others.empty() || seed == 0 || model.parameters[i].initial_value_of || model.start_time == i) return;
    std::uint64_t state = seed * 977 + i;
    uniform(state);
    const double by = other_values * uniform(state);  // also for parameters that are 0
    at.parameters[i] = cln::zerop(at.parameters[i]) ? exact(by) : at.parameters[i] * exact(1 + by);
  };
  for (std::uint32_t i = 0; i < value.size(); ++i) settle_one(i);
}

/// The values that the default scene gives; their entries of `open` become false. The others are 0.
Configuration ClosureSolver::given(std::vector<bool>& open) const {
  const model::Scene& scene = m_.model->scenes.front();
  Configuration at;
  at.q.assign(m_.q.size(), exact(0));
  open.assign(m_.q.size(), true);
  set_parameters(at, 0);
  at.t = values({lower_.scalar(scene.t0)}, at)[0];
  symbolic::Substitution written = time_function_substitution(m_);
  for (const auto* list : {&scene.guess, &scene.initial}) {
    for (const model::InitialValue& given : *list) {
      if (given.order > 0) continue;
      at.q[given.coordinate] = values({written(lower_.scalar(given.value))}, at)[0];
      if (list == &scene.initial) open[given.coordinate] = false;
    }
  }
  for (std::uint32_t i = 0; i < at.parameters.size(); ++i) {
    if (const auto& q = m_.model->parameters[i].initial_value_of) at.parameters[i] = at.q[*q];
  }
  return at;
}

bool ClosureSolver::is_regular() {
  const auto n = static_cast<Eigen::Index>(m_.q.size()), count = static_cast<Eigen::Index>(psi_.size());
  std::vector<Ref> roots = psi_;
  roots.insert(roots.end(), gradient_.begin(), gradient_.end());
  try {
    std::vector<bool> open;
    const Configuration start = given(open);
    std::vector<double> q, parameters;
    for (const cl_R& x : start.q) q.push_back(cln::double_approx(x));
    for (const cl_R& x : start.parameters) parameters.push_back(cln::double_approx(x));
    const double t = cln::double_approx(start.t);
    const auto lookup = [&](const Symbol& s) {
      switch (s.kind) {
        case SymbolKind::parameter: return parameters[s.index];
        case SymbolKind::coordinate: return s.order > 0 ? std::nan("") : q[s.index];
        case SymbolKind::time: return t;
        case SymbolKind::integral: return 0.0;
        default: return std::nan("");
      }
    };
    const auto matrix = [&](const std::vector<double>& v, std::size_t from, Eigen::Index rows) {
      return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(v.data() + from,
                                                                                                      rows, n)
          .eval();
    };
    bool closed = count == 0;
    for (int step = 0; step < plain_steps && !closed; ++step) {
      const std::vector<double> v = symbolic::evaluate(*m_.dag, roots, lookup);
      const Eigen::VectorXd psi = Eigen::Map<const Eigen::VectorXd>(v.data(), count);
      Eigen::MatrixXd A = matrix(v, psi_.size(), count);
      if (!psi.allFinite() || !A.allFinite()) return false;
      closed = psi.cwiseAbs().maxCoeff() <= plain_tolerance * std::max(1.0, A.cwiseAbs().maxCoeff());
      for (Eigen::Index i = 0; i < n; ++i) {
        if (!open[static_cast<std::size_t>(i)]) A.col(i).setZero();
      }
      const Eigen::VectorXd move = numeric::least_squares(A, psi).x;
      for (Eigen::Index i = 0; i < n && !closed; ++i) q[static_cast<std::size_t>(i)] -= move(i);
    }
    if (!closed) return false;
    const std::vector<double> v = symbolic::evaluate(*m_.dag, all_, lookup);
    Eigen::MatrixXd A = matrix(v, 0, static_cast<Eigen::Index>(m_.constraints.size()));
    if (!A.allFinite()) return false;
    for (Eigen::Index k = A.rows(); k-- > 0;) {
      const Constraint& c = m_.constraints[static_cast<std::size_t>(k)];
      const double length = A.row(k).norm();
      if (c.unilateral || c.redundancy != Redundancy::independent) {
        if (k + 1 < A.rows()) A.row(k) = A.row(A.rows() - 1).eval();
        A.conservativeResize(A.rows() - 1, Eigen::NoChange);
      } else if (length == 0) {
        return false;
      } else {
        A.row(k) /= length;
      }
    }
    if (A.rows() == 0) return true;  // contacts alone, which may be open
    return numeric::rank(A.transpose(), plainly_independent) == A.rows();
  } catch (const std::exception&) {  // outside the domain of a function
    return false;
  }
}

std::optional<Configuration> ClosureSolver::start_configuration() {
  std::vector<bool> open;
  const std::vector<bool> all(m_.q.size(), true);
  inconsistency_ = 0;
  try {
    const Configuration at = given(open);
    // If the derivatives vanish at 0 in the coordinates that are not given, start from a nearby point.
    Configuration found = at;
    if (solve_constraints(found, open)) return found;
    const double gap = inconsistency_;
    const std::uint32_t gap_at = inconsistent_constraint_;
    found = at;
    if (solve_constraints(found, all)) return found;
    if (gap > 0) inconsistency_ = gap, inconsistent_constraint_ = gap_at;
  } catch (const std::exception&) {  // outside the domain of a function
  }
  return std::nullopt;
}

std::optional<Configuration> ClosureSolver::nearby_configuration(const Configuration& from, std::uint64_t seed,
                                                                 bool other_parameters) {
  const std::vector<double> scale = scales(m_, from.q);
  const std::vector<bool> all(m_.q.size(), true);
  inconsistency_ = 0;
  for (double spread : {0.2, 0.1, 0.05, 0.02}) {
    Configuration at = from;
    std::uint64_t state = seed;
    try {
      if (other_parameters) set_parameters(at, seed);
      for (std::size_t i = 0; i < at.q.size(); ++i) at.q[i] = at.q[i] + exact(spread * scale[i] * uniform(state));
      if (solve_constraints(at, all)) return at;
    } catch (const std::exception&) {  // outside the domain of a function
    }
  }
  return std::nullopt;
}

std::optional<Configuration> ClosureSolver::extrapolated_configuration(const Configuration& before,
                                                                       const Configuration& at) {
  const std::vector<double> scale = scales(m_, at.q);
  double largest = 0;
  std::vector<double> way;
  for (std::size_t i = 0; i < at.q.size(); ++i) {
    way.push_back(cln::double_approx(at.q[i] - before.q[i]));
    largest = std::max(largest, std::abs(way[i]) / scale[i]);
  }
  if (largest == 0) return std::nullopt;
  Configuration next = at;
  for (std::size_t i = 0; i < at.q.size(); ++i) next.q[i] = next.q[i] + exact(stride / largest * way[i]);
  try {
    if (solve_constraints(next, std::vector<bool>(m_.q.size(), true))) return next;
  } catch (const std::exception&) {  // outside the domain of a function
  }
  return std::nullopt;
}

// Newton's method with least-norm steps, on rows that are clearly independent here. Rows that look dependent must hold
// at the end.
bool ClosureSolver::solve_constraints(Configuration& at, const std::vector<bool>& moves) {
  const std::size_t n = m_.q.size(), count = psi_.size();
  const std::vector<double> scale = scales(m_, at.q);
  const std::vector<RowPriority> none(count, RowPriority::last);
  std::vector<Ref> roots = psi_;
  roots.insert(roots.end(), gradient_.begin(), gradient_.end());
  for (int step = 0; step < steps; ++step) {
    const std::vector<cl_R> v = values(roots, at);
    std::vector<Row> rows(count, Row(n, exact(0)));
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < n; ++i) {
        if (moves[i]) rows[k][i] = v[count + k * n + i] * exact(scale[i]);
      }
    }
    const RowSelection chosen = select_rows<double>(rounded(rows), none, dependent, 1e-25, 1.000001);
    cl_R size = 0, rest = 0;
    for (const std::size_t k : chosen.selected) size = cln::max(size, cln::abs(v[k]));
    for (const std::size_t k : chosen.rest) {
      if (cln::abs(v[k]) > rest) rest = cln::abs(v[k]), inconsistent_constraint_ = bound_[k];
    }
    if (size < small(closed_digits)) {
      inconsistency_ = rest > small(closed_digits - 8) ? cln::double_approx(rest) : 0;
      if (inconsistency_ != 0) return false;
      // Evaluates all other expressions used here: throws if one has no value.
      for (const auto* others : {&all_, &rates_, &reaction_directions_}) values(*others, at);
      return true;
    }
    const std::size_t r = chosen.selected.size();
    std::vector<std::vector<cl_R>> gram(r, std::vector<cl_R>(r));
    std::vector<cl_R> right, y;
    for (std::size_t a = 0; a < r; ++a) {
      for (std::size_t b = 0; b < r; ++b) gram[a][b] = dot(rows[chosen.selected[a]], rows[chosen.selected[b]]);
      right.push_back(v[chosen.selected[a]]);
    }
    if (!solve_small(gram, right, y)) return false;
    Row move(n, exact(0));
    cl_R longest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t a = 0; a < r; ++a) {
        const cl_R& slope = rows[chosen.selected[a]][i];
        if (!cln::zerop(slope)) move[i] = move[i] - slope * y[a];
      }
      longest = cln::max(longest, cln::abs(move[i]));
    }
    const cl_R shorten = longest > exact(longest_step) ? exact(longest_step) / longest : exact(1);
    for (std::size_t i = 0; i < n; ++i) at.q[i] = at.q[i] + shorten * move[i] * exact(scale[i]);
  }
  return false;
}

}  // namespace eomgen::mechanics
