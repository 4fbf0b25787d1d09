// SPDX-License-Identifier: GPL-3.0-or-later
// The linearisation of a scene of a shipped model, or of one with added scenes.
#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "analysis/steady.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

namespace eomgen::test {

/// Tolerance of 160 digits rounded to binary64: the last digit, and those of the reference closed form.
inline constexpr double linear_tolerance = 1e-12;

struct Linearised {
  analysis::SteadyProblem problem;
  linear::Linearisation l;

  double parameter(const std::string& name) const {
    const auto& parameters = problem.derived->model.parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].name == name) return problem.scene.parameters[i];
    }
    throw std::logic_error("no parameter " + name);
  }
  std::size_t state(const std::string& name) const {
    const auto& y = l.symmetry.chart.independent;
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (problem.flow->names()[y[k]] == name) return k;
    }
    throw std::logic_error("no state " + name);
  }
  double A(const std::string& row, const std::string& column) const {
    return linear::to_double(l.A(state(row), state(column)));
  }
  double B(const std::string& row, std::size_t input) const { return linear::to_double(l.B(state(row), input)); }
  double at(const std::string& name) const {
    const auto& names = problem.flow->names();
    return linear::to_double(
        l.z[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]);
  }
  /// The n-th eigenvalue by falling real part, then imaginary part.
  const linear::Eigenvalue& value(std::size_t n) const { return l.spectrum.values.at(n); }
  std::size_t zeros() const { return l.spectrum.zeros; }
};

/// `more` is appended to the model: further scenes.
inline Linearised linearised(const std::string& model, const std::string& scene = "default",
                             const std::string& more = "", const std::map<std::string, symbolic::Rational>& set = {},
                             std::optional<double> at = {}) {
  std::string path = model_path(model);
  if (!more.empty()) {
    const std::string text = read_text(path) + more;
    path = test::build_folder() + "/" + model + "_" + scene + "_linear.toml";
    write_text(path, text);
  }
  run::Overrides overrides;
  overrides.values = set;
  analysis::SteadyProblem problem =
      analysis::steady_problem("linearize", test::model_at(path), scene, overrides, at, 1, analysis::Contacts::none);
  linear::Linearisation l = linear::linearise(*problem.flow, problem.z, problem.setting, problem.neighbours, 1);
  return {std::move(problem), std::move(l)};
}

inline void same(double a, double b) { CHECK(a == doctest::Approx(b).epsilon(linear_tolerance).scale(1e-3)); }

}  // namespace eomgen::test
