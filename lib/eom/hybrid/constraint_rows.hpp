// SPDX-License-Identifier: MIT
// The constraint rows to which a run projects its states. Their order: position constraints, integrals of velocity
// constraints with the constants of the start, velocity constraints, zero slip of sticking contacts. Rows that are
// inactive in the current mode are 0. In: the compiled code. Out: rows in the form that eom::Projection expects.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/solved_contacts.hpp"
#include "eom/modes/mode_array.hpp"

namespace eom::hybrid {

/// The rows of all constraints that a state has to satisfy: those of the model, of integrals, and of contacts.
class ConstraintRows {
 public:
  /// The problem must outlive this object.
  explicit ConstraintRows(const Problem& problem);

  /// Number of rows.
  std::size_t size() const { return own_size() + gap_rows() + (contacts_ != nullptr ? contacts_->slip_rows() : 0); }
  /// Number of leading rows that constrain positions.
  std::size_t position_row_count() const { return holonomic_ + gap_rows() + integrals_.size(); }
  /// Contacts whose forces are inputs add rows: their gaps before the integrals, their slip last.
  void set_contacts(SolvedContacts* contacts) { contacts_ = contacts; }
  /// Differs after each event that may have changed contacts whose forces are inputs.
  std::size_t changes() const { return contacts_ != nullptr ? contacts_->changed_modes() : 0; }
  /// The active constraint of a row. For a row of an integral or of slip: the number of active constraints.
  std::size_t constraint_of(std::size_t row) const {
    if (row < holonomic_) return order_[row];
    if (row < position_row_count()) return order_.size();
    const std::size_t place = row - integrals_.size() - gap_rows();
    return place >= order_.size() ? order_.size() : order_[place];
  }

  /// Takes the constants of the integrals from this state; u: the inputs there.
  void start(double t, const double* x, const double* u);
  /// The value that each integral has to keep.
  std::vector<double> integral_constants() const {
    std::vector<double> constants;
    for (const Integral& integral : integrals_) constants.push_back(integral.constant);
    return constants;
  }
  /// Restores the values of the integrals.
  void set_integral_constants(const std::vector<double>& constants) {
    for (std::size_t k = 0; k < integrals_.size(); ++k) integrals_[k].constant = constants[k];
  }
  /// psi: rows; A: rows x n by columns; b: rows, with A qdot + b = 0. Returns a code of the C ABI.
  int operator()(double t, const double* x, const double* u, double* psi, double* A, double* b);
  /// Sets the mode of the contacts. set_all_sliding() treats all other closed contacts as sliding.
  void set_mode(int contacts) { mode_ = contacts, all_slide_ = false; }
  /// Sets the charts of all following states.
  void set_charts(const Code& code, const ModeArray& mode) { code_ = &code, charts_ = mode; }
  /// Sets the mode of the contacts, and treats all other closed contacts as sliding.
  void set_all_sliding(int contacts) { mode_ = contacts, all_slide_ = true; }
  /// Sets the value that a row has to reach instead of 0.
  void set_target(std::size_t row, double value) { targets_.at(row) = value; }
  /// Every row has to reach 0.
  void clear_targets() { targets_.assign(size(), 0.0); }
  /// The row of a unilateral contact; the first row of a contact's slip.
  std::size_t row_of(std::size_t contact) const;
  std::size_t slip_row_of(std::size_t contact) const;
  /// A qdot + b of a row.
  double rate(double t, const double* x, const double* u, std::size_t row);
  /// Sum of the sizes of the terms of a linearised position constraint: sum |A_i q_i|. NaN without a value.
  double terms(double t, const double* x, const double* u, std::size_t row);

  /// Whether an active constraint is that of an open contact.
  bool is_open(std::size_t active_constraint) const;
  /// Largest |psi|, |f . qdot + b| of a state; infinite if one has no value. Integrals are monitored as invariants.
  double defect(double t, const double* x);

 private:
  static constexpr double largest_drift = 1e-3;  // of an integral, relative to the possible change of its terms

  struct Integral {
    std::size_t psi;                  // index among the outputs
    std::vector<std::size_t> slopes;  // with respect to the free coordinates, then to t
    double constant = 0;
  };

  struct Slip {
    std::size_t contact, slip;        // the contact; index of the slip among the outputs
    std::vector<std::size_t> slopes;  // with respect to the rates of the free coordinates
  };

  std::size_t own_size() const { return order_.size() + integrals_.size() + slips_.size(); }
  std::size_t gap_rows() const { return contacts_ != nullptr ? contacts_->gap_rows() : 0; }
  int fill_contacts(double t, const double* x, double* psi, double* A, double* b) const;
  int constraints(double t, const double* x);
  void fill_integrals(const double* x, double* psi, double* A, double* b) const;
  void fill_slips(const double* x, double* psi, double* A, double* b) const;
  int fill_closed(double t, const double* x, const double* u);

  const Problem& problem_;
  const Code* code_;
  ModeArray charts_;  // no entries: the own charts
  std::size_t n_, holonomic_ = 0;
  ModeArray open_;  // all contacts open
  int mode_ = 0;
  bool all_slide_ = false;
  SolvedContacts* contacts_ = nullptr;
  std::vector<Slip> slips_;
  std::vector<double> targets_;
  std::vector<std::size_t> order_;  // of the active constraints: position constraints first
  std::vector<Integral> integrals_;
  std::vector<double> y_, psi_, A_, b_;
  std::vector<double> row_psi_, row_A_, row_b_;  // for rate()
};

inline ConstraintRows::ConstraintRows(const Problem& problem)
    : problem_(problem), code_(problem.code), n_(problem.code->free.size()), open_(problem.mode_layout()) {
  const Code& code = *problem.code;
  open_.set_contacts(open_mode(code.contacts));
  for (const bool positions : {true, false}) {
    for (std::size_t k = 0; k < code.active_constraints; ++k) {
      if (code.holonomic[k] == positions) order_.push_back(k);
    }
    if (positions) holonomic_ = order_.size();
  }
  for (const IntegralOutputs& outputs : problem.integrals) integrals_.push_back({outputs.psi, outputs.slopes});
  for (std::size_t j = 0; j < problem.contacts.size(); ++j) {
    for (std::size_t a = 0; a < problem.contacts[j].slip.size() && code.contacts[j].sticks; ++a) {
      slips_.push_back({j, problem.contacts[j].slip[a], problem.contacts[j].slopes[a]});
    }
  }
  clear_targets();
  y_.resize(code.output_names.size());
  psi_.resize(order_.size());
  A_.resize(order_.size() * n_);
  b_.resize(order_.size());
}

inline void ConstraintRows::start(double t, const double* x, const double* u) {
  if (integrals_.empty()) return;
  const int code = problem_.code->outputs(t, x, problem_.parameters.data(), u, open_.data(), y_.data());
  if (code != 0) std::fill(y_.begin(), y_.end(), std::numeric_limits<double>::quiet_NaN());  // no constant available
  for (Integral& integral : integrals_) integral.constant = y_[integral.psi];
}

inline bool ConstraintRows::is_open(std::size_t k) const {
  for (std::size_t j = 0; j < problem_.contacts.size(); ++j) {
    if (problem_.code->contacts[j].unilateral && problem_.contacts[j].constraint == k)
      return contact_sign(contact_digit(mode_, j), 1) < 0;
  }
  return false;
}

inline std::size_t ConstraintRows::row_of(std::size_t contact) const {
  const auto found = std::find(order_.begin(), order_.end(), problem_.contacts[contact].constraint);
  return static_cast<std::size_t>(found - order_.begin());  // position constraints come before the integrals
}

inline std::size_t ConstraintRows::slip_row_of(std::size_t contact) const {
  const auto found =
      std::find_if(slips_.begin(), slips_.end(), [=](const Slip& slip) { return slip.contact == contact; });
  return order_.size() + integrals_.size() + gap_rows() + static_cast<std::size_t>(found - slips_.begin());
}

inline int ConstraintRows::constraints(double t, const double* x) {
  const double* p = problem_.parameters.data();
  if (charts_.charts() == 0) return code_->constraints(t, x, p, psi_.data(), A_.data(), b_.data());
  return code_->constraints_in(t, x, p, charts_.data(), psi_.data(), A_.data(), b_.data());
}

inline int ConstraintRows::operator()(double t, const double* x, const double* u, double* psi, double* A, double* b) {
  const double* p = problem_.parameters.data();
  const std::size_t m = order_.size(), rows = size();
  if (m > 0) {
    if (const int code = constraints(t, x); code != 0) return code;
  }
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t row = k < holonomic_ ? k : k + integrals_.size() + gap_rows();
    const bool open = is_open(order_[k]);
    psi[row] = open ? 0 : psi_[order_[k]];
    b[row] = open ? 0 : b_[order_[k]];
    for (std::size_t i = 0; i < n_; ++i) A[row + rows * i] = open ? 0 : A_[order_[k] + m * i];
  }
  if (!integrals_.empty() || !slips_.empty()) {
    // Neither integrals nor slips depend on forces.
    const int code = problem_.code->outputs(t, x, p, u, open_.data(), y_.data());
    if (code != 0) return code;
    fill_integrals(x, psi, A, b);
    fill_slips(x, psi, A, b);
  }
  if (contacts_ != nullptr) return fill_contacts(t, x, psi, A, b);
  for (std::size_t row = 0; row < rows; ++row) b[row] -= targets_[row];
  return 0;
}

inline int ConstraintRows::fill_contacts(double t, const double* x, double* psi, double* A, double* b) const {
  const std::size_t rows = size();
  std::size_t gap_row = holonomic_, slip_row = own_size() + gap_rows();
  const auto fill = [&](std::size_t row, const contacts::Row& of, double rest) {
    b[row] = rest;
    for (std::size_t i = 0; i < n_; ++i) A[row + rows * i] = 0;
    for (std::size_t k = 0; k < of.columns.size(); ++k) A[row + rows * of.columns[k]] = contacts_->slope(of, k);
  };
  return contacts_->rows(
      t, x,
      [&](double gap, const contacts::Row& row, double rest) {
        psi[gap_row] = gap;
        fill(gap_row++, row, rest);
      },
      [&](const contacts::Row& row, double rest) {
        psi[slip_row] = 0;
        fill(slip_row++, row, rest);
      });
}

inline void ConstraintRows::fill_integrals(const double* x, double* psi, double* A, double* b) const {
  const std::size_t rows = size();
  for (std::size_t k = 0; k < integrals_.size(); ++k) {
    const Integral& integral = integrals_[k];
    const std::size_t row = holonomic_ + gap_rows() + k;
    psi[row] = y_[integral.psi] - integral.constant;
    b[row] = y_[integral.slopes[n_]];
    bool finite = std::isfinite(psi[row]) && std::isfinite(b[row]);
    for (std::size_t i = 0; i < n_; ++i) {
      A[row + rows * i] = y_[integral.slopes[i]];
      finite = finite && std::isfinite(A[row + rows * i]);
    }
    // Outside of its domain, or on another branch of an arc tangent, an integral is not valid. Its constraint remains
    // active, and the monitor reports the drift. A true drift is far smaller than the coordinates.
    double size = 0;
    for (std::size_t i = 0; i < n_; ++i) size += std::abs(A[row + rows * i]) * std::max(1.0, std::abs(x[i]));
    if (finite && std::abs(psi[row]) <= largest_drift * size) continue;
    psi[row] = b[row] = 0;
    for (std::size_t i = 0; i < n_; ++i) A[row + rows * i] = 0;
  }
}

// The slip is linear in the rates: w = A qdot + b.
inline void ConstraintRows::fill_slips(const double* x, double* psi, double* A, double* b) const {
  const std::size_t rows = size(), first = order_.size() + integrals_.size() + gap_rows();
  for (std::size_t k = 0; k < slips_.size(); ++k) {
    const Slip& slip = slips_[k];
    const int digit = contact_digit(mode_, slip.contact);
    const bool held =
        !all_slide_ && digit % 3 == 0 && !(problem_.code->contacts[slip.contact].unilateral && digit >= 3);
    const std::size_t row = first + k;
    psi[row] = 0;
    b[row] = held ? y_[slip.slip] : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      A[row + rows * i] = held ? y_[slip.slopes[i]] : 0;
      b[row] -= A[row + rows * i] * x[n_ + i];
    }
  }
}

// All rows with all contacts closed, into row_psi_, row_A_, row_b_.
inline int ConstraintRows::fill_closed(double t, const double* x, const double* u) {
  const std::size_t rows = size();
  row_psi_.resize(rows), row_b_.resize(rows), row_A_.resize(rows * n_);
  const int mode = mode_;
  mode_ = 0;
  const int code = (*this)(t, x, u, row_psi_.data(), row_A_.data(), row_b_.data());
  mode_ = mode;
  return code;
}

inline double ConstraintRows::rate(double t, const double* x, const double* u, std::size_t row) {
  if (fill_closed(t, x, u) != 0) return std::nan("");
  double sum = row_b_[row] + targets_[row];
  for (std::size_t i = 0; i < n_; ++i) sum += row_A_[row + size() * i] * x[n_ + i];
  return sum;
}

inline double ConstraintRows::terms(double t, const double* x, const double* u, std::size_t row) {
  if (fill_closed(t, x, u) != 0) return std::nan("");
  double sum = 0;
  for (std::size_t i = 0; i < n_; ++i) sum += std::abs(row_A_[row + size() * i] * x[i]);
  return sum;
}

inline double ConstraintRows::defect(double t, const double* x) {
  if (psi_.empty()) return 0;
  const Code& code = *problem_.code;
  // Without a value of psi the drift is infinite, not the value of the previous step.
  if (constraints(t, x) != 0) return HUGE_VAL;
  double largest = 0;
  for (std::size_t k = 0; k < psi_.size(); ++k) {
    if (is_open(k)) continue;
    double defect = psi_[k];
    if (!code.holonomic[k]) {
      defect = b_[k];
      for (std::size_t i = 0; i < n_; ++i) defect += A_[k + psi_.size() * i] * x[n_ + i];
    }
    largest = std::isnan(defect) ? HUGE_VAL : std::max(largest, std::abs(defect));
  }
  return largest;
}

}  // namespace eom::hybrid
