// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/null_space_solver.hpp"

#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "error.hpp"
#include "program/constrained_points.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::program {
namespace {

constexpr std::size_t max_rows = 3, max_columns = 12;  // limits of blocks whose determinants are written out
constexpr std::size_t term_budget = 60;

using Columns = std::vector<std::size_t>;

/// det A[rows, columns] by cofactor expansion of the first row; structural zeros cost no operations.
Ref determinant(Dag& dag, const std::vector<Ref>& A, std::size_t n, const Columns& rows, const Columns& columns) {
  if (rows.empty()) return dag.one();
  Ref sum = dag.zero();
  const Columns rest(rows.begin() + 1, rows.end());
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const Ref entry = A[rows[0] * n + columns[j]];
    if (dag.is_zero(entry)) continue;
    Columns others = columns;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(j));
    const Ref part = dag.mul(entry, determinant(dag, A, n, rest, others));
    sum = j % 2 == 0 ? dag.add(sum, part) : dag.sub(sum, part);
  }
  return sum;
}

bool never_vanishes(const Dag& dag, Ref r) {
  if (dag.is_constant(r)) return !dag.is_zero(r);
  return dag.is_positive(r) || (dag[r].op == symbolic::Op::neg && dag.is_positive(dag[r].args[0]));
}

/// Blocks of rows that share columns directly or through other rows, and the columns of each block.
std::vector<std::pair<Columns, Columns>> connected(const Dag& dag, const std::vector<Ref>& A, std::size_t n,
                                                   std::size_t m) {
  std::vector<std::size_t> label(m);
  for (std::size_t k = 0; k < m; ++k) label[k] = k;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t first = m;
    for (std::size_t k = 0; k < m; ++k) {
      if (dag.is_zero(A[k * n + i])) continue;
      if (first == m) first = k;
      const std::size_t from = label[k], to = label[first];
      for (std::size_t& l : label) l = l == from ? to : l;
    }
  }
  std::vector<std::pair<Columns, Columns>> result;
  for (std::size_t k = 0; k < m; ++k) {
    Columns rows, columns;
    for (std::size_t j = 0; j < m; ++j) {
      if (label[j] == k) rows.push_back(j);
    }
    if (rows.empty()) continue;
    for (std::size_t i = 0; i < n; ++i) {
      if (std::any_of(rows.begin(), rows.end(), [&](std::size_t j) { return !dag.is_zero(A[j * n + i]); }))
        columns.push_back(i);
    }
    result.emplace_back(std::move(rows), std::move(columns));
  }
  return result;
}

/// Whether r is 0 in many digits at all test points: a determinant whose terms cancel, but leave a rounding error in
/// binary64.
bool is_zero_numerically(const Dag& dag, Ref r) {
  const cln::cl_R small = cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 30));
  for (std::uint64_t point = 1; point <= 4; ++point) {
    try {
      const auto at = [point](const symbolic::Symbol& s) -> cln::cl_R { return symbolic::sample(s, point); };
      if (cln::abs(symbolic::evaluate(dag, {r}, at, 40)[0]) > small) return false;
    } catch (const std::domain_error&) {
      continue;  // the point is outside the domain of a function
    }
  }
  return true;
}

/// Whether the determinant, relative to the lengths of its rows, is 0 at all test points on the constraints.
bool vanishes_on_constraints(const Dag& dag, const std::vector<Ref>& A, std::size_t n, const DependentBlock& block,
                             const std::vector<Point>& points) {
  constexpr double rounding = 1e-8;  // for points with errors of 1e-11 and slopes of about 100
  std::vector<Ref> roots{block.determinant};
  for (const std::size_t k : block.rows)
    roots.insert(roots.end(), A.begin() + static_cast<std::ptrdiff_t>(k * n),
                 A.begin() + static_cast<std::ptrdiff_t>((k + 1) * n));
  bool is_decided = false;
  for (const Point& point : points) {
    const std::vector<double> value =
        symbolic::evaluate(dag, roots, [&](const symbolic::Symbol& s) -> double { return point.at(s); });
    double scale = 1;
    for (std::size_t k = 0; k < block.rows.size(); ++k) {
      double square = 0;
      for (std::size_t i = 0; i < n; ++i) square += std::pow(value[1 + k * n + i], 2);
      scale *= std::sqrt(square);
    }
    if (!std::isfinite(value[0]) || !std::isfinite(scale)) continue;
    if (std::abs(value[0]) > rounding * scale) return false;
    is_decided = true;
  }
  return is_decided;
}

/// Chooses the dependent columns: those whose determinant never vanishes, or else the shortest determinant that is not
/// always zero on the constraints.
std::optional<DependentBlock> block_of(const system::EquationSystem& s, const Columns& rows, const Columns& columns) {
  Dag& dag = *s.dag;
  const std::vector<Ref>& A = s.A;
  const std::size_t n = s.free.size();
  if (rows.size() > max_rows || columns.size() > max_columns || columns.size() < rows.size()) return std::nullopt;
  std::optional<std::vector<Point>> points;
  std::optional<DependentBlock> best;
  std::size_t best_size = 0;
  std::vector<bool> chosen(columns.size(), false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(rows.size()), true);
  do {
    DependentBlock block{rows, {}, {}, {}};
    for (std::size_t j = 0; j < columns.size(); ++j)
      (chosen[j] ? block.dependent : block.independent).push_back(columns[j]);
    block.determinant = determinant(dag, A, n, rows, block.dependent);
    if (dag.is_zero(block.determinant) || is_singular_everywhere(dag, {dag.power(block.determinant, 2)}, 1)) continue;
    const std::size_t size = never_vanishes(dag, block.determinant) ? 0 : dag.reachable({block.determinant}).size();
    if ((best && size >= best_size) || (size > 0 && is_zero_numerically(dag, block.determinant))) continue;
    if (size > 0) {
      if (!points) points = points_on_constraints(s, rows);
      if (vanishes_on_constraints(dag, A, n, block, *points)) continue;
    }
    best = std::move(block);
    best_size = size;
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  return best;
}

}  // namespace

std::optional<std::vector<DependentBlock>> dependent_blocks(const system::EquationSystem& s) {
  std::vector<DependentBlock> result;
  for (const auto& [rows, columns] : connected(*s.dag, s.A, s.free.size(), s.active.size())) {
    std::optional<DependentBlock> block = block_of(s, rows, columns);
    if (!block) return std::nullopt;
    result.push_back(std::move(*block));
  }
  return result;
}

bool is_form_applicable(const system::EquationSystem& s, system::Form form, bool everywhere) {
  if (form == system::Form::multipliers) return true;
  if (s.active.empty() || s.active.size() >= s.free.size()) return false;
  const auto can_be_left = [](const system::Contact& contact) { return contact.unilateral.has_value(); };
  if (std::any_of(s.contacts.begin(), s.contacts.end(), can_be_left))
    return false;  // the dependent velocities change with the mode
  const std::optional<std::vector<DependentBlock>> blocks = dependent_blocks(s);
  if (!blocks || !everywhere) return blocks.has_value();
  return std::all_of(blocks->begin(), blocks->end(), [&](const DependentBlock& block) {
    // With one more column than rows the minors form a null vector wherever the rows are independent.
    if (form == system::Form::nullspace && block.independent.size() <= 1) return true;
    return never_vanishes(*s.dag, block.determinant);
  });
}

NullSpaceSolver::NullSpaceSolver(const system::EquationSystem& s, Ties ties)
    : dag_(s.dag),
      n_(s.free.size()),
      m_(s.active.size()),
      uses_quotients_(s.form == system::Form::chaplygin),
      M_(s.M),
      A_(s.A),
      f_(s.f),
      gamma_(s.gamma) {
  Dag& dag = *dag_;
  const std::optional<std::vector<DependentBlock>> blocks = dependent_blocks(s);
  if (!blocks) {
    throw Error("program", {},
                "the constraints of this model are coupled in blocks that are too large for this form, or "
                "they are dependent wherever they hold",
                "use --form multipliers");
  }
  blocks_ = *blocks;
  std::vector<bool> bound(n_, false);
  for (const DependentBlock& block : blocks_) {
    for (const Columns* columns : {&block.dependent, &block.independent}) {
      for (const std::size_t i : *columns) bound[i] = true;
    }
    add_null_vectors(block, uses_quotients_);
  }
  for (std::size_t i = 0; i < n_; ++i) {
    if (bound[i]) continue;
    Z_.emplace_back(n_, dag.zero());
    Z_.back()[i] = dag.one();
  }
  const std::size_t k = Z_.size();
  std::vector<Ref> G(k * k, dag.zero());
  for (std::size_t b = 0; b < k; ++b) {
    for (std::size_t i = 0; i < n_; ++i) {
      Ref column = dag.zero();
      for (std::size_t j = 0; j < n_; ++j) column = dag.add(column, dag.mul(M_[i * n_ + j], Z_[b][j]));
      for (std::size_t a = 0; a <= b; ++a) G[a * k + b] = dag.add(G[a * k + b], dag.mul(Z_[a][i], column));
    }
    for (std::size_t a = 0; a <= b; ++a) G[b * k + a] = G[a * k + b] = simplify_entry(G[a * k + b]);
  }
  reduced_ = std::make_unique<Factorisation>(dag, std::move(G), k, ties);
  if (uses_quotients_) return;
  std::vector<Ref> gram(m_ * m_, dag.zero());
  for (std::size_t a = 0; a < m_; ++a) {
    for (std::size_t b = 0; b < m_; ++b) {
      for (std::size_t i = 0; i < n_; ++i)
        gram[a * m_ + b] = dag.add(gram[a * m_ + b], dag.mul(A_[a * n_ + i], A_[b * n_ + i]));
      gram[a * m_ + b] = simplify_entry(gram[a * m_ + b]);
    }
  }
  gram_ = std::make_unique<Factorisation>(dag, std::move(gram), m_, ties);
}

// The dependent part of a null vector is -adj(A_d) A_i with det(A_d) at index i; or, divided, with 1 at index i.
void NullSpaceSolver::add_null_vectors(const DependentBlock& block, bool divided) {
  Dag& dag = *dag_;
  const std::size_t r = block.rows.size();
  std::vector<Ref> adjugate(r * r);
  for (std::size_t i = 0; i < r; ++i) {
    for (std::size_t j = 0; j < r; ++j) {
      Columns rows = block.rows, columns = block.dependent;
      rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(j));
      columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(i));
      const Ref minor = determinant(dag, A_, n_, rows, columns);
      Ref& entry = adjugate[i * r + j] = (i + j) % 2 == 0 ? minor : dag.neg(minor);
      if (divided) entry = dag.div(entry, block.determinant);
    }
  }
  for (const std::size_t free : block.independent) {
    Z_.emplace_back(n_, dag.zero());
    Z_.back()[free] = divided ? dag.one() : block.determinant;
    for (std::size_t i = 0; i < r; ++i) {
      Ref sum = dag.zero();
      for (std::size_t j = 0; j < r; ++j)
        sum = dag.sub(sum, dag.mul(adjugate[i * r + j], A_[block.rows[j] * n_ + free]));
      Z_.back()[block.dependent[i]] = simplify_entry(sum);
    }
  }
  adjugate_.push_back(std::move(adjugate));
}

Ref NullSpaceSolver::simplify_entry(Ref r) const { return symbolic::expand_if_shorter(*dag_, r, term_budget); }

/// p with A p = c: its independent part is 0, or p has minimum norm, which exists wherever the rows are independent.
std::vector<Ref> NullSpaceSolver::particular_solution(const std::vector<Ref>& c) const {
  Dag& dag = *dag_;
  std::vector<Ref> p(n_, dag.zero());
  if (!uses_quotients_) {
    const std::vector<Ref> y = gram_->backward(gram_->forward(c));
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k < m_; ++k) p[i] = dag.add(p[i], dag.mul(A_[k * n_ + i], y[k]));
    }
    return p;
  }
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const auto& [rows, dependent, independent, det] = blocks_[block];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) {
        p[dependent[i]] = dag.add(p[dependent[i]], dag.mul(adjugate_[block][i * rows.size() + j], c[rows[j]]));
      }
    }
  }
  return p;
}

/// Solves A^T lambda = excess for lambda.
std::vector<Ref> NullSpaceSolver::multipliers(const std::vector<Ref>& excess) const {
  Dag& dag = *dag_;
  std::vector<Ref> lambda(m_, dag.zero());
  if (!uses_quotients_) {
    for (std::size_t k = 0; k < m_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) lambda[k] = dag.add(lambda[k], dag.mul(A_[k * n_ + i], excess[i]));
    }
    return gram_->backward(gram_->forward(lambda));
  }
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    const auto& [rows, dependent, independent, det] = blocks_[block];
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows.size(); ++j) {
        lambda[rows[j]] =
            dag.add(lambda[rows[j]], dag.mul(adjugate_[block][i * rows.size() + j], excess[dependent[i]]));
      }
    }
  }
  return lambda;
}

Unknowns NullSpaceSolver::operator()(std::vector<Ref> r, const std::vector<Ref>& c) const {
  Dag& dag = *dag_;
  std::vector<Ref> x = particular_solution(c);
  const auto excess = [&] {
    std::vector<Ref> result;
    for (std::size_t i = 0; i < n_; ++i) {
      Ref sum = dag.neg(r[i]);
      for (std::size_t j = 0; j < n_; ++j) sum = dag.add(sum, dag.mul(M_[i * n_ + j], x[j]));
      result.push_back(sum);
    }
    return result;
  };
  const std::vector<Ref> rest = excess();
  std::vector<Ref> right;
  for (const std::vector<Ref>& z : Z_) {
    Ref sum = dag.zero();
    for (std::size_t i = 0; i < n_; ++i) sum = dag.sub(sum, dag.mul(z[i], rest[i]));
    right.push_back(sum);
  }
  const std::vector<Ref> w = reduced_->backward(reduced_->forward(right));
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t a = 0; a < w.size(); ++a) x[i] = dag.add(x[i], dag.mul(Z_[a][i], w[a]));
  }
  std::vector<Ref> lambda = multipliers(excess());
  return {std::move(x), std::move(lambda)};
}

Unknowns NullSpaceSolver::solve_accelerations() const {
  std::vector<Ref> c;
  for (const Ref gamma : gamma_) c.push_back(dag_->neg(gamma));
  return (*this)(f_, c);
}

// Pivots of the two factorisations, and the determinants that are divided by, relative to their rows.
std::vector<Pivot> NullSpaceSolver::pivots() const {
  Dag& dag = *dag_;
  std::vector<Pivot> result;
  for (const DependentBlock& block : blocks_) {
    if (!uses_quotients_ || never_vanishes(dag, block.determinant)) continue;
    Ref scale = dag.zero();
    for (const std::size_t k : block.rows) {
      for (std::size_t i = 0; i < n_; ++i) scale = dag.add(scale, dag.power(A_[k * n_ + i], 2));
    }
    const auto rows = static_cast<long>(block.rows.size());
    result.push_back({dag.power(block.determinant, 2), dag.power(simplify_entry(scale), rows)});
  }
  result.insert(result.end(), reduced_->pivots().begin(), reduced_->pivots().end());
  if (gram_) result.insert(result.end(), gram_->pivots().begin(), gram_->pivots().end());
  return result;
}

}  // namespace eomgen::program
