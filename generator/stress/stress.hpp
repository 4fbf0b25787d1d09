// SPDX-License-Identifier: GPL-3.0-or-later
// Stiff and extreme variations of a scene, and what each solver makes of them: kept, told, or silent, which is a
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

/// How a scene is changed.
struct Case {
  std::string name;                                           // "k x 1e+06"
  std::vector<std::pair<std::uint32_t, double>> factor = {};  // parameters times this
  std::vector<std::pair<std::uint32_t, double>> value = {};   // parameters that take this value, finite or not
  std::vector<std::pair<std::uint32_t, double>> start = {};   // coordinates at the start
  double speed = 1;                               // all start velocities times this; the span is divided by it
  double span = 1;                                // the span times this
  std::optional<double> rtol = std::nullopt;      // atol in proportion
  std::optional<double> of_limit = std::nullopt;  // fixed steps, of those at which rk4 stops being stable at the start
  std::optional<double> zeros = std::nullopt;     // what starts at 0 starts here
  double nearness = 1;                            // of the start to where coordinates fail
  bool without_value = false;                     // no motion exists: any number that is called done is wrong
};

/// What fits this model and scene: stiffnesses, masses and inertias by factors; speeds; starts near the bounds of
/// charts; tolerances; steps at the limit of stability; rest, and slip that all but vanishes; long spans; values that
/// are no numbers, or denormal. `quick`: a few of each.
std::vector<Case> cases(const mechanics::Mechanics& mechanics, const run::Scene& scene, bool quick);

/// The scene with its constants and its start changed; nothing where the start would break a constraint.
using Vary = std::function<std::optional<run::Scene>(const Case&)>;

/// In tables and JSON: kept, told, silent. The error is within 100 tolerances; or larger and reported; or unreported.
enum class Verdict { kept, reported, unreported };
const char* name(Verdict verdict);

struct Row {
  std::string test, solver;
  Verdict verdict = Verdict::reported;
  double error = 0, estimate = 0;  // relative to the largest value of each component
  double condition = 1;            // of the end state by the start
  double seconds = 0;
  std::string outcome, note;
};

struct Sample {
  double t;
  std::vector<double> x;
  int mode;  // of contacts
};

struct Request {
  std::function<run::RunRequest(const run::Scene&)> run;  // of compiled code, for a scene that outlives it
  std::vector<std::string> solvers;
  std::size_t steps_limit = 20000;  // of one run, accepted and rejected: what verdicts depend on
  double seconds_limit = 60;        // a guard: a run that hits it is told, a tight one leaves its case unjudged
  std::function<void(const std::string&)> progress = {};
  const std::atomic<bool>* interrupt = nullptr;
  /// States of a motion that is known: its start, and 32 on the way.
  std::function<void(const Case&, const run::Scene&, const std::vector<Sample>&)> seen = {};
};

/// One row for each solver that fits; none where no motion to compare with could be had, with the reason in `left_out`.
std::vector<Row> judge(const Case& test, const run::Scene& scene, const Request& request, std::string& left_out);

}  // namespace eomgen::stress
