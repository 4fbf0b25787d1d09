// SPDX-License-Identifier: GPL-3.0-or-later
// A run told to a person, and as the JSON document of docs/schema/run.schema.json.
#pragma once

#include <string>

#include "cli/simulate.hpp"

namespace eomgen::cli {

struct RunReport {
  const Simulation& simulation;

  std::string text() const;
  std::string json() const;
};

}  // namespace eomgen::cli
