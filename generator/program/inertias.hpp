// SPDX-License-Identifier: GPL-3.0-or-later
// In: the motions of bodies and particles, their masses and inertia tensors. Out: the functions `regressor` and
// `momentum` of the ABI.
//
// A body of mass m, first moment mc and inertia tensor I about a place with the acceleration a, less that of gravity,
// needs the force m a + alpha x mc + w x (w x mc) there, and the moment I alpha + w x I w + mc x a. Their virtual work
// by the Jacobians of the place and of the rotation is linear in the parameters (Siciliano et al., Robotics, 2009,
// section 7.2.2). The momentum matrix is that of Orin and Goswami, IROS 2008.
#pragma once

#include <map>
#include <vector>

#include "program/abi_functions.hpp"
#include "system/frame.hpp"
#include "system/inertia.hpp"

namespace eomgen::program {

class InertiaFunctions {
 public:
  /// `free`: the coordinates whose rates are the columns of Jacobians. `fix`: values that replace parameters.
  InertiaFunctions(Dag& dag, std::vector<system::Frame> frames, system::Inertias inertias,
                   const std::vector<std::uint32_t>& free, const std::map<std::uint32_t, symbolic::Rational>& fix);

  FunctionExpressions regressor() const;
  FunctionExpressions momentum() const;

 private:
  using Vec3 = std::array<Ref, 3>;

  Vec3 slope(const Vec3& of, std::size_t coordinate) const;
  Vec3 linear(const system::Inertia& of, std::size_t coordinate) const;
  Vec3 along_axes(const system::Frame& frame, const Vec3& v) const;
  Vec3 along_fixed(const system::Frame& frame, const Vec3& v) const;
  Vec3 times(const system::BodyInertia& body, const Vec3& v) const;

  Dag& dag_;
  std::vector<system::Frame> frames_;
  system::Inertias inertias_;
  std::vector<std::uint32_t> free_;
};

}  // namespace eomgen::program
