// SPDX-License-Identifier: GPL-3.0-or-later
// The reference solution of a scene and its uncertainty: tight runs by solvers that share only the right-hand side. All
// budgets are steps, so that verdicts do not depend on the speed of the machine. The clock is a safeguard; a hit is
// reported.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "run/integration.hpp"
#include "stress/stress.hpp"

namespace eomgen::stress {

/// The time limit of a run.
class TimeLimit {
 public:
  using Steady = std::chrono::steady_clock;
  TimeLimit(double seconds, const std::atomic<bool>* interrupt)
      : start_(Steady::now()), limit_(seconds), interrupt_(interrupt) {}
  double seconds() const { return std::chrono::duration<double>(Steady::now() - start_).count(); }
  bool is_exceeded() { return late_ = late_ || seconds() > limit_ || (interrupt_ != nullptr && *interrupt_); }
  bool was_exceeded() const { return late_; }

 private:
  Steady::time_point start_;
  double limit_;
  const std::atomic<bool>* interrupt_;
  bool late_ = false;
};

using State = std::vector<double>;

struct ReferenceSolution {
  State x;
  State scale;  // largest value of each component along the motion; for rates at least the scale of the coordinate over
                // the whole span
  double uncertainty = 0;       // relative to it
  double condition = 1;         // relative change of the end state over the relative change of the start
  double growth = 1;            // of a disturbance, from the first sixteenth of the span to its end
  std::vector<Sample> samples;  // the start first
};

inline constexpr double unit_roundoff = std::numeric_limits<double>::epsilon();
inline constexpr double max_condition =
    1.6e5;  // e^12: beyond twelve Lyapunov times a comparison proves nothing; also the largest factor of tolerances

class ReferenceSolver {
 public:
  /// whole: the requested span, of which the scene may cover a part; nearness: the distance of the start from the
  /// singularity of a chart.
  ReferenceSolver(const run::Scene& scene, double whole, double nearness, const Request& request);

  /// The reference solution; nothing if no two solvers reach the same end state. Then `why` has the reason, `next_span`
  /// the span to try next (0: none).
  std::optional<ReferenceSolution> solution(std::string& why, double& next_span);

 private:
  struct TightRun {
    State x;             // empty: the run did not reach the end
    double reached = 0;  // the fraction of the span that it covered
    bool late = false;
    std::vector<Sample> samples;
  };
  TightRun run_tight(const std::string& solver, double rtol, const State* start, State* scale) const;
  void sample(const eom::StepView& view, const std::vector<int>& mode, std::vector<Sample>& samples) const;
  void set_scale_floor(State& scale, const State& x0) const;
  run::Scene scene_from(const State& x) const;
  bool condition(ReferenceSolution& reference);
  bool follow_disturbed(ReferenceSolution& reference, const State& x0, int pattern, double sign);

  const run::Scene& scene_;
  double whole_, disturbance_;
  const Request& request_;
  run::RunRequest run_;
  std::string solver_;  // of the first tight run
  double rtol_ = 0;
  bool late_ = false;
};

/// Largest |a - b| / scale; infinite if a component is not a number.
double distance(const State& a, const State& b, const State& scale);

}  // namespace eomgen::stress
