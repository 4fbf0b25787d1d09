// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/linear_solver.hpp"

#include <cln/real.h>

#include <set>
#include <stdexcept>

#include "error.hpp"
#include "numeric/elimination.hpp"
#include "program/null_space_solver.hpp"
#include "program/polynomials.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"
#include "symbolic/vectors.hpp"

namespace eomgen::program {

namespace {

/// Per constraint: whether its coordinates all belong to one block of M and that block is singular.
std::vector<bool> within_singular_blocks(const Dag& dag, const std::vector<Ref>& M, std::size_t n,
                                         const std::vector<Ref>& A) {
  std::vector<std::size_t> block(n, n);
  std::vector<bool> singular;
  for (std::size_t first = 0; first < n; ++first) {
    if (block[first] != n) continue;
    std::vector<std::size_t> members{first};
    block[first] = singular.size();
    for (std::size_t next = 0; next < members.size(); ++next) {
      for (std::size_t j = 0; j < n; ++j) {
        if (block[j] != n || dag.is_zero(M[members[next] * n + j])) continue;
        block[j] = singular.size();
        members.push_back(j);
      }
    }
    std::vector<Ref> part;
    for (const std::size_t i : members) {
      for (const std::size_t j : members) part.push_back(M[i * n + j]);
    }
    singular.push_back(is_singular_everywhere(dag, part, members.size()));
  }
  std::vector<bool> result;
  for (std::size_t c = 0; c * n < A.size(); ++c) {
    std::set<std::size_t> touched;
    for (std::size_t i = 0; i < n; ++i) {
      if (!dag.is_zero(A[c * n + i])) touched.insert(block[i]);
    }
    result.push_back(touched.size() == 1 && singular[*touched.begin()]);
  }
  return result;
}

}  // namespace

LdlSolver::LdlSolver(const system::EquationSystem& system, Ties ties)
    : dag_(system.dag),
      n_(system.free.size()),
      m_(system.active.size()),
      A_(system.A),
      f_(system.f),
      gamma_(system.gamma),
      quasi_(system.quasi) {
  Dag& dag = *dag_;
  std::vector<Ref> M = quasi_ ? quasi_->M : system.M;
  augmented_ = is_singular_everywhere(dag, M, n_);
  if (augmented_) {
    quasi_.reset();
    M = system.M;
    // Constraints of one singular block, such as the unit length of Euler parameters, leave the other zeros of M
    // unchanged.
    const std::vector<bool> within = within_singular_blocks(dag, M, n_, A_);
    const std::vector<Ref> mass = M;
    augment(M, within);
    // blocks depend on one another
    if (is_singular_everywhere(dag, M, n_)) augment(M = mass, std::vector<bool>(m_, true));
    if (is_singular_everywhere(dag, M, n_)) {
      throw Error("program", {}, "the mass matrix is singular at every state, with the constraints too",
                  "give every coordinate a mass or a constraint that determines it");
    }
  }
  mass_ = std::make_unique<Factorisation>(dag, std::move(M), n_, ties);
  if (m_ == 0) return;
  for (std::size_t c = 0; c < m_; ++c) {
    const auto row = A_.begin() + static_cast<std::ptrdiff_t>(c * n_);
    Y_.push_back(forward({row, row + static_cast<std::ptrdiff_t>(n_)}));
  }
  std::vector<Ref> S(m_ * m_);
  for (std::size_t i = 0; i < m_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) S[i * m_ + j] = S[j * m_ + i] = mass_->inner(Y_[i], Y_[j]);
  }
  for (std::size_t k = 0; k < system.contact_open.size(); ++k)
    S[k * m_ + k] = dag.add(S[k * m_ + k], system.contact_open[k]);
  schur_ = std::make_unique<Factorisation>(dag, std::move(S), m_, ties);
}

// M + A^T S A with the selected rows of A.
void LdlSolver::augment(std::vector<Ref>& M, const std::vector<bool>& taken) {
  Dag& dag = *dag_;
  S_.assign(m_, dag.zero());
  for (std::size_t c = 0; c < m_; ++c) {
    if (taken[c]) S_[c] = constraint_scale(M, c);
  }
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t c = 0; c < m_; ++c) {
        M[i * n_ + j] = dag.add(M[i * n_ + j], dag.mul(S_[c], dag.mul(A_[c * n_ + i], A_[c * n_ + j])));
      }
    }
  }
}

// The sum of the inertias of the coordinates in a constraint; 1 if none of them has inertia.
Ref LdlSolver::constraint_scale(const std::vector<Ref>& M, std::size_t c) const {
  Dag& dag = *dag_;
  Ref sum = dag.zero();
  for (std::size_t i = 0; i < n_; ++i) {
    if (!dag.is_zero(A_[c * n_ + i])) sum = dag.add(sum, M[i * n_ + i]);
  }
  return dag.is_zero(sum) ? dag.one() : sum;
}

std::vector<Ref> LdlSolver::forward(const std::vector<Ref>& r) const {
  return mass_->forward(quasi_ ? symbolic::multiply_transposed(*dag_, quasi_->S_inverse, r) : r);
}

std::vector<Ref> LdlSolver::backward(const std::vector<Ref>& z) const {
  const std::vector<Ref> x = mass_->backward(z);
  return quasi_ ? symbolic::multiply(*dag_, quasi_->S_inverse, x) : x;
}

std::pair<std::vector<Ref>, std::vector<Ref>> LdlSolver::solve_accelerations() const {
  std::vector<Ref> c;
  for (const Ref gamma : gamma_) c.push_back(dag_->neg(gamma));
  if (quasi_) return solve_from_forward(mass_->forward(quasi_->f), c);
  return (*this)(f_, c);
}

std::pair<std::vector<Ref>, std::vector<Ref>> LdlSolver::operator()(std::vector<Ref> r,
                                                                    const std::vector<Ref>& c) const {
  Dag& dag = *dag_;
  if (augmented_) {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k < m_; ++k) r[i] = dag.add(r[i], dag.mul(A_[k * n_ + i], dag.mul(S_[k], c[k])));
    }
  }
  return solve_from_forward(forward(r), c);
}

std::pair<std::vector<Ref>, std::vector<Ref>> LdlSolver::solve_from_forward(std::vector<Ref> z,
                                                                            const std::vector<Ref>& c) const {
  Dag& dag = *dag_;
  std::vector<Ref> lambda;
  if (m_ > 0) {
    std::vector<Ref> excess;
    for (std::size_t k = 0; k < m_; ++k) excess.push_back(dag.sub(c[k], mass_->inner(Y_[k], z)));
    lambda = schur_->backward(schur_->forward(excess));
    for (std::size_t k = 0; k < m_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) z[i] = dag.add(z[i], dag.mul(Y_[k][i], lambda[k]));
    }
  }
  return {backward(z), lambda};
}

std::unique_ptr<LinearSolver> make_linear_solver(const system::EquationSystem& system, Ties ties) {
  if (system.form == system::Form::multipliers) return std::make_unique<LdlSolver>(system, ties);
  return std::make_unique<NullSpaceSolver>(system, ties);
}

std::vector<Pivot> LdlSolver::pivots() const {
  std::vector<Pivot> result = mass_->pivots();
  if (schur_) result.insert(result.end(), schur_->pivots().begin(), schur_->pivots().end());
  return result;
}

namespace {

/// Rank of a positive semidefinite matrix by elimination with diagonal pivots, in 40 digits; values below 1e-25 count
/// as zero.
bool is_singular(std::vector<cln::cl_R> M, std::size_t n) {
  cln::cl_R largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = cln::max(largest, cln::abs(M[i * n + i]));
  numeric::Matrix<cln::cl_R> matrix(n, n);
  matrix.a = std::move(M);
  const cln::cl_R smallest = largest * cln::expt(cln::cl_RA(10), -25);
  return numeric::Elimination<cln::cl_R>(std::move(matrix), smallest, numeric::Pivoting::diagonal).rank() < n;
}

}  // namespace

bool is_singular_everywhere(const Dag& dag, const std::vector<Ref>& M, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    if (dag.is_zero(M[i * n + i])) return true;
  }
  // Points without a value are ignored.
  constexpr std::uint64_t points = 8;
  bool is_decided = false;
  for (std::uint64_t point = 0; point < points; ++point) {
    const auto value = [point](const Symbol& s) -> cln::cl_R { return symbolic::sample(s, point); };
    try {
      if (!is_singular(symbolic::evaluate(dag, M, value, 40), n)) return false;
      is_decided = true;
    } catch (const std::domain_error&) {
    } catch (const std::runtime_error&) {
    }
  }
  return is_decided;
}

}  // namespace eomgen::program
