// SPDX-License-Identifier: GPL-3.0-or-later
// A run told to a person, and as the JSON document of docs/schema/run.schema.json.
#pragma once

#include <string>

#include "cli/pipeline.hpp"
#include "emit/shared_library/loaded_model.hpp"
#include "run/runner.hpp"

namespace eomgen::cli {

struct RunReport {
  const Derived& derived;
  const run::Scene& scene;
  const run::RunResult& result;
  const verify::Certificate& certificate;
  const program::Program& program;
  const emit::Compiled& compiled;

  std::string text() const;
  std::string json() const;
};

}  // namespace eomgen::cli
