// SPDX-License-Identifier: GPL-3.0-or-later
// For models with friction: what the derived code says at any state, and equations written by hand integrated beside a
// run.
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

/// Steps at rtol 1e-12 on both sides over some seconds.
constexpr double by_hand = 1e-10;
/// Some hundred operations in binary64.
constexpr double rounding = 1e-12;

Finished run_rough(const std::string& model, const std::string& scene = "default",
                   const std::function<void(pipeline::SimulationRequest&)>& adjust = {});

/// Other values of parameters, exactly.
std::function<void(pipeline::SimulationRequest&)> with(std::map<std::string, double> parameters);

/// "slip", "stick", ... of each event in order, with the time.
std::vector<run::RunEvent> events_of(const Finished& run);

/// Equations by hand, from one time to another.
class Hand {
 public:
  using Rates = std::function<void(double t, const double* x, double* dx)>;
  Hand(Rates rates, double t, std::vector<double> start) : x(std::move(start)), t_(t), rates_(std::move(rates)) {}

  void to(double t);
  std::vector<double> x;

 private:
  double t_;
  Rates rates_;
};

/// Derived equations of a shipped model at chosen states; its contacts slide as the velocities say.
class AtState {
 public:
  explicit AtState(const Finished& run, const std::string& model);

  /// False where the law has no single solution with |N| pressing as one of the modes says.
  bool slide(double t, std::vector<double> x);
  double output(const std::string& name) const { return rough_.output(name, t_, x_.data(), mode_); }

  std::vector<double> dx;

 private:
  RoughProgram rough_;
  double t_ = 0;
  std::vector<double> x_;
  int mode_ = 0;
};

/// Values between two bounds, the same in every run.
class Draw {
 public:
  double operator()(double lower, double upper) {
    return lower + (upper - lower) * std::uniform_real_distribution<>()(engine_);
  }

 private:
  std::mt19937_64 engine_{7};
};

/// Composite Simpson of a smooth function.
double simpson(const std::function<double(double)>& f, double a, double b, int intervals = 4000);

/// A root between a and b, where f changes its sign.
double root_between(const std::function<double(double)>& f, double a, double b);

}  // namespace eomgen::test
