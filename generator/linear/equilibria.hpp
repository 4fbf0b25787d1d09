// SPDX-License-Identifier: GPL-3.0-or-later
// Search for equilibria and steady motions by Newton's method from many starts, which are the same in every process.
// Results are refined in many digits. Points that differ by turns of angles, signs of Euler parameters or the two
// Euler-angle triples of an attitude are one.
#pragma once

#include "linear/stability.hpp"

namespace eomgen::linear {

/// The range of a coordinate of z in the search.
struct Range {
  double lower = -HUGE_VAL, upper = HUGE_VAL;
};

/// Three angles of one body or frame: (a, b, c) and (a + pi, +-b, c + pi) are the same attitude. The sign of `regular`
/// differs between them.
struct EulerAngles {
  std::array<std::size_t, 3> places;  // in z
  Ref regular;
};

struct SearchRequest {
  const Flow& flow;
  State<Precise> start;
  Setting<Precise> setting;
  std::vector<Range> ranges;                                 // per coordinate
  std::vector<std::array<std::size_t, 4>> euler_parameters;  // Euler parameters: e and -e are the same attitude
  std::vector<EulerAngles> euler_angles;
  std::vector<Quantity> held;  // with the values of `targets`
  std::vector<Precise> targets;
  std::size_t starts = 300;
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress;
};

struct FoundPoint {
  State<Precise> z;
  double parameter_change = 0;  // SteadyState::parameter_change
  std::size_t family = 0;       // dimension of its family of steady motions, before any quantity was held
  std::size_t reached = 1;      // number of starts that led to it
};

struct SearchResult {
  Symmetry symmetry;                // at the start
  std::vector<bool> is_angle;       // per coordinate of z: an angle, periodic by one turn
  std::vector<std::size_t> held;    // entries of z held at their start values, since families leave them undetermined
  bool held_in_vain = false;        // nothing was found with them held; the points are members of families
  std::vector<FoundPoint> points;   // in the order of their entries
  std::size_t converged = 0;        // starts that converged to a point
  std::size_t further_members = 0;  // starts that converged to members of families that are not in `points`
  std::size_t failed_starts = 0;    // starts whose iteration ended where the equations have no value or no derivative
  std::string reason;               // of the first failure
  State<double> failure_point;      // its state
  bool interrupted = false;         // before all starts were tried; results so far

  /// The estimated probability that a further start leads to a new point: the share of the points' visits that were the
  /// only one (Good 1953). Empty without visits.
  std::optional<double> new_point_probability() const;

  /// Records a start whose iteration ended where the equations have no value or no derivative.
  void record_failure(const std::string& why, State<double> at);
  void record_failure(const std::string& why, const State<Precise>& at);
};

/// Throws std::domain_error if the field has no value at the start.
SearchResult find_steady_motions(const SearchRequest& request);

}  // namespace eomgen::linear
