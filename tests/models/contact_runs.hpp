// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of models with contacts at several tolerances, and of shipped models with a changed text.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "models/rough.hpp"

namespace eomgen::test {

/// Relative tolerances at which the events of a model have to be the same.
inline constexpr std::array<double, 4> all_tolerances{1e-6, 1e-8, 1e-10, 1e-12};

inline std::function<void(pipeline::SimulationRequest&)> at_tolerance(double rtol) {
  return [rtol](pipeline::SimulationRequest& request) {
    request.overrides.rtol = rtol;
    request.overrides.atol = rtol / 100;
  };
}

/// Runs a shipped model with `now` in place of `old`.
inline FinishedRun run_changed(const std::string& model, const std::string& old, const std::string& now,
                               const std::string& scene = "default") {
  std::string text = read_text(model_path(model));
  const std::size_t place = text.find(old);
  REQUIRE(place != std::string::npos);
  text.replace(place, old.size(), now);
  const std::string path = (std::filesystem::temp_directory_path() / ("eomgen_changed_" + model + ".toml")).string();
  write_text(path, text);
  return run_rough(path, scene);
}

}  // namespace eomgen::test
