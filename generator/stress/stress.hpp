// SPDX-License-Identifier: GPL-3.0-or-later
// Stiff and extreme variations of a scene, and the verdict on each solver: pass, reported, or undetected, which is a
// defect.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/mechanics.hpp"
#include "run/runner.hpp"

namespace eomgen::stress {

/// A variation of a scene.
struct Case {
  std::string name;                                           // "k x 1e+06"
  std::vector<std::pair<std::uint32_t, double>> factor = {};  // parameters with their factors
  std::vector<std::pair<std::uint32_t, double>> value = {};   // parameters with new values, finite or not
  std::vector<std::pair<std::uint32_t, double>> start = {};   // coordinates with new initial values
  double speed_factor = 1;                    // factor of all initial velocities; the span is divided by it
  double span_factor = 1;                     // factor of the span
  std::optional<double> rtol = std::nullopt;  // atol in proportion
  std::optional<double> stability_fraction =
      std::nullopt;  // fixed steps, relative to the stability limit of rk4 at the start
  std::optional<double> zero_replacement = std::nullopt;  // replaces initial values of 0
  double singularity_distance = 1;                        // distance of the start from a chart singularity
  bool has_no_motion = false;                             // no motion exists: the outcome `done` is wrong
};

/// All variations for this model and scene: factors of stiffnesses, masses and inertias; speeds; starts near the bounds
/// of charts; tolerances; steps at the stability limit; rest and very small slip; long spans; values that are not
/// numbers, or denormal. `quick`: a few of each kind.
std::vector<Case> make_cases(const mechanics::Mechanics& mechanics, const run::Scene& scene, bool quick);

/// Applies a case to the scene; nothing if its start violates a constraint.
using VaryScene = std::function<std::optional<run::Scene>(const Case&)>;

/// The error is within 100 tolerances; or larger, but covered by the estimate or the outcome; or not reported at all.
enum class Verdict { pass, reported, undetected };
const char* name(Verdict verdict);

struct Row {
  std::string test, solver;
  Verdict verdict = Verdict::reported;
  double error = 0, estimate = 0;  // relative to the largest value of each component
  double condition = 1;            // of the end state with respect to the start
  double seconds = 0;
  std::string outcome, note;
};

struct Sample {
  double t;
  std::vector<double> x;
  std::vector<int> mode;  // of contacts (docs/abi.md, "Modes")
};

struct Request {
  std::function<run::RunRequest(const run::Scene&)> run;  // with compiled code, for a scene that outlives it
  std::vector<std::string> solvers;
  std::size_t steps_limit = 20000;  // of one run, accepted and rejected: verdicts depend on it
  double seconds_limit = 60;        // safeguard: a run that hits it is `reported`; for a tight run the case is skipped
  std::function<void(const std::string&)> progress = {};
  const std::atomic<bool>* interrupt = nullptr;
  /// Called with states of a reference solution: its start, and 32 along the motion.
  std::function<void(const Case&, const run::Scene&, const std::vector<Sample>&)> on_motion = {};
};

/// One row for each eligible solver; none if there is no reference solution, with the reason in `left_out`.
std::vector<Row> assess(const Case& test, const run::Scene& scene, const Request& request, std::string& left_out);

}  // namespace eomgen::stress
