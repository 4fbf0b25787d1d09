// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients of outputs at the end of a run by the variational equations, for runs without adjoint equations: forces of
// contacts are solved for at every evaluation, or a state alone leaves the mode of a contact. The cost grows with the
// number of directions. In: as integrate_gradients(). Out: the state at the end, then the value of each output and its
// slopes.
#pragma once

#include <string>
#include <vector>

#include "run/variational.hpp"
#include "run/variational_equations.hpp"

namespace eomgen::run {

class ForwardGradientRun {
 public:
  /// All arguments have to outlive it.
  ForwardGradientRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                     const std::vector<Direction>& directions, const std::vector<std::string>& outputs);

  /// May be called again. Throws Error{stage "run"} if an interruption or an output is not smooth.
  eom::Result operator()(const eom::Options& options);

 private:
  double value_of(const std::string& output, VariationalEquations& in, double t, const std::vector<double>& x);
  double slope(const std::string& output, std::size_t d, const eom::Result& end);

  const std::vector<std::string>& state_names_;
  const std::vector<Direction>& directions_;
  const std::vector<std::string>& outputs_;
  std::size_t n_;
  VariationalRun variational_;
  std::vector<double> y_;
};

}  // namespace eomgen::run
