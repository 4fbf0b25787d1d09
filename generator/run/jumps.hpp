// SPDX-License-Identifier: GPL-3.0-or-later
// Where energies, momenta or constraints jump: the velocity of a support at a kink of its motion, a step of a
// potential. In: a system and numbers for its parameters. Out: at a kink of time, velocities without the impulses of
// constraints: the momenta dL/dqdot are the same before and after; at a kink of the state, what jumps there, which the
// equations leave open.
#pragma once

#include <array>
#include <eom/hybrid/problem.hpp>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "run/clock.hpp"
#include "run/range_code.hpp"

namespace eomgen::run {

class Jumps {
 public:
  Jumps(const mechanics::Mechanics& mechanics, const system::EquationSystem& system,
        const std::vector<double>& parameters, const Clock& clock);

  /// Nothing jumps anywhere, whatever the motion.
  bool none() const { return !by_time_ && surfaces_.empty(); }
  bool by_time() const { return by_time_; }

  using At = eom::hybrid::Place;
  using Told = eom::hybrid::Impulse;
  /// From just before a kink of time to just after it: changes velocities in `x` to what they are without impulses of
  /// constraints.
  Told cross(const At& before, double after, const double* u_after, std::span<double> x) const;

  /// Surfaces in the state where something may jump: above 0 on one side.
  std::size_t surfaces() const { return surfaces_.size(); }
  void values(const At& at, double* g) const;
  /// What jumps at one of them, or "".
  std::string cross(const At& at, std::size_t surface);

 private:
  enum class What { potential, momentum, psi, row, rate, place, velocity };
  static constexpr std::size_t kinds = 7;
  const std::vector<double>& variables(const At& at) const;
  std::array<double, kinds> sizes(const std::vector<double>& one, const std::vector<double>& other,
                                  std::span<const double> x) const;
  std::string name(std::size_t root) const;

  std::size_t n_ = 0, inputs_ = 0, integrals_ = 0;
  bool by_time_ = false;
  RangeCode code_, mass_;
  std::vector<What> what_;             // per root of code_
  std::vector<std::string> names_;     // of places and velocities, per root of code_
  std::vector<std::size_t> surfaces_;  // kinks of code_, one of each surface
  mutable std::vector<double> variables_;
};

}  // namespace eomgen::run
