// SPDX-License-Identifier: GPL-3.0-or-later
// What was asked of a sweep, as it was typed, and what that is for a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "run/scene.hpp"

namespace eomgen::cli {

struct SweepOptions {
  std::string model, scene = "default", out, points;
  std::vector<std::string> grid, sample, set, outputs;
  std::optional<double> rtol, atol, step, t_end;
  std::optional<std::string> solver, design, shard;
  std::size_t jobs = 0, samples = 0;
  bool no_error_estimate = false, ensemble = false, statistics = false;
};

/// Of every run, before its point.
run::Overrides overrides_of(const SweepOptions& options);

/// What makes two sweeps the same: the model's bytes and all that was asked.
std::string key_of(const SweepOptions& options, const model::Model& model, std::uint64_t seed,
                   const std::string& points_hash);

}  // namespace eomgen::cli
