// SPDX-License-Identifier: GPL-3.0-or-later
// What can be asked of equations of motion: what it is, of what, in which unit, for whom. The name is for readers, and
// for those who ask; nothing is told by it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::system {

/// What an output is, and so what Output::index counts.
enum class OutputKind : std::uint8_t {
  // of a coordinate of the model
  coordinate,
  rate,
  acceleration,
  momentum,
  // of the whole
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
  mode,
  definition,  // of the model
  integral,    // of constraints on velocities: of Mechanics::integrals
  // of the constraints that prescribe a motion: on a coordinate, on a particle (part: axis), all together
  prescribed_force,
  particle_force,
  prescribed_power,
  // For runs.
  slip_slope,          // of a contact, by the rate of a free coordinate, in their order; part: tangent
  friction_component,  // of a contact along a tangent, which is `part`
  restitution,         // of a contact
  redundant,           // psi of a constraint of Mechanics that the others make hold
  differential,        // of Mechanics::integrals, by the free coordinates in their order, then by t
  magnitude,           // size of the terms of a conserved quantity, counted as conserved_quantities gives them
  time_integral,       // of the model
  drawn                // part: axis; index: as who draws counts
};

/// Who asks for an output: whoever reads tables, or the run itself.
enum class Audience : std::uint8_t { reader, run };
constexpr Audience audience(OutputKind kind) {
  return kind < OutputKind::slip_slope ? Audience::reader : Audience::run;
}
constexpr bool is_reaction(OutputKind kind) {
  return kind >= OutputKind::constraint_reaction && kind <= OutputKind::rolling_reaction;
}

struct Output {
  std::string name;     // "R", "R_dot", "energy", "power", "P.position1", ...
  symbolic::Ref value;  // may use qddot of free coordinates and multipliers
  OutputKind kind;
  std::uint32_t index = 0, part = 0;
  std::string unit = {};    // "m/s^2"; empty where it is unknown or a pure number
  std::string vector = {};  // "reaction.pin": the name by which all components are asked for at once; none: ""
};

/// Of this name, or none.
const Output* find(const std::vector<Output>& outputs, const std::string& name);

/// The names of all of a kind that belong to `index`, in their order.
std::vector<std::string> names_of(const std::vector<Output>& outputs, OutputKind kind, std::uint32_t index = 0);

/// "m" -> "m/s", "m/s^2" as it is divided by the second once or twice; a pure number that has no unit keeps none.
std::string per_second(const std::string& unit, int times = 1);

}  // namespace eomgen::system
