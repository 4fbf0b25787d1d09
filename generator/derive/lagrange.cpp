// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/lagrange.hpp"

#include "derive/euler_lagrange.hpp"

namespace eomgen::derive {

system::EquationSystem lagrange(Mechanics& m, system::Approach approach) {
  const std::vector<Ref> Q = generalized_forces(m);
  const FullEquations full = euler_lagrange(m, m.kinetic, m.potential, Q, all_coordinates(m));
  if (approach == system::Approach::one) return assemble(m, full, nullptr, "lagrange", approach);
  symbolic::Substitution imposed = impose(m);
  const FullEquations motion = euler_lagrange(m, imposed(m.kinetic), imposed(m.potential), Q, m.free);
  return assemble(m, full, &motion, "lagrange", approach);
}

}  // namespace eomgen::derive
