// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts held in the mode of a state, for a linearisation in that mode. In: a SteadyProblem, and the modes that its
// run reports. Out: the modes for linear::Flow, or an error that names the contact on the border of two modes.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "analysis/steady.hpp"

namespace eomgen::analysis {

/// The modes of the contacts of a mechanism that a run reports, in their order; none is open. `reported`: by the name
/// of the contact. A contact whose friction is a smooth function of the slip needs no entry.
std::vector<linear::HeldMode> held_modes(const mechanics::Mechanics& mechanics,
                                         const std::map<std::string, double>& reported);

/// The vector field of the equations with contacts in these modes.
std::unique_ptr<linear::Flow> flow_in_modes(SteadyProblem& problem, const std::vector<linear::HeldMode>& modes);

/// Sets problem.flow with the contacts held. Signs of the normal forces of contacts that cannot open follow from the
/// state of the problem.
void hold_contacts(SteadyProblem& problem, std::vector<linear::HeldMode> modes);

/// Throws Error{stage `command`} if the state lies on the border of two modes: a contact that carries no force,
/// friction at its limit, slip that begins.
void require_inside_modes(const std::string& command, const SteadyProblem& problem);

/// Throws Error{stage `command`} for a contact that is neither open nor presses at the state.
[[noreturn]] void refuse_border(const std::string& command, const model::Model& model, const std::string& contact,
                                const std::string& what);

/// The place of a contact in the model file.
SourceLocation location_of_contact(const model::Model& model, const std::string& contact);

/// The mode in words: "closed", "sticks", "rolls", "slides", "slides back", "smooth friction".
std::string mode_name(const linear::HeldContact& contact);

}  // namespace eomgen::analysis
