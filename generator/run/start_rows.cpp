// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/start_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "derive/imposition.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::run {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

StartRows::StartRows(StartProblem& problem)
    : p_(problem), s_(problem.system), n_(s_.free.size()), m_(s_.active.size()) {
  for (std::size_t k = 0; k < m_; ++k) {
    if (s_.holonomic[k]) rows_[0].push_back(k);
    rows_[1].push_back(k);
  }
  constraint_of_.assign(s_.active.begin(), s_.active.end());
  A_ = s_.A;
  psi_ = s_.psi;
  b_ = s_.b;
  for (const system::RedundantConstraint& watched : s_.redundant) {
    if (p_.mechanics.constraints[watched.constraint].holonomic()) rows_[0].push_back(b_.size());
    rows_[1].push_back(b_.size());
    constraint_of_.push_back(watched.constraint);
    A_.insert(A_.end(), watched.A.begin(), watched.A.end());
    psi_.push_back(watched.psi);
    b_.push_back(watched.b);
  }
  target_.assign(b_.size(), 0);
  add_contacts();
  for (const StartProblem::AngularVelocity& turn : p_.angular_velocities) add_angular_velocity(turn);
}

void StartRows::add_contacts() {
  for (const system::Contact& contact : s_.contacts) {
    contacts_.push_back({contact.name, {}, contact.unilateral.has_value(), contact.slip});
    if (contact.unilateral) contacts_.back().row = *contact.unilateral;
  }
  for (const system::ContactWithInputs& contact : s_.contacts_with_inputs) {
    contacts_.push_back({contact.name, {}, contact.unilateral, {}});
    for (const system::ContactRow& row : contact.slip) contacts_.back().slip.push_back(row.rate);
    if (!contact.normal) continue;
    contacts_.back().row = b_.size();
    rows_[0].push_back(b_.size());
    psi_.push_back(contact.gap);
    constraint_of_.push_back(p_.mechanics.contacts[contacts_.size() - 1].constraints[0]);
    add_rate(contact.normal->rate, 0);
  }
}

// Rates of a body that rolls with friction follow from rolling, if the given rates allow it: further rows with slip 0.
bool StartRows::add_rolling() {
  const std::size_t before = rows_[1].size();
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    const std::optional<std::uint32_t> body_contact = p_.mechanics.contacts[j].body_contact;
    if (!body_contact || !p_.mechanics.model->constraints[*body_contact].is_rolling_with_friction() || p_.open[j])
      continue;
    if (contacts_[j].unilateral && std::find(rows_[1].begin(), rows_[1].end(), *contacts_[j].row) == rows_[1].end())
      continue;
    for (const Ref slip : contacts_[j].slip) {
      add_rate(slip, 0);
      rolling_contacts_.push_back(j);
    }
  }
  return rows_[1].size() > before;
}
void StartRows::drop_rolling() {
  while (!rows_[1].empty() && rows_[1].back() >= first_angular_velocity_row() + 3 * p_.angular_velocities.size())
    rows_[1].pop_back();
}

// An angular velocity is linear in the rates: three further rows.
void StartRows::add_angular_velocity(const StartProblem::AngularVelocity& turn) {
  symbolic::Substitution imposed = derive::constraint_substitution(p_.mechanics),
                         written = derive::time_function_substitution(p_.mechanics);
  for (std::size_t k = 0; k < 3; ++k)
    add_rate(written(imposed(p_.mechanics.angular_velocity[turn.frame][k])), turn.value[k]);
}

// A row w = value, with w linear in the rates.
void StartRows::add_rate(Ref w, double wanted) {
  symbolic::Dag& dag = *s_.dag;
  std::map<Symbol, Ref> zero;
  for (const std::uint32_t i : s_.free) zero[{SymbolKind::coordinate, i, 1}] = dag.zero();
  symbolic::Substitution at_rest(dag, zero);
  rows_[1].push_back(b_.size());
  for (const std::uint32_t i : s_.free)
    A_.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, i, 1})(w));
  b_.push_back(at_rest(w));
  target_.push_back(wanted);
}

std::string StartRows::label(StartProblem::Key key) const {
  return p_.mechanics.model->coordinates[key.first].name + (key.second == 0 ? "" : "_dot");
}

double StartRows::lookup(const Symbol& s) const {
  switch (s.kind) {
    case SymbolKind::parameter: return p_.parameters[s.index];
    case SymbolKind::time: return p_.t0;
    case SymbolKind::integral: return 0;  // integrals begin here
    case SymbolKind::coordinate: return s.order == 0 ? p_.q[s.index] : p_.qdot[s.index];
    default: return std::nan("");
  }
}
std::vector<double> StartRows::evaluate(const std::vector<Ref>& refs) const {
  return symbolic::evaluate(*s_.dag, refs, [this](const Symbol& s) { return lookup(s); });
}

/// Residual of psi (order 0) or A qdot + b (order 1), and A.
void StartRows::linearise(std::uint8_t order, VectorXd& residual, MatrixXd& A) const {
  std::vector<Ref> refs = A_;
  const std::vector<Ref>& constant = order == 0 ? psi_ : b_;
  refs.insert(refs.end(), constant.begin(), constant.end());
  const std::vector<double> values = evaluate(refs);
  const std::vector<std::size_t>& bound = rows_[order];
  A.resize(static_cast<Eigen::Index>(bound.size()), static_cast<Eigen::Index>(n_));
  residual.resize(static_cast<Eigen::Index>(bound.size()));
  for (std::size_t row = 0; row < bound.size(); ++row) {
    const std::size_t k = bound[row];
    double sum = values[A_.size() + k] - (order == 1 ? target_[k] : 0);
    for (std::size_t i = 0; i < n_; ++i) {
      A(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) = values[k * n_ + i];
      if (order == 1) sum += values[k * n_ + i] * p_.qdot[s_.free[i]];
    }
    residual(static_cast<Eigen::Index>(row)) = sum;
  }
}

// |psi_k| relative to the size of its linear terms, as in the contract.
double StartRows::relative(const VectorXd& residual, const MatrixXd& A, std::uint8_t order, Eigen::Index k) const {
  // A coordinate on which the row hardly depends is no scale of it if it ran away: atan(z) does not vanish because z is
  // large.
  constexpr double negligible = 1e-8, far = 1e6;
  const double steepest = A.row(k).cwiseAbs().maxCoeff();
  double terms = 0, slopes = 0, largest = 0, hardly = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const double x = order == 0 ? p_.q[s_.free[i]] : p_.qdot[s_.free[i]],
                 slope = std::abs(A(k, static_cast<Eigen::Index>(i)));
    terms += std::abs(slope * x);
    slopes += slope;
    double& of = slope < negligible * steepest ? hardly : largest;
    of = std::max(of, std::abs(x));
  }
  largest = std::max(largest, std::min(hardly, far * std::max(1.0, largest)));
  const double size = std::abs(residual(k));
  // A residual below the last digit of the other coordinates is 0, whatever its terms are.
  if (size <= start_rounding * slopes * largest) return 0;
  // At rest every term of A qdot vanishes; b itself is then the scale.
  return terms > size ? size / terms : 1;
}

double StartRows::largest_residual(std::uint8_t order, Eigen::Index* where) const {
  VectorXd residual;
  MatrixXd A;
  linearise(order, residual, A);
  double largest = 0;
  for (Eigen::Index k = 0; k < residual.size(); ++k) {
    const double size = std::isfinite(residual(k)) ? relative(residual, A, order, k) : 1;
    if (size <= largest) continue;
    largest = size;
    if (where != nullptr) *where = k;
  }
  return largest;
}

}  // namespace eomgen::run
