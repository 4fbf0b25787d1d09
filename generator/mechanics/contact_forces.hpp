// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts whose forces are inputs of the emitted code. In: the contacts of a model. Out: whether their forces are
// solved for symbolically, one expression for all modes (up to eom::max_contacts of them), or are inputs: per contact
// one for each component of its friction, one for its mode, one for the multiplier of its constraint. Inputs are chosen
// where there are more contacts, where more directions could be held than the system has, and where the model asks for
// a law of impacts. A run then solves complementarity problems (eom/contacts), and the code is linear in the number of
// contacts.
#pragma once

#include <map>

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

/// The inputs that take the place of the symbols of friction and of multipliers of contacts. Empty if none do.
std::map<symbolic::Symbol, symbolic::Symbol> contact_inputs(const Mechanics& mechanics);

/// The input that holds the mode of a contact: 0 sticks or is closed, 1 and -1 slides, 2 is open.
Ref contact_mode(const Mechanics& mechanics, const Contact& contact);

}  // namespace eomgen::mechanics
