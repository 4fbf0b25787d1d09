// SPDX-License-Identifier: GPL-3.0-or-later
// For models with friction: what the derived code says at any state, and equations written by hand integrated beside a
// run.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "eom/ode.hpp"
#include "friction/compiled.hpp"
#include "support/simulation.hpp"

namespace eomgen::test {

/// Steps at rtol 1e-12 on both sides over some seconds.
constexpr double by_hand = 1e-10;
/// Some hundred operations in binary64.
constexpr double rounding = 1e-12;

inline Finished run_rough(const std::string& model, const std::string& scene = "default",
                          const std::function<void(pipeline::SimulationRequest&)>& adjust = {}) {
  return run_model(model, [&](pipeline::SimulationRequest& request) {
    request.scene = scene;
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
    request.overrides.every = 0.02;
    if (adjust) adjust(request);
  });
}

/// Other values of parameters, exactly.
inline std::function<void(pipeline::SimulationRequest&)> with(std::map<std::string, double> parameters) {
  return [parameters](pipeline::SimulationRequest& request) {
    for (const auto& [name, value] : parameters) request.overrides.parameters[name] = cln::rational(cln::cl_R(value));
  };
}

/// "slip", "stick", ... of each event in order, with the time.
inline std::vector<run::RunEvent> events_of(const Finished& run) { return run.simulation.result.events; }

/// Equations by hand, from one time to another.
class Hand {
 public:
  using Rates = std::function<void(double t, const double* x, double* dx)>;
  Hand(Rates rates, double t, std::vector<double> start) : x(std::move(start)), t_(t), rates_(std::move(rates)) {}

  void to(double t) {
    eom::Options options;
    options.rtol = 1e-12;
    options.atol = 1e-14;
    const auto f = [this](double at, const double* state, double* dx) { return rates_(at, state, dx), 0; };
    const eom::Result end = eom::integrate("dop853", f, t_, x, t, options);
    REQUIRE(end.outcome == eom::Outcome::done);
    x = end.x;
    t_ = t;
  }
  std::vector<double> x;

 private:
  double t_;
  Rates rates_;
};

/// Derived equations of a shipped model at chosen states; its contacts slide as the velocities say.
class AtState {
 public:
  explicit AtState(const Finished& run, const std::string& model)
      : rough_(read_text(model_path(model)), run.simulation.scene.parameters) {}

  /// False where the law has no single solution with |N| pressing as one of the modes says.
  bool slide(double t, std::vector<double> x) {
    t_ = t, x_ = std::move(x);
    dx.assign(x_.size(), 0);
    const std::vector<eom::Contact> contacts = rough_.contact_list();
    std::vector<double> g(eom::contact_values * contacts.size());
    for (int high = 0; high < 2; ++high) {
      mode_ = 0;
      rough_.contacts(t, x_.data(), 0, g.data());
      for (std::size_t j = 0; j < contacts.size(); ++j) {
        const bool back = contacts[j].dimensions == 1 && g[eom::contact_values * j] < 0;
        const bool pulls = high == 1 && contacts[j].surface && !contacts[j].unilateral;
        mode_ = eom::with_contact_digit(mode_, j, (pulls ? 3 : 0) + (back ? 2 : 1));
      }
      if (rough_.rhs(t, x_.data(), mode_, dx.data()) != 0) continue;
      rough_.contacts(t, x_.data(), mode_, g.data());
      bool holds = true;
      for (std::size_t j = 0; j < contacts.size(); ++j) holds = holds && g[eom::contact_values * j + 3] >= 0;
      if (holds) return true;
    }
    return false;
  }
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
inline double simpson(const std::function<double(double)>& f, double a, double b, int intervals = 4000) {
  const double h = (b - a) / intervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(a + i * h);
  return sum * h / 3;
}

/// A root between a and b, where f changes its sign.
inline double root_between(const std::function<double(double)>& f, double a, double b) {
  const bool rises = f(a) < 0;
  for (int i = 0; i < 200; ++i) (f((a + b) / 2) < 0) == rises ? a = (a + b) / 2 : b = (a + b) / 2;
  return (a + b) / 2;
}

}  // namespace eomgen::test
