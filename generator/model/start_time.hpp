// SPDX-License-Identifier: GPL-3.0-or-later
// integral(e) starts at the start of the run, which depends on the scene. An internal parameter holds the start time,
// so that later stages and callers of emitted code treat it like any other parameter.
#pragma once

#include "model/model.hpp"

namespace eomgen::model {

/// Names the parameters that represent initial(q).
void name_start_values(Model& model);

/// If the model has integrals: appends the parameter `t_start`, sets its value in every scene, and names the integrals.
/// Underscores are appended to these names until they are unique.
void add_start_time(Model& model, bool units_stated);

}  // namespace eomgen::model
