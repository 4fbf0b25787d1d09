// SPDX-License-Identifier: GPL-3.0-or-later
// The outputs of equations of motion: kind, object, unit and audience. The name is for users only; no code interprets
// it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::system {

/// The kind of an output. It determines the list into which Output::index points.
enum class OutputKind : std::uint8_t {
  // of a coordinate of the model
  coordinate,
  rate,
  acceleration,
  momentum,
  state,  // of first order, of the model
  // of the whole system
  energy,
  kinetic,
  potential,
  power,
  jacobi,
  applied_energy,
  linear_momentum,   // part: axis
  angular_momentum,  // part: axis
  // of a place or a frame of the model; part: axis
  position,
  velocity,
  angular_velocity,
  // of a constraint of Mechanics, a joint of the model (part: force, then moment), a contact that rolls (part: tangent)
  constraint_reaction,
  joint_reaction,
  rolling_reaction,
  constraint_force,  // of a place, part: axis; all constraints together
  // of a contact; part: axis of the friction, tangent of the slip
  friction,
  slip,
  gap,  // of one that can open
  mode,
  definition,  // of the model
  integral,    // integral of constraints on velocities: Mechanics::integrals
  // of the constraints that prescribe a motion: on a coordinate, on a particle (part: axis), in total
  prescribed_force,
  particle_force,
  prescribed_power,
  // only for runs
  slip_slope,          // derivative of the slip of a contact with respect to each free rate, in order; part: tangent
  friction_component,  // of a contact; part: tangent
  restitution,         // of a contact
  normal_scale,        // of a contact whose constraint is not a distance
  redundant,           // psi of a redundant constraint of Mechanics
  differential,        // derivatives of Mechanics::integrals: by the free coordinates in order, then by t
  magnitude,           // size of the terms of a conserved quantity; index: as in conserved_quantities
  time_integral,       // of the model
  drawn                // part: axis; index: as defined by the drawing
};

/// The consumer of an output: the reader of tables, or the run itself.
enum class Audience : std::uint8_t { reader, run };
constexpr Audience audience(OutputKind kind) {
  return kind < OutputKind::slip_slope ? Audience::reader : Audience::run;
}
constexpr bool is_reaction(OutputKind kind) {
  return kind >= OutputKind::constraint_reaction && kind <= OutputKind::rolling_reaction;
}

struct Output {
  std::string name;     // "R", "R_dot", "energy", "power", "P.position1", ...
  symbolic::Ref value;  // may depend on qddot of free coordinates and multipliers
  OutputKind kind;
  std::uint32_t index = 0, part = 0;
  std::string unit = {};    // "m/s^2"; empty if it is unknown or a pure number
  std::string vector = {};  // "reaction.pin": the name that selects all components; "": none
};

/// The output of this name, or nullptr.
const Output* find(const std::vector<Output>& outputs, const std::string& name);

/// The names of all outputs of a kind with this index, in order.
std::vector<std::string> names_of(const std::vector<Output>& outputs, OutputKind kind, std::uint32_t index = 0);

/// The unit divided by s, `times` times: "m" -> "m/s", "m/s^2". An empty unit stays empty.
std::string per_second(const std::string& unit, int times = 1);

}  // namespace eomgen::system
