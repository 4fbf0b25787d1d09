// SPDX-License-Identifier: GPL-3.0-or-later
// The common parts of the two ways to derivatives of the end of a run (sensitivity.hpp, gradient.hpp): which runs have
// derivatives, the method and options of their integration, the comparison with the run.
#pragma once

#include <eom/run_types.hpp>
#include <string>
#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// Throws Error{stage "run"}: the end has no derivatives for this reason.
[[noreturn]] void refuse_derivative(const std::string& what);
/// The reason that was given to refuse_derivative().
std::string reason_of_refusal(const Error& error);

/// Throws Error{stage "run"} if the end of the run has no derivatives.
void require_derivatives(const RunRequest& request, const RunResult& result);

/// The method of the run; if it needs a series, momenta or constraints, a method of similar order that does not.
std::string derivative_solver(const std::string& solver);

/// Tolerances, steps and limits of the run, for this method.
eom::Options derivative_options(const RunRequest& request, const std::string& solver);

/// The motion that is integrated for derivatives has to end where the run does: otherwise they miss something.
class EndComparison {
 public:
  /// end: the state at the end of that motion. All arguments have to outlive it.
  EndComparison(const RunRequest& request, const RunResult& result, const std::vector<double>& end)
      : request_(request), result_(result), end_(end) {}

  /// Whether each component agrees within the tolerances, or within 10 of both errors. Without estimates of errors:
  /// within 1000 tolerances.
  bool agrees(const std::vector<double>& errors) const { return worst(errors) == none; }
  /// Throws Error{stage "run"} if they do not.
  void require(const std::vector<double>& errors) const;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  static constexpr double unknown_errors = 1000;  // tolerances per step, if no run has estimated the errors at the end
  std::size_t worst(const std::vector<double>& errors) const;

  const RunRequest& request_;
  const RunResult& result_;
  const std::vector<double>& end_;
};

}  // namespace eomgen::run
