// SPDX-License-Identifier: GPL-3.0-or-later
// Names are resolved in the order of their dependencies; what users see (the array p, columns, tables) is in the order
// in which they declared them.
#pragma once

#include "model/model.hpp"

namespace eomgen::model {

/// Puts parameters, functions and definitions into the order of the file, in all expressions and scenes too.
void restore_declared_order(Model& model);

}  // namespace eomgen::model
