// SPDX-License-Identifier: GPL-3.0-or-later
// The impulse of a support at a kink in time, in many digits, for reference solutions. In: the equations, the state
// before the kink. Out: the velocities behind it. The momenta dL/dqdot are equal before and behind it, apart from the
// impulses of constraints: M (qdot+ - qdot-) = -(p+ - p-) + A^T Lambda, with A qdot+ + b+ = 0.
#pragma once

#include <cln/float.h>

#include <vector>

#include "system/equation_system.hpp"

namespace eomgen::analysis {

class ImpulseInDigits {
 public:
  /// `parameters` has to outlive this object. The system has no contacts.
  ImpulseInDigits(const system::EquationSystem& system, const std::vector<double>& parameters);

  /// The two times of a kink, and the inputs there.
  struct Kink {
    double before, behind;
    std::vector<double> u_before, u_behind;
  };
  /// Changes the rates in x = (q, qdot, integrals).
  void apply(const Kink& kink, std::vector<cln::cl_F>& x, int digits) const;
  /// Changes rates by impulses of the constraints alone, until they satisfy the constraints.
  void make_consistent(const cln::cl_R& t, const std::vector<double>& u, std::vector<cln::cl_F>& x, int digits) const;

 private:
  std::vector<cln::cl_R> values(const std::vector<symbolic::Ref>& roots, const cln::cl_R& t,
                                const std::vector<double>& u, const std::vector<cln::cl_F>& x, int digits) const;
  /// Changes the rates by an impulse and those of the constraints.
  void change(const std::vector<cln::cl_R>& impulse, const cln::cl_R& t, const std::vector<double>& u,
              std::vector<cln::cl_F>& x, int digits) const;

  const system::EquationSystem& system_;
  const std::vector<double>& parameters_;
  std::vector<symbolic::Ref> momenta_;
};

}  // namespace eomgen::analysis
