// SPDX-License-Identifier: GPL-3.0-or-later
// Whether runs of a scene can begin, without making them.
#pragma once

#include <optional>
#include <string>

#include "error.hpp"
#include "pipeline/pipeline.hpp"

namespace eomgen::pipeline {

class Beginnings {
 public:
  Beginnings(std::shared_ptr<const model::Model> model, std::string scene);

  /// Whether its start can be found with these values. Throws Error for what is wrong with any start.
  bool can_begin(run::Overrides overrides);
  /// Of the first that could not begin.
  const std::optional<Error>& refusal() const { return refusal_; }

 private:
  std::unique_ptr<Derived> derived_;
  std::string scene_;
  symbolic::Dag was_;  // every start puts its values into the graph of the model
  bool charts_;
  std::optional<Error> refusal_;
};

}  // namespace eomgen::pipeline
