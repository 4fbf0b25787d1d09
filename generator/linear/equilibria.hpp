// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria and steady motions: Newton's iteration from many starts, the same ones in every process, polished in many
// digits; what is the same but for turns of angles, signs of Euler parameters or the two names of an attitude in Euler
// angles is one.
#pragma once

#include "linear/stability.hpp"

namespace eomgen::linear {

/// What the search may assume of a coordinate of z.
struct Range {
  double lower = -HUGE_VAL, upper = HUGE_VAL;
};

/// Three angles of one body or frame: (a, b, c) and (a + pi, +-b, c + pi) are one attitude. `regular` changes its sign
/// between them.
struct EulerSet {
  std::array<std::size_t, 3> places;  // in z
  Ref regular;
};

struct SearchRequest {
  const Flow& flow;
  State<Precise> start;
  Setting<Precise> setting;
  std::vector<Range> ranges;                           // per coordinate
  std::vector<std::array<std::size_t, 4>> parameters;  // Euler parameters: e and -e are one attitude
  std::vector<EulerSet> euler;
  std::vector<Quantity> held;  // with the values of `targets`
  std::vector<Precise> targets;
  std::size_t starts = 300;
  std::uint64_t seed = 1;
  std::function<void(double fraction)> progress;
};

struct FoundPoint {
  State<Precise> z;
  double off = 0;  // Steady::off
  std::size_t family =
      0;  // dimensions of the family of steady motions that it is one of, before anything was held for it
};

struct SearchResult {
  Symmetry symmetry;                // at the start
  std::vector<bool> turns;          // per coordinate of z: an angle, of which a turn more is the same place
  std::vector<std::size_t> held;    // entries of z that were held at their start values, since families leave them open
  bool released = false;            // with them held nothing was found; the points are members of their families
  std::vector<FoundPoint> points;   // in the order of their entries
  std::size_t converged = 0;        // starts that led to some point
  std::size_t further_members = 0;  // starts that led to members of families beyond those that are among `points`
  std::size_t refused = 0;          // starts whose way ended where the equations have no value or no slope
  std::string reason;               // of the first of them
  State<double> refused_at;         // and where
  bool interrupted = false;         // before all starts were tried: what is here was found by then

  /// A start whose way ended where the equations have no value or no slope.
  void refuse(const std::string& why, State<double> at);
  void refuse(const std::string& why, const State<Precise>& at);
};

/// Throws std::domain_error where the start has no field.
SearchResult find_steady_motions(const SearchRequest& request);

}  // namespace eomgen::linear
