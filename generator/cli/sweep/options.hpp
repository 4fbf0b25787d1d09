// SPDX-License-Identifier: GPL-3.0-or-later
// Options of a sweep, as typed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/shared_options.hpp"
#include "model/model.hpp"

namespace eomgen::cli {

struct SweepOptions : SceneOptions {
  std::string model, out, points, estimate = "bounded";
  std::vector<std::string> grid, sample;
  std::optional<std::string> design, shard;
  std::optional<double> basins;
  std::uint64_t jobs = 0, samples = 0;
  bool no_error_estimate = false, ensemble = false, statistics = false;
};

/// Key that identifies a sweep: the bytes of the model and all options.
std::string sweep_key(const SweepOptions& options, const model::Model& model, std::uint64_t seed,
                      const std::string& points_hash);

}  // namespace eomgen::cli
