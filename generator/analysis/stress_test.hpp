// SPDX-License-Identifier: GPL-3.0-or-later
// Stress test: runs every solver on stiff and extreme variations of a scene. Each run passes, reports its failure, or
// fails undetected.
#pragma once

#include <functional>

#include "pipeline/simulate.hpp"
#include "stress/audit.hpp"
#include "stress/stress.hpp"

namespace eomgen::analysis {

struct StressRequest : pipeline::SceneRequest {
  std::vector<std::string> solvers;  // empty: all
  double max_seconds = 60;           // time limit of a run, s; exceeding it counts as reported
  std::size_t max_steps = 20000;     // step limit of a run; exceeding it counts as reported
  bool quick = false;                // few variations of each kind
  std::function<void(const std::string& what)> progress;
  const std::atomic<bool>* interrupt = nullptr;
};

struct StressFindings {
  std::string scene;
  std::vector<std::string> solvers;
  std::vector<stress::Row> rows;
  std::vector<std::pair<std::string, std::string>> left_out;  // case, reason
  stress::Audit audit;

  std::size_t count(stress::Verdict verdict) const;
};

/// Throws Error{stage "stress"} for an unknown solver.
StressFindings stress_test(const StressRequest& request);

}  // namespace eomgen::analysis
