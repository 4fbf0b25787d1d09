// SPDX-License-Identifier: GPL-3.0-or-later
// integral(e) starts at the start of the run, which depends on the scene. An internal parameter holds the start time,
// so that later stages and callers of emitted code treat it like any other parameter.
#pragma once

#include "model/model.hpp"

namespace eomgen::model {

/// Names the parameters that represent initial(q).
void name_start_values(Model& model);

/// Names the integrals integral_1, .. Underscores are appended until the names are unique.
void name_integrals(Model& model);

/// If the model has integrals of functions of time: appends the parameter `t_start` and sets its value in every scene.
/// Underscores are appended to its name until it is unique.
void add_start_time(Model& model, bool units_stated);

}  // namespace eomgen::model
