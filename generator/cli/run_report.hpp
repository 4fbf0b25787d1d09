// SPDX-License-Identifier: GPL-3.0-or-later
// A run told to a person, and as the JSON document of docs/schema/run.schema.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/sensitivities.hpp"
#include "cli/simulate.hpp"

namespace eomgen::cli {

struct RunReport {
  const Simulation& simulation;
  bool estimate_wanted = true;  // else the document has no error_estimate
  std::optional<run::Sensitivities> sensitivities = {};  // where they were asked for

  std::string text() const;
  nlohmann::ordered_json json() const;
};

}  // namespace eomgen::cli
