// SPDX-License-Identifier: GPL-3.0-or-later
// integral(e) counts from the start of the run, which is the scene's affair: a parameter of the program's own holds it,
// so that every later stage, and whoever calls the emitted code, treats it like any other number.
#pragma once

#include "model/model.hpp"

namespace eomgen::model {

/// Names the parameters that stand for initial(q).
void name_start_values(Model& model);

/// Where the model has integrals: appends the parameter `t_start`, gives every scene its own value of it, and names the
/// integrals. Names get underscores until nothing else is called so.
void add_start_time(Model& model, bool units_stated);

}  // namespace eomgen::model
