// SPDX-License-Identifier: GPL-3.0-or-later
// Names are resolved in the order of their dependencies. The order that users see (the array p, columns, tables) is the
// order of declaration.
#pragma once

#include "model/model.hpp"

namespace eomgen::model {

/// Sorts parameters, functions and definitions into the order of the file, and renumbers them in expressions and
/// scenes.
void restore_declared_order(Model& model);

}  // namespace eomgen::model
