// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/constraint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace eomgen::run {

namespace {

constexpr double largest_drift = 1e-3;  // of an integral, relative to what its terms may change

}  // namespace

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::logic_error("the compiled code has no output '" + name + "'");
  return static_cast<std::size_t>(found - names.begin());
}

ConstraintRows::ConstraintRows(const RunRequest& request)
    : request_(request), code_(&request.code), n_(request.code.free.size()) {
  const Code& code = request.code;
  for (const bool positions : {true, false}) {
    for (std::size_t k = 0; k < code.active_constraints; ++k) {
      if (code.holonomic[k] == positions) order_.push_back(k);
    }
    if (positions) holonomic_ = order_.size();
  }
  for (const IntegralOutputs& names : request.integrals) {
    Integral integral{index_of(code.output_names, names.psi), {}};
    for (const std::string& slope : names.slopes) integral.slopes.push_back(index_of(code.output_names, slope));
    integrals_.push_back(std::move(integral));
  }
  for (std::size_t j = 0; j < request.contacts.size(); ++j) {
    for (std::size_t a = 0; a < request.contacts[j].slip.size() && code.contacts[j].sticks; ++a) {
      slips_.push_back({j, index_of(code.output_names, request.contacts[j].slip[a]), {}});
      for (const std::string& slope : request.contacts[j].slopes[a])
        slips_.back().slopes.push_back(index_of(code.output_names, slope));
    }
  }
  clear_targets();
  y_.resize(code.output_names.size());
  psi_.resize(order_.size());
  A_.resize(order_.size() * n_);
  b_.resize(order_.size());
}

void ConstraintRows::start(double t, const double* x, const double* u) {
  if (integrals_.empty()) return;
  request_.code.outputs(t, x, request_.scene.parameters.data(), u, 0, y_.data());
  for (Integral& integral : integrals_) integral.constant = y_[integral.psi];
}

bool ConstraintRows::is_apart(std::size_t k) const {
  for (std::size_t j = 0; j < request_.contacts.size(); ++j) {
    if (request_.code.contacts[j].unilateral && request_.contacts[j].constraint == k)
      return eom::contact_leaf(mode_, 2 * j + 1) < 0;
  }
  return false;
}

std::size_t ConstraintRows::row_of(std::size_t contact) const {
  const auto found = std::find(order_.begin(), order_.end(), request_.contacts[contact].constraint);
  return static_cast<std::size_t>(found - order_.begin());  // on positions: before the integrals
}

std::size_t ConstraintRows::slip_row_of(std::size_t contact) const {
  const auto found =
      std::find_if(slips_.begin(), slips_.end(), [=](const Slip& slip) { return slip.contact == contact; });
  return order_.size() + integrals_.size() + static_cast<std::size_t>(found - slips_.begin());
}

int ConstraintRows::constraints(double t, const double* x) {
  const double* p = request_.scene.parameters.data();
  if (charts_ == 0) return code_->constraints(t, x, p, psi_.data(), A_.data(), b_.data());
  return code_->constraints_in(t, x, p, charts_, psi_.data(), A_.data(), b_.data());
}

int ConstraintRows::operator()(double t, const double* x, const double* u, double* psi, double* A, double* b) {
  const double* p = request_.scene.parameters.data();
  const std::size_t m = order_.size(), rows = size();
  if (m > 0) {
    if (const int code = constraints(t, x); code != 0) return code;
  }
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t row = k < holonomic_ ? k : k + integrals_.size();
    const bool apart = is_apart(order_[k]);
    psi[row] = apart ? 0 : psi_[order_[k]];
    b[row] = apart ? 0 : b_[order_[k]];
    for (std::size_t i = 0; i < n_; ++i) A[row + rows * i] = apart ? 0 : A_[order_[k] + m * i];
  }
  if (!integrals_.empty() || !slips_.empty()) {
    if (const int code = request_.code.outputs(t, x, p, u, mode_, y_.data()); code != 0) return code;
    fill_integrals(x, psi, A, b);
    fill_slips(x, psi, A, b);
  }
  for (std::size_t row = 0; row < rows; ++row) b[row] -= targets_[row];
  return 0;
}

void ConstraintRows::fill_integrals(const double* x, double* psi, double* A, double* b) const {
  const std::size_t rows = size();
  for (std::size_t k = 0; k < integrals_.size(); ++k) {
    const Integral& integral = integrals_[k];
    const std::size_t row = holonomic_ + k;
    psi[row] = y_[integral.psi] - integral.constant;
    b[row] = y_[integral.slopes[n_]];
    bool finite = std::isfinite(psi[row]) && std::isfinite(b[row]);
    for (std::size_t i = 0; i < n_; ++i) {
      A[row + rows * i] = y_[integral.slopes[i]];
      finite = finite && std::isfinite(A[row + rows * i]);
    }
    // Outside of its domain, or on another branch of an arc tangent, an integral says nothing, and its constraint goes
    // on; the watch reports the drift. A true drift is far smaller than the coordinates.
    double size = 0;
    for (std::size_t i = 0; i < n_; ++i) size += std::abs(A[row + rows * i]) * std::max(1.0, std::abs(x[i]));
    if (finite && std::abs(psi[row]) <= largest_drift * size) continue;
    psi[row] = b[row] = 0;
    for (std::size_t i = 0; i < n_; ++i) A[row + rows * i] = 0;
  }
}

// The slip is linear in the rates: w = A qdot + b.
void ConstraintRows::fill_slips(const double* x, double* psi, double* A, double* b) const {
  const std::size_t rows = size(), first = order_.size() + integrals_.size();
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    const Slip& slip = slips_[k];
    const int digit = eom::contact_digit(mode_, slip.contact);
    const bool held = !all_slide_ && digit % 3 == 0 && !(request_.code.contacts[slip.contact].unilateral && digit >= 3);
    const std::size_t row = first + k;
    psi[row] = 0;
    b[row] = held ? y_[slip.slip] : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      A[row + rows * i] = held ? y_[slip.slopes[i]] : 0;
      b[row] -= A[row + rows * i] * x[n_ + i];
    }
  }
}

double ConstraintRows::rate(double t, const double* x, const double* u, std::size_t row) {
  const std::size_t rows = size();
  row_psi_.resize(rows), row_b_.resize(rows), row_A_.resize(rows * n_);
  const int mode = mode_;
  mode_ = 0;  // everything touches
  const int code = (*this)(t, x, u, row_psi_.data(), row_A_.data(), row_b_.data());
  mode_ = mode;
  if (code != 0) return std::nan("");
  double sum = row_b_[row] + targets_[row];
  for (std::size_t i = 0; i < n_; ++i) sum += row_A_[row + rows * i] * x[n_ + i];
  return sum;
}

double ConstraintRows::defect(double t, const double* x) {
  if (psi_.empty()) return 0;
  const Code& code = request_.code;
  // Where psi has no value the drift is infinite, not what it was a step ago.
  if (constraints(t, x) != 0) return HUGE_VAL;
  double largest = 0;
  for (std::size_t k = 0; k < psi_.size(); ++k) {
    if (is_apart(k)) continue;
    double defect = psi_[k];
    if (!code.holonomic[k]) {
      defect = b_[k];
      for (std::size_t i = 0; i < n_; ++i) defect += A_[k + psi_.size() * i] * x[n_ + i];
    }
    largest = std::isnan(defect) ? HUGE_VAL : std::max(largest, std::abs(defect));
  }
  return largest;
}

}  // namespace eomgen::run
