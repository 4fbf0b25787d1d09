// SPDX-License-Identifier: GPL-3.0-or-later
// Whether runs of a scene have a valid start, without running them.
#pragma once

#include <optional>
#include <string>

#include "error.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

class StartChecker {
 public:
  StartChecker(std::shared_ptr<const model::Model> model, std::string scene);

  /// Whether the start can be computed with these values. Throws Error if no start at all is possible.
  bool can_start(run::Overrides overrides);
  /// The error of the first run without a valid start.
  const std::optional<Error>& refusal() const { return refusal_; }

 private:
  std::unique_ptr<DerivedModel> derived_;
  std::string scene_;
  symbolic::Dag was_;  // the initial graph of the model: every start adds its values to the graph
  bool charts_;
  std::optional<Error> refusal_;
};

}  // namespace eomgen::pipeline
