// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts in variational equations: their modes, which several states beside one another share, and the change of the
// state where a mode ends. In: the equations, the function of a contact that crossed zero. Out: time, state and modes
// after impacts.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "run/variational_equations.hpp"

namespace eomgen::run {

/// The modes of all contacts, with the history that decides the next ones.
struct ContactSnapshot {
  eom::ModeArray mode;  // of the model
  std::optional<eom::hybrid::ContactModes::State> modes;
  std::optional<eom::hybrid::SolvedContacts::State> solved;

  /// Whether the contacts of another snapshot are in the same modes.
  bool has_modes_of(const ContactSnapshot& other) const;
};

ContactSnapshot save_contacts(const VariationalEquations& in);
/// Puts the contacts into the modes of a snapshot of the same problem. Their coefficients of restitution stay.
void restore_contacts(VariationalEquations& in, const ContactSnapshot& from);

/// Sets what integrate_events monitors of the contacts, in an array of all event functions.
void watch_contacts(VariationalEquations& in, std::span<eom::EventFunction> functions);

/// Applies the law of contacts where event function `crossing` is 0: t and x are those after it. Throws Error{stage
/// "run"} if it ends the run.
void change_contacts(VariationalEquations& in, const eom::Crossing& crossing, double& t, std::vector<double>& x);

/// The bound of slip, or of static friction, of a contact with two directions.
struct SlipBound {
  std::size_t contact = 0;
  bool ends = false;              // the slip ends; else it begins
  std::array<double, 2> along{};  // the slip at its end, which has the least speed
};
/// The bound that event function `crossing` stands for; nothing if it is another one.
std::optional<SlipBound> bound_of_slip(VariationalEquations& in, const eom::Crossing& crossing, double t,
                                       const std::vector<double>& x);
/// The slip of a contact with two directions.
std::array<double, 2> slip_of(VariationalEquations& in, std::size_t contact, double t, const std::vector<double>& x);

/// Evaluates the rows of contacts whose forces are solved for. Returns a code.
int evaluate_contact_rows(VariationalEquations& in, double t, const double* x);
/// The slip in two directions of contact j at the last rows.
std::array<double, 2> slip_at_rows(const eom::contacts::ContactForces& forces, std::size_t j);

/// A change of a contact whose forces the motion does not determine: slip of feet that begins at the same time, or a
/// contact that opens. The forces are some within their laws, and no smooth functions of the state. In the new modes
/// they are determined, and the change begins where its acceleration is 0 with static friction.
struct ImpendingMotion {
  std::size_t contact;
  ContactSnapshot before, after;
  double scale;  // of accelerations

  /// The acceleration of the slip or of the gap that begins, plus the scale. NaN: it has no value.
  double acceleration(VariationalEquations& in, double t, const std::vector<double>& x) const;
};
/// Nothing if the forces before the change are determined, or if it is another one.
std::optional<ImpendingMotion> impending_motion(VariationalEquations& in, const eom::Crossing& crossing, double t,
                                                const std::vector<double>& x, const ContactSnapshot& before,
                                                const ContactSnapshot& after);

/// The name of a contact that has bounced several times and stays closed from this change on; empty if there is none.
std::string ended_bounces(const VariationalEquations& in, const ContactSnapshot& before, const ContactSnapshot& after);

}  // namespace eomgen::run
