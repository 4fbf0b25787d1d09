// SPDX-License-Identifier: MIT
// The members of Instance that compute derivatives of variables by variables. In: value references, a seed. Out: the
// product of the Jacobian with the seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "eom/fmi/instance.hpp"

namespace eom::fmi {

inline double Instance::unknown_at(const Variable& unknown, const std::vector<double>& x,
                                   const std::vector<double>& u) {
  if (unknown.kind == Kind::state) return x[unknown.index];
  if (unknown.kind == Kind::derivative) {
    std::vector<double> dx(x.size());
    rates(x, u, dx);
    return dx[unknown.index];
  }
  std::vector<double> y(y_.size());
  outputs(x, u, y);
  return y[model_.outputs[unknown.index]];
}

/// d(unknowns)/d(knowns) by rows. Derivatives of the state are those of the emitted Jacobians. Outputs, and modes
/// without a Jacobian, have central differences.
inline std::vector<double> Instance::jacobian(std::span<const std::uint32_t> unknowns,
                                              std::span<const std::uint32_t> knowns) {
  if (now_.phase != Phase::running) require_start();
  tune();
  const std::size_t n = now_.x.size();
  std::vector<double> by_state, by_input, dfdt(n);
  bool has_state = false, has_input = false;
  if (exchange_) {
    by_state.resize(n * n);
    by_input.resize(n * now_.u.size());
    has_state = exchange_->jacobian(now_.t, now_.x.data(), by_state.data(), dfdt.data()) == 0;
    has_input = !now_.u.empty() && exchange_->input_jacobian(now_.t, now_.x.data(), by_input.data()) == 0;
  }
  std::vector<double> result;
  for (const std::uint32_t row : unknowns) {
    const Variable of = variable(model_, row);
    if (of.kind != Kind::derivative && of.kind != Kind::output && of.kind != Kind::state)
      throw std::invalid_argument("derivatives exist for derivatives of states and for outputs");
    for (const std::uint32_t column : knowns) {
      const Variable by = variable(model_, column);
      if (by.kind != Kind::state && by.kind != Kind::input)
        throw std::invalid_argument("derivatives exist with respect to states and inputs");
      if (of.kind == Kind::state) {
        result.push_back(by.kind == Kind::state && by.index == of.index ? 1 : 0);
      } else if (of.kind == Kind::derivative && (by.kind == Kind::state ? has_state : has_input)) {
        result.push_back((by.kind == Kind::state ? by_state : by_input)[of.index + n * by.index]);
      } else {
        constexpr double part = 6e-6;  // the cube root of the rounding
        std::vector<double> x = now_.x, u = now_.u;
        double& moved = by.kind == Kind::state ? x[by.index] : u[by.index];
        const double middle = moved, size = part * std::max(1.0, std::abs(middle));
        moved = middle + size;
        const double right = moved, above = unknown_at(of, x, u);
        moved = middle - size;
        result.push_back((above - unknown_at(of, x, u)) / (right - moved));
      }
    }
  }
  return result;
}

inline void Instance::directional_derivative(std::span<const std::uint32_t> unknowns,
                                             std::span<const std::uint32_t> knowns, std::span<const double> seed,
                                             std::span<double> sensitivity) {
  if (seed.size() != knowns.size() || sensitivity.size() != unknowns.size())
    throw std::invalid_argument("the seed has one entry for each known variable, the sensitivity for each unknown one");
  const std::vector<double> J = jacobian(unknowns, knowns);
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    sensitivity[i] = 0;
    for (std::size_t j = 0; j < knowns.size(); ++j) sensitivity[i] += J[i * knowns.size() + j] * seed[j];
  }
}

inline void Instance::adjoint_derivative(std::span<const std::uint32_t> unknowns, std::span<const std::uint32_t> knowns,
                                         std::span<const double> seed, std::span<double> sensitivity) {
  if (seed.size() != unknowns.size() || sensitivity.size() != knowns.size())
    throw std::invalid_argument("the seed has one entry for each unknown variable, the sensitivity for each known one");
  const std::vector<double> J = jacobian(unknowns, knowns);
  for (std::size_t j = 0; j < knowns.size(); ++j) {
    sensitivity[j] = 0;
    for (std::size_t i = 0; i < unknowns.size(); ++i) sensitivity[j] += seed[i] * J[i * knowns.size() + j];
  }
}

}  // namespace eom::fmi
