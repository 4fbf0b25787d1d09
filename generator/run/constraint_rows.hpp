// SPDX-License-Identifier: GPL-3.0-or-later
// What a run projects its states onto: constraints on positions, then integrals of constraints on velocities with the
// constants of the start, then constraints on velocities. In: the compiled code. Out: rows as eom::Projection takes them.
#pragma once

#include "run/runner.hpp"

namespace eomgen::run {

class ConstraintRows {
 public:
  explicit ConstraintRows(const RunRequest& request);

  std::size_t size() const { return order_.size() + integrals_.size(); }
  std::size_t on_positions() const { return holonomic_ + integrals_.size(); }

  /// The state whose integrals are kept; u: the inputs there.
  void start(double t, const double* x, const double* u);
  int operator()(double t, const double* x, const double* u, double* psi, double* A, double* b);
  /// Largest |psi|, |f . qdot + b| of a state; infinite where one has no value. Integrals are watched as invariants.
  double defect(double t, const double* x);

 private:
  struct Integral {
    std::size_t psi;                  // places among the outputs
    std::vector<std::size_t> slopes;  // by the free coordinates, then by t
    double constant = 0;
  };

  const RunRequest& request_;
  std::size_t n_, holonomic_ = 0;
  std::vector<std::size_t> order_;  // of the active constraints: those on positions first
  std::vector<Integral> integrals_;
  std::vector<double> y_, psi_, A_, b_;
};

std::size_t index_of(const std::vector<std::string>& names, const std::string& name);

}  // namespace eomgen::run
