// SPDX-License-Identifier: GPL-3.0-or-later
// Numerical evaluation of an EquationSystem in tests: values by name, and a reference solution of the index-1 form with
// Eigen.
#pragma once

#include <Eigen/Dense>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "symbolic/evaluate.hpp"
#include "system/equation_system.hpp"

namespace eomgen::test {

/// State, parameters and inputs by name ("theta", "theta_dot", "t", "m"). After solve, accelerations and multipliers
/// are available too ("theta_ddot", "lambda.rod").
class Point {
 public:
  Point(const mechanics::Mechanics& m, std::map<std::string, double> values) : m_(m), values_(std::move(values)) {}

  double operator()(const symbolic::Symbol& s) const {
    using symbolic::SymbolKind;
    static constexpr const char* suffix[] = {"", "_dot", "_ddot"};
    switch (s.kind) {
      case SymbolKind::time: return at("t");
      case SymbolKind::coordinate: return at(m_.model->coordinates[s.index].name + suffix[s.order]);
      case SymbolKind::parameter: return at(m_.model->parameters[s.index].name);
      case SymbolKind::input: return at(m_.model->inputs[s.index].name);
      case SymbolKind::multiplier: return at("lambda." + m_.constraints[s.index].label);
      default: throw std::logic_error("a symbol without a value in this test");
    }
  }

  double evaluate(symbolic::Ref r) const {
    return symbolic::evaluate(*m_.dag, {r}, [this](const symbolic::Symbol& s) { return (*this)(s); })[0];
  }

  /// Solves [M -A^T; A 0][qddot; lambda] = [f; -gamma] and stores the values.
  void solve(const system::EquationSystem& s) {
    const auto n = static_cast<Eigen::Index>(s.free.size()), k = static_cast<Eigen::Index>(s.active.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + k, n + k);
    Eigen::VectorXd right(n + k);
    const auto entry = [this](const std::vector<symbolic::Ref>& v, Eigen::Index i) {
      return evaluate(v[static_cast<std::size_t>(i)]);
    };
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) K(i, j) = entry(s.M, i * n + j);
      right(i) = entry(s.f, i);
    }
    for (Eigen::Index c = 0; c < k; ++c) {
      for (Eigen::Index i = 0; i < n; ++i) {
        K(n + c, i) = entry(s.A, c * n + i);
        K(i, n + c) = -K(n + c, i);
      }
      right(n + c) = -entry(s.gamma, c);
    }
    const Eigen::VectorXd x = K.fullPivLu().solve(right);
    for (Eigen::Index i = 0; i < n; ++i) {
      values_[m_.model->coordinates[s.free[static_cast<std::size_t>(i)]].name + "_ddot"] = x(i);
    }
    for (Eigen::Index c = 0; c < k; ++c) {
      values_["lambda." + m_.constraints[s.active[static_cast<std::size_t>(c)]].label] = x(n + c);
    }
  }

  double at(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) throw std::logic_error("no value for " + name);
    return found->second;
  }

  double reaction(const system::EquationSystem& s, const std::string& label) const {
    for (const system::Reaction& r : s.reactions) {
      if (r.label == label) return evaluate(r.value);
    }
    throw std::logic_error("no reaction " + label);
  }
  double output(const system::EquationSystem& s, const std::string& name) const {
    for (const system::Output& o : s.outputs) {
      if (o.name == name) return evaluate(o.value);
    }
    throw std::logic_error("no output " + name);
  }

 private:
  const mechanics::Mechanics& m_;
  std::map<std::string, double> values_;
};

}  // namespace eomgen::test
