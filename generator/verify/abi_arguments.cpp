// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/abi_arguments.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include "verify/central_differences.hpp"

namespace eomgen::verify {

AbiArguments arguments_at(const system::EquationSystem& s, const State& state, const std::vector<int>& mode) {
  AbiArguments at{state.t, {}, state.parameters, state.inputs, mode, 4};
  for (const std::uint32_t i : s.free) at.x.push_back(state.q[i]);
  for (const std::uint32_t i : s.free) at.x.push_back(state.qdot[i]);
  for (const system::FirstOrderState& z : s.states) at.x.push_back(state.z[z.symbol.index]);
  // The longest vector of a function: two entries per state.
  for (std::size_t j = 0; j < 2 * at.x.size(); ++j) at.v.push_back(direction_component(j));
  return at;
}

Real rounding_scale(double bound, const Precision& precision) {
  return precision.round(exact(bound) * cln::expt(cln::cl_RA(2), cln::cl_I(53)));
}

}  // namespace eomgen::verify
