// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/pfaffian.hpp"

#include <cln/float.h>
#include <cln/rational.h>

#include <algorithm>

#include "mechanics/imposition.hpp"
#include "mechanics/small.hpp"
#include "numeric/elimination.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"
#include "symbolic/zero_proof.hpp"

namespace eomgen::mechanics {
namespace {

constexpr int sample_digits = 50, agreed_digits = 30;
constexpr std::size_t wanted_points = 4, tried_points = 40;
constexpr std::size_t form_terms = 300;
constexpr std::size_t most_effort = 1000000;  // products of terms: a few tenths of a second

/// A random value with all digits set, so that sums of values have them too.
cln::cl_R value_at(const Symbol& symbol, std::uint64_t point) {
  return cln::cl_float(cln::cl_R(symbolic::sample(symbol, point)), cln::float_format(sample_digits));
}

/// Replaces dependent parameters by their expressions, in as many rounds as the longest chain may need.
symbolic::Substitution independent_parameters(const Mechanics& m) {
  std::map<Symbol, Ref> values;
  for (std::uint32_t i = 0; i < m.parameter_value.size(); ++i) {
    if (!m.dag->symbols({m.parameter_value[i]}).empty()) values[{SymbolKind::parameter, i, 0}] = m.parameter_value[i];
  }
  for (std::size_t round = 0; round < m.parameter_value.size(); ++round) {
    symbolic::Substitution substitute(*m.dag, values);
    for (auto& entry : values) entry.second = substitute(entry.second);
  }
  return {*m.dag, std::move(values)};
}

}  // namespace

bool solve_small(const std::vector<std::vector<cln::cl_R>>& A, const std::vector<cln::cl_R>& b,
                 std::vector<cln::cl_R>& x) {
  const std::size_t n = b.size();
  numeric::Matrix<cln::cl_R> matrix(n, n), side(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) matrix(i, j) = A[i][j];
    side(i, 0) = b[i];
  }
  const numeric::Elimination<cln::cl_R> factors(std::move(matrix), small(agreed_digits), numeric::Pivoting::complete);
  if (factors.rank() < n) return false;
  x = factors.solve(side).a;
  return true;
}

OneFormSpace::OneFormSpace(Mechanics& m, SampleSet samples)
    : m_(m),
      dag_(*m.dag),
      imposed_(constraint_substitution(m)),
      written_(time_function_substitution(m)),
      parameters_(independent_parameters(m)),
      effort_{most_effort} {
  for (const std::uint32_t i : m.free) variables_.push_back({SymbolKind::coordinate, i, 0});
  variables_.push_back({SymbolKind::time, 0, 0});
  for (const std::uint32_t k : m.active) {
    if (!m.constraints[k].holonomic()) continue;
    psi_.push_back(impose_and_expand(m.constraints[k].psi));
    gradient_.push_back(differential(psi_.back()));
  }
  for (std::uint64_t point = 0; point < tried_points && points_.size() < wanted_points; ++point) {
    std::map<Symbol, cln::cl_R> values;
    for (const Symbol& variable : variables_) values[variable] = value_at(variable, point);
    for (std::uint32_t i = 0; i < m.parameter_value.size(); ++i)
      values[{SymbolKind::parameter, i, 0}] = value_at({SymbolKind::parameter, i, 0}, point);
    if (samples == SampleSet::unrestricted || move_onto_constraints(values)) points_.push_back(std::move(values));
  }
}

Ref OneFormSpace::impose_and_expand(Ref expression) { return parameters_(written_(imposed_(expression))); }

OneForm OneFormSpace::one_form(const Constraint& constraint) {
  OneForm form;
  Ref rest = constraint.rate;
  for (const FixedCoordinate& fixed : m_.fixed) {
    rest = dag_.add(rest, dag_.mul(constraint.gradient[fixed.coordinate], fixed.rate));
  }
  for (const std::uint32_t i : m_.free) form.push_back(simpler(impose_and_expand(constraint.gradient[i])));
  form.push_back(simpler(impose_and_expand(rest)));
  return form;
}

OneForm OneFormSpace::differential(Ref psi) {
  OneForm form;
  for (std::size_t i = 0; i < variables_.size(); ++i) form.push_back(derivative(psi, i));
  return form;
}

Ref OneFormSpace::derivative(Ref f, std::size_t variable) {
  if (variables_[variable].kind != SymbolKind::time) return symbolic::partial_derivative(dag_, variables_[variable])(f);
  return impose_and_expand(symbolic::explicit_time_derivative(dag_, m_.model->functions.size())(f));
}

std::vector<cln::cl_R> OneFormSpace::values(const std::vector<Ref>& expressions, std::size_t point) const {
  return symbolic::evaluate(
      dag_, expressions, [&](const Symbol& symbol) { return value(symbol, point); }, sample_digits);
}

std::string OneFormSpace::keep_points_with_values(const std::vector<Ref>& expressions) {
  std::string reason;
  for (std::size_t point = points_.size(); point-- > 0;) {
    try {
      values(expressions, point);
    } catch (const std::domain_error& error) {
      reason = error.what();
      points_.erase(points_.begin() + static_cast<std::ptrdiff_t>(point));
    }
  }
  return reason;
}

cln::cl_R OneFormSpace::value(const Symbol& symbol, std::size_t point) const {
  const auto found = points_[point].find(symbol);
  return found == points_[point].end() ? value_at(symbol, point) : found->second;
}

// Newton's method with least-norm steps in the coordinates; t and parameters are fixed.
bool OneFormSpace::move_onto_constraints(std::map<Symbol, cln::cl_R>& point) const {
  if (psi_.empty()) return true;
  const std::size_t n = variables_.size() - 1, count = psi_.size();
  std::vector<Ref> roots = psi_;
  for (const OneForm& row : gradient_) roots.insert(roots.end(), row.begin(), row.end());
  try {
    for (int step = 0; step < 60; ++step) {
      const std::vector<cln::cl_R> v = symbolic::evaluate(
          dag_, roots, [&](const Symbol& s) { return point.at(s); }, sample_digits);
      const auto A = [&](std::size_t k, std::size_t i) -> const cln::cl_R& { return v[count + k * (n + 1) + i]; };
      std::vector<std::vector<cln::cl_R>> gram(count, std::vector<cln::cl_R>(count, cln::cl_R(0)));
      cln::cl_R size = 0;
      for (std::size_t k = 0; k < count; ++k) {
        size = cln::max(size, cln::abs(v[k]));
        for (std::size_t j = 0; j < count; ++j) {
          for (std::size_t i = 0; i < n; ++i) gram[k][j] = gram[k][j] + A(k, i) * A(j, i);
        }
      }
      if (size < small(sample_digits - 5)) return true;
      std::vector<cln::cl_R> y;
      if (!solve_small(gram, {v.begin(), v.begin() + static_cast<std::ptrdiff_t>(count)}, y)) return false;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < count; ++k) point[variables_[i]] = point[variables_[i]] - A(k, i) * y[k];
      }
    }
  } catch (const std::exception&) {  // outside the domain of a function, or far away
  }
  return false;
}

ZeroTestResult OneFormSpace::vanishing(Ref expression) {
  if (dag_.is_zero(expression)) return ZeroTestResult::proven;
  if (!effort_.consume(dag_.reachable({expression}).size())) return ZeroTestResult::unknown;
  bool is_decided = false;
  for (std::size_t point = 0; point < points_.size(); ++point) {
    try {
      if (cln::abs(values({expression}, point)[0]) > small(agreed_digits)) return ZeroTestResult::no;
      is_decided = true;
    } catch (const std::domain_error&) {  // no value at this point
    }
  }
  if (!is_decided) return ZeroTestResult::unknown;
  return symbolic::is_proven_zero(dag_, expression, &effort_) ? ZeroTestResult::proven : ZeroTestResult::numerical;
}

Ref OneFormSpace::simpler(Ref expression) {
  return symbolic::expand_if_shorter(dag_, expression, form_terms, &effort_);
}

// Chooses a constant pivot if there is one, otherwise the one with the smallest expression, to keep results short.
bool OneFormSpace::choose_pivot(const std::vector<OneForm>& rows, const std::vector<bool>& used, std::size_t columns,
                                const std::vector<std::size_t>& pivots, std::pair<std::size_t, std::size_t>& at) const {
  std::size_t best = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns && !used[i]; ++j) {
      if (dag_.is_zero(rows[i][j]) || std::find(pivots.begin(), pivots.end(), j) != pivots.end()) continue;
      const std::size_t size = dag_.symbols({rows[i][j]}).empty() ? 0 : dag_.reachable({rows[i][j]}).size();
      if (best != 0 && size + 1 >= best) continue;
      best = size + 1;
      at = {i, j};
    }
  }
  return best != 0;
}

Echelon OneFormSpace::echelon(std::vector<OneForm> rows, std::size_t columns) {
  Echelon result;
  std::vector<bool> used(rows.size(), false);
  if (columns == 0 && !rows.empty()) columns = rows[0].size();
  const auto clean = [&](Ref& entry) {
    if (dag_.is_zero(entry)) return;
    const ZeroTestResult zero = vanishing(entry);
    if (zero == ZeroTestResult::no || zero == ZeroTestResult::unknown) return;
    if (zero == ZeroTestResult::numerical) result.exact = false;
    entry = dag_.zero();
  };
  for (OneForm& row : rows) {
    for (Ref& entry : row) clean(entry);
  }
  std::vector<std::size_t> order;
  for (std::pair<std::size_t, std::size_t> at; choose_pivot(rows, used, columns, result.pivots, at);) {
    if (is_effort_spent()) break;
    const auto [row, column] = at;
    used[row] = true;
    order.push_back(row);
    result.pivots.push_back(column);
    const Ref pivot = rows[row][column];
    for (Ref& entry : rows[row]) entry = simpler(dag_.div(entry, pivot));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Ref factor = rows[i][column];
      if (i == row || dag_.is_zero(factor)) continue;
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        rows[i][j] = j == column ? dag_.zero() : simpler(dag_.sub(rows[i][j], dag_.mul(factor, rows[row][j])));
        clean(rows[i][j]);
      }
    }
  }
  for (const std::size_t row : order) result.rows.push_back(rows[row]);
  result.exact = result.exact && !is_effort_spent();
  return result;
}

OneForm OneFormSpace::reduce(OneForm form, const Echelon& rows) {
  for (std::size_t k = 0; k < rows.rows.size(); ++k) {
    const Ref factor = form[rows.pivots[k]];
    if (dag_.is_zero(factor)) continue;
    for (std::size_t j = 0; j < form.size(); ++j) {
      form[j] = j == rows.pivots[k] ? dag_.zero() : simpler(dag_.sub(form[j], dag_.mul(factor, rows.rows[k][j])));
    }
  }
  return form;
}

// With omega_k = dx_pk + sum_j B_kj dx_j over the columns j without pivot and X_i = d/dx_i - sum_l B_li d/dx_pl:
// d omega_k = sum_(i<j) (X_i B_kj - X_j B_ki) dx_i ^ dx_j modulo the rows.
std::vector<OneForm> OneFormSpace::curvature(const Echelon& rows) {
  std::vector<std::size_t> others;
  for (std::size_t j = 0; j < variables_.size(); ++j) {
    if (std::find(rows.pivots.begin(), rows.pivots.end(), j) == rows.pivots.end()) others.push_back(j);
  }
  const auto along = [&](std::size_t i, Ref f) {
    Ref result = derivative(f, i);
    for (std::size_t l = 0; l < rows.rows.size(); ++l) {
      if (dag_.is_zero(rows.rows[l][i])) continue;
      const Ref slope = derivative(f, rows.pivots[l]);
      result = dag_.sub(result, dag_.mul(rows.rows[l][i], slope));
    }
    return result;
  };
  std::vector<OneForm> result;
  for (const OneForm& row : rows.rows) {
    result.emplace_back();
    for (std::size_t a = 0; a < others.size(); ++a) {
      for (std::size_t b = a + 1; b < others.size(); ++b) {
        result.back().push_back(dag_.sub(along(others[a], row[others[b]]), along(others[b], row[others[a]])));
      }
    }
  }
  return result;
}

}  // namespace eomgen::mechanics
