// SPDX-License-Identifier: MIT
// Jumps of energies, momenta or constraints: the velocity of a support at a kink of its motion, a step of a potential.
// In: functions that may jump, values of their parameters. Out, at a kink in time: the velocities without the impulses
// of constraints, with the same momenta dL/dqdot before and after. Out, at a kink in the state: the jumping quantity,
// whose effect the equations leave undetermined.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eom/expressions/code.hpp"
#include "eom/hybrid/momentum_jump.hpp"
#include "eom/hybrid/problem.hpp"

namespace eom::hybrid {

/// Jumps of potentials, momenta, constraints and velocities at kinks of the equations.
class Jumps {
 public:
  /// layout: of the state. inputs: their number. breakpoints: whether there are kinks in time in the span.
  Jumps(const JumpFunctions& of, const StateLayout& layout, std::size_t inputs, std::span<const double> parameters,
        bool breakpoints)
      : of_(of), n_(layout.coordinates), states_(layout.size()), inputs_(inputs) {
    if (of.functions.empty()) return;
    code_ = expressions::Code(of.values, parameters);
    for (std::size_t k = 0; k < code_.kinks(); ++k) {
      if (!code_.depends_on_state(k)) {
        has_time_kinks_ = has_time_kinks_ || breakpoints;
        continue;
      }
      if (!code_.jumps(k)) continue;
      const bool known = std::any_of(surfaces_.begin(), surfaces_.end(),
                                     [&](std::size_t other) { return code_.have_same_surface(k, other); });
      if (!known) surfaces_.push_back(k);
    }
    if (has_time_kinks_) mass_ = expressions::Code(of.mass, parameters);
  }
  /// Those of a problem.
  explicit Jumps(const Problem& problem)
      : Jumps(problem.jumps, problem.code->layout(), problem.inputs.size(), problem.parameters,
              !problem.breakpoints.empty()) {}

  /// No function jumps, whatever the motion.
  bool none() const { return !has_time_kinks_ && surfaces_.empty(); }
  /// Whether a function may jump at a kink in time.
  bool has_time_kinks() const { return has_time_kinks_; }

  /// Crosses a kink in time: changes the velocities in `x` to those after it without impulses of constraints.
  Impulse cross_time_kink(const MotionPoint& before, double after, const double* u_after, std::span<double> x) const {
    Impulse impulse;
    const double later = after + far * (std::abs(after) > 0 ? std::abs(after) : 1);
    const auto at = [&](double t, const double* u) -> const std::vector<double>& {
      return variables({t, before.x, u});
    };
    std::array<std::vector<double>, 3> values;
    for (auto& v : values) v.resize(code_.roots());
    code_.values(at(before.t, before.u), values[0]);
    code_.values(at(after, u_after), values[1]);
    code_.values(at(later, u_after), values[2]);
    const Sizes size = sizes(values[0], values[1], before.x);
    std::vector<double> change(n_);
    std::size_t row = 0;
    bool momentum = false;
    for (std::size_t i = 0; i < of_.functions.size(); ++i) {
      const Quantity what = of_.functions[i].what;
      const double by = std::abs(values[1][i] - values[0][i]), on = std::abs(values[2][i] - values[1][i]);
      const bool jump = by > std::max(rounding * size[static_cast<std::size_t>(what)], part_of_far * on) &&
                        by > 1e-14 * std::max(std::abs(values[0][i]), std::abs(values[1][i]));
      if (what == Quantity::momentum) {
        change[row++] = jump ? values[0][i] - values[1][i] : 0;
        momentum = momentum || jump;
      }
      if (!jump) continue;
      impulse.potential = impulse.potential || what == Quantity::potential;
      impulse.velocities = impulse.velocities || what != Quantity::potential;
      if (what == Quantity::velocity && impulse.what.empty()) impulse.what = of_.functions[i].name;
      if (what != Quantity::psi && what != Quantity::place) continue;
      impulse.undetermined = {Reason::Kind::position_jump, after, values[1][i] - values[0][i], name(i)};
      return impulse;
    }
    if (!momentum) return impulse;
    std::vector<double> M(n_ * n_);
    mass_.values(at(after, u_after), M);
    const std::vector<double> moved = rates_of_momenta(M, change);
    for (std::size_t i = 0; i < n_; ++i) x[n_ + i] += moved[i];
    return impulse;
  }

  /// Number of surfaces in the state at which a function may jump. Their values are positive on one side.
  std::size_t surfaces() const { return surfaces_.size(); }
  /// The values of the surfaces: as many as surfaces().
  void values(const MotionPoint& at, double* g) const {
    code_.values(variables(at), {});
    for (std::size_t i = 0; i < surfaces_.size(); ++i) g[i] = code_.surface(surfaces_[i]);
  }

  /// The jump at a surface, or none. is_open(k): active constraint k does not act, and may jump.
  template <class IsOpen>
  Reason cross_surface(const MotionPoint& at, std::size_t surface, IsOpen&& is_open) {
    std::array<std::vector<double>, 2> sides;
    for (const int side : {0, 1}) {
      for (std::size_t k = 0; k < code_.kinks(); ++k) {
        if (code_.have_same_surface(k, surfaces_[surface])) code_.freeze(k, side == 0 ? -1 : 1);
      }
      auto& values = sides[static_cast<std::size_t>(side)];
      values.resize(code_.roots());
      code_.values(variables(at), values);
    }
    code_.release();
    const Sizes size = sizes(sides[0], sides[1], at.x);
    for (std::size_t i = 0; i < of_.functions.size(); ++i) {
      const double change = sides[1][i] - sides[0][i];
      const JumpFunctions::Function& function = of_.functions[i];
      if (!(std::abs(change) > rounding * size[static_cast<std::size_t>(function.what)])) continue;
      const bool constrains =
          function.what == Quantity::psi || function.what == Quantity::row || function.what == Quantity::rate;
      if (constrains && is_open(function.constraint)) continue;
      return {Reason::Kind::branch_jump, at.t, change, name(i)};
    }
    return {};
  }

 private:
  using Quantity = JumpFunctions::Quantity;
  static constexpr std::size_t kinds = 7;
  using Sizes = std::array<double, kinds>;
  static constexpr double rounding = 1e-9;     // of the jumping quantity: smaller differences are ignored
  static constexpr double far = 1e-6;          // of the time: the distance over which a regular change is measured
  static constexpr double part_of_far = 1e-4;  // a change below this fraction of the regular change is not a jump

  const std::vector<double>& variables(const MotionPoint& at) const {
    variables_.assign(1, at.t);
    variables_.insert(variables_.end(), at.x.begin(), at.x.begin() + static_cast<std::ptrdiff_t>(states_));
    variables_.insert(variables_.end(), at.u, at.u + inputs_);
    return variables_;
  }

  std::string name(std::size_t function) const {
    switch (of_.functions[function].what) {
      case Quantity::potential: return "the potential energy";
      case Quantity::momentum: return "the kinetic energy";
      case Quantity::psi: return "the place where a constraint holds";
      case Quantity::row: return "the direction of a constraint";
      case Quantity::rate: return "the rate of a constraint";
      default: return of_.functions[function].name;
    }
  }

  /// Size of each kind of function, including its reference: the kinetic energy for a potential, coordinates and rates
  /// for a constraint.
  Sizes sizes(const std::vector<double>& one, const std::vector<double>& other, std::span<const double> x) const {
    Sizes size{};
    const auto of = [&](Quantity what) -> double& { return size[static_cast<std::size_t>(what)]; };
    double energy = 0, position = 0, rate = 0;
    for (std::size_t i = 0, k = 0; i < of_.functions.size(); ++i) {
      const Quantity what = of_.functions[i].what;
      of(what) = std::max({of(what), std::abs(one[i]), std::abs(other[i])});
      if (what == Quantity::momentum) energy += std::abs(one[i] * x[n_ + k++]) / 2;
    }
    for (std::size_t i = 0; i < n_; ++i) {
      position = std::max(position, std::abs(x[i]));
      rate = std::max(rate, std::abs(x[n_ + i]));
    }
    of(Quantity::potential) += energy;
    of(Quantity::place) += position;
    of(Quantity::velocity) += rate;
    of(Quantity::psi) += of(Quantity::row) * position;
    of(Quantity::rate) += of(Quantity::row) * rate;
    return size;
  }

  const JumpFunctions& of_;
  std::size_t n_, states_, inputs_;
  bool has_time_kinks_ = false;
  expressions::Code code_, mass_;
  std::vector<std::size_t> surfaces_;  // kinks of code_, one per surface
  mutable std::vector<double> variables_;
};

}  // namespace eom::hybrid
