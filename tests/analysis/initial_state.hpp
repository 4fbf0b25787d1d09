// SPDX-License-Identifier: GPL-3.0-or-later
// A model with its drawing and forces, at the start of its default scene.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "analysis/drawing/forces.hpp"
#include "derive/formulations/lagrange.hpp"
#include "run/scene.hpp"
#include "support/folders.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::test {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

inline constexpr double rounding = 1e-12;  // relative, for values at the start

struct InitialState {
  explicit InitialState(model::Model given)
      : model(std::move(given)),
        m(mechanics::build_mechanics(model)),
        drawing(m),
        forces(m, drawing),
        system(derive::lagrange(m, system::Approach::two)) {
    scene = run::resolve_scene(m, system, m.model->scene("default"), {});
    forces.add_outputs(system);
  }

  /// Values of expressions. Accelerations and multipliers require solve().
  std::vector<double> values(const std::vector<Ref>& expressions) const {
    return symbolic::evaluate(*m.dag, expressions, [&](const Symbol& s) -> double {
      switch (s.kind) {
        case SymbolKind::time: return scene.t0;
        case SymbolKind::parameter: return scene.parameters[s.index];
        case SymbolKind::coordinate:
          if (s.order == 0) return scene.q[s.index];
          if (s.order == 1) return scene.qdot[s.index];
          for (std::size_t i = 0; i < system.free.size(); ++i) {
            if (system.free[i] == s.index) return solved[static_cast<Eigen::Index>(i)];
          }
          return std::nan("");
        case SymbolKind::multiplier:
          for (std::size_t k = 0; k < system.active.size(); ++k) {
            if (system.active[k] == s.index) return solved[static_cast<Eigen::Index>(system.free.size() + k)];
          }
          return std::nan("");
        default: return std::nan("");
      }
    });
  }
  void solve() {
    const auto n = static_cast<Eigen::Index>(system.free.size()), k = static_cast<Eigen::Index>(system.active.size());
    const std::vector<double> M = values(system.M), f = values(system.f), A = values(system.A),
                              g = values(system.gamma);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + k, n + k);
    Eigen::VectorXd right(n + k);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) all(i, j) = M[static_cast<std::size_t>(i * n + j)];
      right[i] = f[static_cast<std::size_t>(i)];
    }
    for (Eigen::Index i = 0; i < k; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        all(n + i, j) = A[static_cast<std::size_t>(i * n + j)];
        all(j, n + i) = -all(n + i, j);
      }
      right[n + i] = -g[static_cast<std::size_t>(i)];
    }
    solved = all.fullPivLu().solve(right);
  }
  Eigen::Vector3d vector(std::size_t at) const {
    const std::vector<double> v =
        values({drawing.expressions()[at], drawing.expressions()[at + 1], drawing.expressions()[at + 2]});
    return Eigen::Vector3d(v.data());
  }

  model::Model model;
  mechanics::Mechanics m;
  analysis::Drawing drawing;
  analysis::DrawnForces forces;
  system::EquationSystem system;
  run::Scene scene;
  Eigen::VectorXd solved;
};

inline InitialState shipped(const std::string& name) {
  return InitialState(model::read_model(test::source_folder() + "/models/" + name + ".toml"));
}

}  // namespace eomgen::test
