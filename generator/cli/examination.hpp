// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "analysis/examination.hpp"

namespace eomgen::cli {

/// The document of docs/schema/check.schema.json.
nlohmann::ordered_json to_json(const model::Model& model, const analysis::Examination& examination);

}  // namespace eomgen::cli
