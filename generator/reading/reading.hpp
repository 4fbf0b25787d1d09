// SPDX-License-Identifier: GPL-3.0-or-later
// The product of this stage: the equations of motion in display form. In: Mechanics. Out: energies, Lagrange's
// equations by Approach I (2.96)-(2.98) or II (2.99)-(2.101), constraint forces, the geometry of coordinates
// (1.20)-(1.32), (2.184)-(2.185), singular sets. Theory: docs/theory.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "reading/formula.hpp"
#include "reading/power_of_sum.hpp"
#include "system/equation_system.hpp"

namespace eomgen::reading {

using Components = std::array<Sum, 3>;
using mechanics::Mechanics;

/// The budget, in products and sums of two terms, of a form, and of one formula displayed beside it. Results over
/// budget are omitted, on every machine the same.
inline constexpr std::size_t form_budget = 5'000'000, item_budget = 200'000;

using work::LeftOut;

/// One constraint psi = 0, with its first and second total time derivatives. For a velocity constraint, `rate` is its
/// left-hand side.
struct DisplayConstraint {
  std::uint32_t constraint;  // index into Mechanics::constraints
  std::string label;
  bool holonomic = true;
  Sum psi, rate, acceleration;
  std::string psi_skip_reason, rate_skip_reason,
      acceleration_skip_reason;                     // why they are omitted; empty if they are present
  std::optional<mechanics::FixedCoordinate> fixes;  // if it is q_c = d(t); in Approach II also of other coordinates
  Sum value, value_rate, value_acceleration;        // of that coordinate
};

/// lambda_k dpsi_k/dq_i of one equation.
struct MultiplierTerm {
  std::uint32_t constraint;
  Sum slope;
};

/// d/dt(momentum) - slope = force + sum lambda_k dpsi_k/dq_i.
struct Equation {
  std::uint32_t coordinate;
  bool of_motion;  // false: it determines a constraint force
  Sum momentum;    // dL/dqdot_i
  Sum slope;       // dL/dq_i
  Sum force;       // Q_i = F . dr/dq_i and given generalised forces
  std::vector<MultiplierTerm> multipliers;
  Sum expanded;  // the expanded left-hand side: M qddot + h
};

/// lambda_k as an expression; empty if only the equations of motion together determine it.
struct DisplayReaction {
  std::uint32_t constraint;
  std::string label;
  std::optional<Sum> value;
};

/// A set factor = 0 where the inertia matrix of an approach, or a metric, is singular.
struct SingularSet {
  std::string approach;  // "I", "II", "both"
  Sum factor;
  std::vector<Formula> solutions;  // phi = 0, phi = pi if known
};

/// Rotation of a body: T = sum_ik J_ik w_i w_k/2.
struct DisplayRotation {
  std::string name;
  std::uint32_t frame = 0;
  Components w;
  std::array<Components, 3> J;
};

struct DisplayForm {
  // Defined in reading.cpp, so that they are compiled only once.
  DisplayForm();
  DisplayForm(const DisplayForm&);
  DisplayForm(DisplayForm&&) noexcept;
  DisplayForm& operator=(const DisplayForm&);
  DisplayForm& operator=(DisplayForm&&) noexcept;
  ~DisplayForm();

  system::Approach approach = system::Approach::one;
  bool is_unexpanded = false;  // too large to expand: m r_ddot . dr/dq in place of the expanded equations
  std::string unexpanded_reason;
  Sum kinetic, potential, lagrangian;           // unconstrained for I, constrained for II
  Sum translation;                              // the part of `kinetic` without rotations; 0 if is_unexpanded
  std::vector<DisplayRotation> body_rotations;  // in II with the constraints imposed
  std::string rotations_skip_reason;            // why they are omitted, if bodies rotate
  std::vector<PowerOfSum> powers;               // of the potential: brackets that energies and equations keep
  std::optional<std::array<Sum, 3>> by_degree;  // II: T2, T1, T0, eq. (3.50)
  std::vector<DisplayConstraint> constraints;
  std::vector<Equation> equations;  // I: all coordinates, II: the free ones
  std::vector<DisplayReaction> reactions;
};

/// Derives the equations in display form. Never throws work::BudgetExceeded, but sets is_unexpanded.
DisplayForm derive_display_form(const mechanics::Mechanics& mechanics, system::Approach approach);

/// Curvilinear coordinates of one particle: bases, metric, Christoffel symbols; n = 1, 2 or 3 coordinates.
struct Geometry {
  std::string name;                        // of the particle
  std::vector<std::uint32_t> coordinates;  // n
  std::vector<Components> covariant;       // a_i along E1..E3, eq. (1.20)
  std::vector<Components> contravariant;   // a^i, eq. (1.22)
  std::vector<Components> covariant_unit;  // the same along the chart's unit vectors; empty if it has none
  std::vector<Components> contravariant_unit;
  std::vector<std::optional<std::uint32_t>> unit_names;  // whose coordinate's e_q each unit vector is
  std::vector<Sum> metric, inverse;                      // n x n, eq. (1.31)
  Sum determinant;
  std::vector<Sum> first, second;  // [ij,k] and Gamma^k_ij at (i n + j) n + k, (2.184), (2.185)
  Sum line_element;                // (ds/dt)^2 = a_ik qdot_i qdot_k
  Sum kinetic;                     // T, eq. (1.32)
};

/// The geometry for every particle whose position is given in a chart.
std::vector<Geometry> geometry(const mechanics::Mechanics& mechanics, std::vector<LeftOut>* left_out = nullptr);

/// The configuration manifold: M_ik from T2 (free coordinates, constraints imposed) with its Christoffel symbols. Empty
/// if it is too large. `name` and the bases are empty.
std::optional<Geometry> configuration_space(const mechanics::Mechanics& mechanics,
                                            std::vector<LeftOut>* left_out = nullptr);

/// The sets where the equations of an approach, a potential or a force are singular. Parts that were not examined are
/// reported in `left_out`.
std::vector<SingularSet> singular_sets(const mechanics::Mechanics& mechanics, std::vector<LeftOut>* left_out = nullptr);

/// lhs - rhs of each equation of motion, in the order of DisplayForm::equations, on the Dag of `mechanics`. Symbols: q,
/// qdot, qddot of free coordinates, parameters, functions of time, inputs, multipliers. Empty if form.is_unexpanded.
std::vector<symbolic::Ref> residuals_on_dag(const DisplayForm& form, mechanics::Mechanics& mechanics);

/// A scalar expression as the model's author wrote it, not expanded. Empty if it contains vectors.
std::optional<Formula> as_written(const model::Model& model, model::NodeId expression);

/// Any expression of the Dag, simplified for display. Throws work::BudgetExceeded.
Sum display_sum(const mechanics::Mechanics& mechanics, symbolic::Ref expression);

}  // namespace eomgen::reading
