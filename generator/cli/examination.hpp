// SPDX-License-Identifier: GPL-3.0-or-later
// What `check` finds, for other commands too.
#pragma once

#include <nlohmann/json.hpp>

#include "model/model.hpp"

namespace eomgen::cli {

/// The document of docs/schema/check.schema.json. Where it is interrupted, it throws work::Interrupted, or tells so in
/// `interrupted` and gives what it has found by then.
nlohmann::ordered_json examine(const model::Model& model, bool* interrupted = nullptr);

}  // namespace eomgen::cli
