// SPDX-License-Identifier: GPL-3.0-or-later
// The inertial forces and uniform gravity of particles and bodies are linear in their inertial parameters p:
//   M qddot + h = Y(q, qdot, qddot) p.
// In: Mechanics. Out: Y, and the base parameters, the combinations of p on which Y p depends. Parameters of a body
// refer to the place that the model states as its centre of mass, along its own axes: the inertia tensor, the first
// moment (0 in the model), and the mass. A particle has its mass.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "reading/reading.hpp"

namespace eomgen::reading {

struct InertialParameter {
  enum class Kind { mass, moment, inertia } kind = Kind::mass;
  std::uint32_t place = 0;     // of the particle or body
  std::uint32_t i = 0, k = 0;  // axes: of the moment, i; of the entry of the tensor, i and k
  Sum value;                   // in the model
};

struct BaseParameter {
  std::size_t parameter = 0;                         // its own column
  std::vector<std::pair<std::size_t, Sum>> further;  // columns that are multiples of it, with their factors
};

struct Regressor {
  std::vector<InertialParameter> parameters;
  std::vector<std::vector<Sum>> columns;    // per parameter: one entry per free coordinate; none if they are too long
  std::vector<BaseParameter> base;          // p_b + sum factor p_k
  std::vector<std::size_t> without_effect;  // parameters whose columns are 0
  std::string base_left_out;                // why there are no base parameters; empty if there are
};

Regressor regressor(const mechanics::Mechanics& mechanics);

}  // namespace eomgen::reading
