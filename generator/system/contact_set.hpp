// SPDX-License-Identifier: GPL-3.0-or-later
// The layout of what runs need of contacts whose forces are inputs. In: an EquationSystem. Out: their places in the
// array c of the function contact_rows, and among the inputs. Slopes that vanish identically have no place.
#pragma once

#include <eom/contacts/description.hpp>

#include "system/equation_system.hpp"

namespace eomgen::system {

eom::contacts::Set contact_set(const EquationSystem& system);

}  // namespace eomgen::system
