// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::cli {

/// What was asked of a sweep, as it was typed.
struct SweepOptions {
  std::string model, scene = "default", out, points;
  std::vector<std::string> grid, sample, set, outputs;
  std::optional<double> rtol, atol, step, t_end;
  std::optional<std::string> solver, design, shard;
  std::size_t jobs = 0, samples = 0;
  bool no_error_estimate = false, ensemble = false, statistics = false;
};

}  // namespace eomgen::cli
