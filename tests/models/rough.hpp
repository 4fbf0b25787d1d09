// SPDX-License-Identifier: GPL-3.0-or-later
// Tools for models with friction: evaluation of derived equations at any state, and integration of hand-written
// equations for comparison with a run.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "friction/compiled.hpp"
#include "support/simulation.hpp"

namespace eomgen::test {

/// Tolerance between a run and hand-written equations: a few seconds at rtol 1e-12 on both sides.
constexpr double integration_tolerance = 1e-10;
/// Tolerance for about a hundred operations in binary64.
constexpr double rounding = 1e-12;

FinishedRun run_rough(const std::string& model, const std::string& scene = "default",
                      const std::function<void(pipeline::SimulationRequest&)>& adjust = {});

/// Sets parameters to exact values.
std::function<void(pipeline::SimulationRequest&)> with(std::map<std::string, double> parameters);

/// Events "slip", "stick", ... in order of time.
std::vector<run::RunEvent> events_of(const FinishedRun& run);

/// Integrates hand-written equations.
class HandWrittenMotion {
 public:
  using RightHandSide = std::function<void(double t, const double* x, double* dx)>;
  HandWrittenMotion(RightHandSide rates, double t, std::vector<double> start)
      : x(std::move(start)), t_(t), rates_(std::move(rates)) {}

  void advance_to(double t);
  std::vector<double> x;

 private:
  double t_;
  RightHandSide rates_;
};

/// Evaluates the derived equations of a shipped model at chosen states. Contacts slide in the direction of the
/// velocity.
class StateEvaluation {
 public:
  explicit StateEvaluation(const FinishedRun& run, const std::string& model);

  /// Returns false unless the friction law has exactly one solution with the normal force of a mode.
  bool slide(double t, std::vector<double> x);
  double output(const std::string& name) const { return rough_.output(name, t_, x_.data(), mode_); }

  std::vector<double> dx;

 private:
  RoughProgram rough_;
  double t_ = 0;
  std::vector<double> x_;
  int mode_ = 0;
};

/// Uniform random values between two bounds, with a fixed seed.
class UniformSampler {
 public:
  double operator()(double lower, double upper) {
    return lower + (upper - lower) * std::uniform_real_distribution<>()(engine_);
  }

 private:
  std::mt19937_64 engine_{7};
};

/// Integral of a smooth function by the composite Simpson rule.
double simpson(const std::function<double(double)>& f, double a, double b, int intervals = 4000);

/// Root of f between a and b, where f changes sign.
double root_between(const std::function<double(double)>& f, double a, double b);

}  // namespace eomgen::test
