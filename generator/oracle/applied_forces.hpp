// SPDX-License-Identifier: GPL-3.0-or-later
// Forces of a Model as the oracle computes them, each kind in its own file of oracle/forces/.
#pragma once

#include <vector>

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

/// Subtracts Q_i of every force of the model from sums[i]; `now` holds the state.
void subtract_forces(const model::Model& model, const Precision& precision, Interpreter& now,
                     std::vector<Residual>& sums);

/// U of [energy] and of every force that has one (uniform gravity, attraction, springs), term by term.
std::vector<Jet> potentials(const model::Model& model, const Precision& precision, Interpreter& at);

/// The mass of a particle, or of a body at its centre of mass.
struct Mass {
  std::uint32_t place;
  model::NodeId mass;
};
std::vector<Mass> list_masses(const model::Model& model);

/// J v, with the inertia tensor of a body along its current axes.
Vector inertia_times(const model::Body& body, Interpreter& at, const Vector& v);

/// |difference| / scale as a binary64; 0 if both vanish, 1 if only the scale does.
double relative_difference(const Real& difference, const Real& scale);

}  // namespace eomgen::verify
