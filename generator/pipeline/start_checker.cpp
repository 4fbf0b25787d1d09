// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/start_checker.hpp"

#include "pipeline/charts.hpp"

namespace eomgen::pipeline {

StartChecker::StartChecker(std::shared_ptr<const model::Model> model, std::string scene)
    : derived_(derive_model(std::move(model), ApproachChoice::automatic)),
      scene_(std::move(scene)),
      was_(*derived_->mechanics.dag),
      charts_(!exchangeable_charts(list_charts(derived_->mechanics)).empty()) {}

bool StartChecker::can_start(run::Overrides overrides) {
  *derived_->mechanics.dag = was_;
  overrides.can_exchange_charts = charts_;
  try {
    run::resolve_scene(derived_->mechanics, derived_->candidates.front(), derived_->model.scene(scene_), overrides);
    return true;
  } catch (const Error& error) {
    if (error.stage() != "scene") throw;
    if (!refusal_) refusal_ = error;
  }
  return false;
}

}  // namespace eomgen::pipeline
