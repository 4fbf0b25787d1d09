// SPDX-License-Identifier: GPL-3.0-or-later
// What a run projects its states onto: constraints on positions, then integrals of constraints on velocities with the
// constants of the start, then constraints on velocities, then slip 0 of contacts that stick. Rows that the mode has
// let go are 0. In: the compiled code. Out: rows as eom::Projection takes them.
#pragma once

#include "run/runner.hpp"

namespace eomgen::run {

class ConstraintRows {
 public:
  explicit ConstraintRows(const RunRequest& request);

  std::size_t size() const { return order_.size() + integrals_.size() + slips_.size(); }
  std::size_t on_positions() const { return holonomic_ + integrals_.size(); }
  /// Which of the active constraints a row is; their number for one of an integral or of slip.
  std::size_t constraint_of(std::size_t row) const {
    if (row < holonomic_) return order_[row];
    return row < on_positions() || row - integrals_.size() >= order_.size() ? order_.size()
                                                                            : order_[row - integrals_.size()];
  }

  /// The state whose integrals are kept; u: the inputs there.
  void start(double t, const double* x, const double* u);
  int operator()(double t, const double* x, const double* u, double* psi, double* A, double* b);
  /// The mode of the contacts, with all others that touch sliding in slide_all().
  void mode(int contacts) { mode_ = contacts, all_slide_ = false; }
  /// The charts that states are in from here on.
  void charts(const Code& code, int bits) { code_ = &code, charts_ = bits; }
  void slide_all(int contacts) { mode_ = contacts, all_slide_ = true; }
  /// A row is to have this value in place of 0.
  void target(std::size_t row, double value) { targets_.at(row) = value; }
  void clear_targets() { targets_.assign(size(), 0.0); }
  /// The row of a contact that can be left; the first of its slip.
  std::size_t row_of(std::size_t contact) const;
  std::size_t slip_row_of(std::size_t contact) const;
  /// A qdot + b of a row.
  double rate(double t, const double* x, const double* u, std::size_t row);

  /// Largest |psi|, |f . qdot + b| of a state; infinite where one has no value. Integrals are watched as invariants.
  double defect(double t, const double* x);

 private:
  struct Integral {
    std::size_t psi;                  // places among the outputs
    std::vector<std::size_t> slopes;  // by the free coordinates, then by t
    double constant = 0;
  };

  struct Slip {
    std::size_t contact, slip;        // the contact; place of the slip among the outputs
    std::vector<std::size_t> slopes;  // by the rates of the free coordinates
  };

  bool is_apart(std::size_t active_constraint) const;
  int constraints(double t, const double* x);
  void fill_integrals(const double* x, double* psi, double* A, double* b) const;
  void fill_slips(const double* x, double* psi, double* A, double* b) const;

  const RunRequest& request_;
  const Code* code_;
  int charts_ = 0;
  std::size_t n_, holonomic_ = 0;
  int mode_ = 0;
  bool all_slide_ = false;
  std::vector<Slip> slips_;
  std::vector<double> targets_;
  std::vector<std::size_t> order_;  // of the active constraints: those on positions first
  std::vector<Integral> integrals_;
  std::vector<double> y_, psi_, A_, b_;
  std::vector<double> row_psi_, row_A_, row_b_;  // for rate()
};

std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

}  // namespace eomgen::run
