// SPDX-License-Identifier: GPL-3.0-or-later
// Report of a run as text and as the JSON document of docs/schema/run.schema.json.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/gradients.hpp"
#include "analysis/sensitivities.hpp"
#include "cli/json.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::cli {

/// A file that the run wrote.
struct WrittenFile {
  std::string path;
  std::optional<std::uint64_t> rows;  // only for a table
  std::uint64_t bytes = 0;
};

struct RunReport {
  const pipeline::Simulation& simulation;
  bool has_error_estimate = true;                        // false: the document has no error_estimate
  std::optional<run::Sensitivities> sensitivities = {};  // if requested
  std::optional<run::Gradients> gradients = {};          // if requested
  std::vector<WrittenFile> files = {};

  std::string text() const;
  Json json() const;
};

}  // namespace eomgen::cli
