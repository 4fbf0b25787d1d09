// SPDX-License-Identifier: GPL-3.0-or-later
// In: Model. Out: the same system as expressions on one Dag: positions, energies, applied loads, constraints, and the
// coordinates that constraints fix. Theory: docs/theory.md, eqs. (1.31), (2.20), (2.31), (3.20).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/vectors.hpp"

namespace eomgen::mechanics {

using symbolic::Dag;
using symbolic::Op;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;
using symbolic::Vec3;

struct PointMass {
  std::string name;
  Ref mass;
  Vec3 position;
  Vec3 velocity;  // total time derivative of the position
  std::uint32_t place = 0;
};

/// The rotation of a body: T = w.Jw/2, eq. (6.65), with constant components J along `axes`. The axes are the body's
/// own. If J does not change as the body turns about one of them, they are the axes before its last rotation, which
/// have simpler components.
struct BodyRotation {
  std::string name;
  std::uint32_t frame = 0;
  std::array<Vec3, 3> axes;
  std::array<std::array<Ref, 3>, 3> J;
  std::array<Ref, 3> w;                      // along `axes`
  std::array<Ref, 3> axes_angular_velocity;  // angular velocity of `axes`
};

/// A force without a potential, at a moving point.
struct Load {
  std::string name;
  Vec3 force;
  Vec3 at;
  Vec3 at_velocity;
};

enum class ConstraintKind { holonomic, velocity };

/// Whether a constraint equation is independent. An identity holds for all coordinates. A redundant equation follows
/// from the other constraints. Both are neither imposed nor active and have no multiplier.
enum class Redundancy { independent, identity, redundant };
const char* name(Redundancy need);  // "independent", "identity", "redundant"

/// One scalar equation: psi(q, t) = 0, or f . qdot + b = 0 with f(q, t), b(q, t). In both cases the force on the system
/// is lambda f, eqs. (2.31), (2.50), with f = d psi/d q for a holonomic constraint.
struct Constraint {
  std::string name;   // "sphere"
  std::string label;  // "sphere", or "sphere.2" where the constraint has several equations
  ConstraintKind kind = ConstraintKind::holonomic;
  Ref psi;                                          // 0 for a velocity constraint
  std::vector<Ref> gradient;                        // f_i, all coordinates
  Ref rate;                                         // b: d psi/d t at fixed q
  model::NodeId model_expression = model::no_node;  // psi or the velocity form, in the model
  bool unilateral = false;                          // psi >= 0: never eliminated
  Redundancy redundancy = Redundancy::independent;
  bool determined = true;                    // whether the motion determines its force; for joints see JointReaction
  std::optional<std::uint32_t> force_input;  // of a contact whose force is an input (contact_forces.hpp): its index

  bool holonomic() const { return kind == ConstraintKind::holonomic; }
};

/// psi = 0 solved for q_c = value(t). The coordinate is eliminated (Approach I and II, eqs. (2.96)-(2.101)).
struct FixedCoordinate {
  std::uint32_t coordinate;
  std::uint32_t constraint;
  Ref value, rate, acceleration;  // functions of t and parameters (and of `function` symbols)
};

enum class Integrability { yes, no, unknown };
const char* name(Integrability verdict);

/// The result of the integrability test of a constraint. Holonomic constraints are their own integral.
struct ConstraintClassification {
  Integrability integrable = Integrability::yes;
  std::string reason;  // a sentence; empty for holonomic constraints
};

/// psi(q, t) of free coordinates, t and independent parameters. Velocity constraints keep it at its start value.
struct ConstraintIntegral {
  std::string label;                       // of the constraint that it replaces
  std::vector<std::uint32_t> constraints;  // d psi is a combination of these constraints
  Ref psi;
};

/// A contact that blocks sliding along sum_a along_a t_a while it is closed, such as a stop at the end of a rough
/// guide, or constraints that always hold. Along this direction the motion does not determine the friction, which is
/// taken to be 0.
struct BlockedDirection {
  std::uint32_t by = 0;    // index into Mechanics::contacts; own index: always blocked
  std::vector<Ref> along;  // per tangent; not normalised
};

/// A place where a friction law acts: a particle on a surface (one constraint) or a curve (two), a body on a plane or
/// another body, or one coordinate with a given normal force. The friction force is sum_a phi_a t_a with the symbols
/// phi_a = {SymbolKind::friction, first + a}. A unilateral constraint is a contact with or without friction.
struct Contact {
  std::string name;                            // of the constraint or the force
  std::vector<std::uint32_t> constraints;      // 1 or 2 indices; none: the normal force is given
  std::uint32_t place = 0;                     // of the particle; 0 for friction in a coordinate
  std::uint32_t coordinate = 0;                // the coordinate with friction, if place is 0
  std::uint32_t first = 0;                     // index of the first phi
  std::vector<Ref> gram;                       // grad psi_k . grad psi_l at the particle, row-major
  Ref normal;                                  // the given normal force
  std::vector<Vec3> directions;                // t_a, orthonormal; none for friction in a coordinate
  std::vector<std::uint32_t> tangent_indices;  // of a body: which of its two tangents each t_a is, 0 or 1
  std::vector<std::vector<Ref>>
      tangents;           // t_a . dr/dq_i per t_a, all coordinates; of a body t_a . dv/dqdot_i of its point there
  std::vector<Ref> slip;  // t_a . (v - v_s)
  std::vector<BlockedDirection> blocked;
  Ref static_coefficient, dynamic_coefficient;  // may depend on the slip speed; the first is empty with a width
  std::optional<Ref> width;                     // of the smooth law -mu |N| w / sqrt(w^2 + width^2)
  bool unilateral = false;                      // its one constraint can open
  Ref restitution;                              // of impacts, if unilateral
  std::optional<std::uint32_t> body_contact;    // of a body: index into Model::constraints
  bool rolls = false;                           // sticking means rolling: the contact point moves over the body
  std::optional<std::uint32_t>
      first_input;  // of its friction, then of its mode, if they are inputs (contact_forces.hpp)

  std::size_t dimensions() const { return tangents.size(); }
};

/// The force of a joint on B, then the moment about its point of B, along the axes of the model::Joint. Component j is
/// sum_k along[j][k] lambda_(first + k).
struct JointReaction {
  std::uint32_t first = 0;  // of its constraints
  std::array<std::vector<Ref>, model::joint_components> along;
  /// False if redundant equations leave a component undetermined by the motion.
  std::array<bool, model::joint_components> determined{true, true, true, true, true, true};

  std::size_t equations() const { return along[0].size(); }
};

struct Mechanics {
  // Defined in mechanics.cpp, so that they are compiled only once.
  Mechanics();
  Mechanics(const Mechanics&);
  Mechanics(Mechanics&&) noexcept;
  Mechanics& operator=(const Mechanics&);
  Mechanics& operator=(Mechanics&&) noexcept;
  ~Mechanics();

  std::shared_ptr<const model::Model> model;
  std::shared_ptr<Dag> dag;  // later stages add nodes to it

  std::vector<Ref> q, qdot, qddot;  // all coordinates of the model
  Ref t;

  std::vector<PointMass> masses;             // particles, then bodies with all their mass at the centre
  std::vector<BodyRotation> body_rotations;  // per Model::bodies entry
  Ref kinetic_given;                         // of [energy], 0 if none
  Ref kinetic;                               // sum m/2 v.v + kinetic_given, with the unconstrained coordinates
  Ref potential;                             // of all conservative forces, and of [energy]
  Ref stored;                                // energy of states of first order, as the model states it; 0 if none
  std::vector<Ref> potential_by_force;       // per Model::forces entry, 0 where the force is a Load
  std::vector<Load> loads;
  std::vector<std::vector<Ref>> force_components;  // per Model::forces entry: its Q_i without the potential, with loads

  std::vector<Constraint> constraints;
  std::vector<FixedCoordinate> fixed;  // in the order of elimination
  std::vector<std::uint32_t> free;     // coordinates that are not eliminated, ascending
  std::vector<std::uint32_t> active;   // constraints with multipliers, ascending

  std::vector<ConstraintClassification> classification;  // per constraint
  std::vector<ConstraintIntegral> integrals;
  std::vector<JointReaction> joints;  // per Model::joints entry
  std::vector<Contact> contacts;  // constraints with friction or unilateral in the order of the model, then dry forces

  std::vector<Ref> event;                            // per Model::events entry: its sign changes at the event
  std::vector<Ref> function_value;                   // per Model::functions entry, as an expression of t
  std::vector<Ref> parameter_value;                  // per parameter, of other parameters or constants
  std::vector<std::optional<Vec3>> place_position;   // per Model::places entry
  std::vector<Ref> scalar_definition;                // per definition; 0 for vectors
  std::vector<std::array<Ref, 3>> angular_velocity;  // per Model::frames entry, along its own axes

  /// Whether the forces of contacts are inputs, which a run computes (contact_forces.hpp).
  bool has_contact_inputs() const { return !contacts.empty() && contacts.front().first_input.has_value(); }
  bool is_eliminated(std::uint32_t coordinate) const;
  /// Degrees of freedom: free coordinates minus constraints that always hold.
  long degrees_of_freedom() const;
  /// Whether a constraint is independent: imposed or active.
  bool is_independent(std::uint32_t constraint) const {
    return constraints[constraint].redundancy == Redundancy::independent;
  }
  /// f . qdot + b of a constraint.
  Ref velocity_form(const Constraint& constraint) const;
};

/// Builds the model on a Dag and classifies its constraints. Throws Error{stage "mechanics"} for a constraint or force
/// that changes no equation, and for a coordinate without inertia that nothing determines.
Mechanics build_mechanics(std::shared_ptr<const model::Model> model);

/// The same with a copy of the model.
inline Mechanics build_mechanics(model::Model model) {
  return build_mechanics(std::make_shared<const model::Model>(std::move(model)));
}

/// The friction force of a body along tangent 0 or 1; 0 if that tangent is omitted.
Ref rolling_friction(const Mechanics& mechanics, const Contact& contact, std::uint32_t tangent);

/// J v, and the angular momentum H = J w, along the axes of the rotation.
std::array<Ref, 3> inertia_times(Dag& dag, const BodyRotation& spin, const std::array<Ref, 3>& v);
std::array<Ref, 3> angular_momentum(Dag& dag, const BodyRotation& spin);

/// The symbol of Model::states[index].
symbolic::Symbol state_symbol(const model::Model& model, std::uint32_t index);

/// Any expression of the model on the Dag of `mechanics` (scalars only).
Ref lower_scalar(Mechanics& mechanics, model::NodeId expression);
Vec3 lower_vector(Mechanics& mechanics, model::NodeId expression);

}  // namespace eomgen::mechanics
