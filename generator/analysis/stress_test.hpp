// SPDX-License-Identifier: GPL-3.0-or-later
// Every solver through stiff and extreme variations of a scene: kept, told, or silent.
#pragma once

#include <functional>

#include "pipeline/simulate.hpp"
#include "stress/audit.hpp"
#include "stress/stress.hpp"

namespace eomgen::analysis {

struct StressRequest {
  std::shared_ptr<const model::Model> model;
  std::string scene = "default";
  run::Overrides overrides;          // parameters and the end
  std::vector<std::string> solvers;  // empty: all
  double seconds = 60;               // a guard: what takes longer is interrupted, and told
  std::size_t steps = 20000;         // what takes more is ended, and told
  bool quick = false;                // a few variations of each kind
  std::uint64_t seed = 1;
  std::function<void(const std::string& what)> progress;
  const std::atomic<bool>* interrupt = nullptr;
};

struct StressFindings {
  std::string scene;
  std::vector<std::string> solvers;
  std::vector<stress::Row> rows;
  std::vector<std::pair<std::string, std::string>> left_out;  // case, why
  stress::Audit audit;

  std::size_t count(stress::Verdict verdict) const;
};

/// Throws Error{stage "stress"}: an unknown solver.
StressFindings stress_test(const StressRequest& request);

}  // namespace eomgen::analysis
