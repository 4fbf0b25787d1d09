// SPDX-License-Identifier: GPL-3.0-or-later
// Random states that the model allows. In: the judge. Out: t, parameters about their defaults, coordinates within
// their ranges about the start of the default scene, put onto the constraints by Newton's method at full precision
// (positions, then velocities). Deterministic by seed on every platform; what cannot be compared is rejected and
// counted.
#pragma once

#include <cln/rational.h>

#include <cstdint>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "verify/dalembert.hpp"

namespace eomgen::verify {

/// A state that is not compared, and why; counted by reason.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The constraints cannot be met there.
struct Unclosed : Rejected {
  using Rejected::Rejected;
};

/// A coordinate is outside its range there.
struct Outside : Rejected {
  using Rejected::Rejected;
};

class Points {
 public:
  /// At most `cap` rejections in all. Parameters in `fixed` have that value at every point. States are moved onto the
  /// constraints; implied ones hold there by themselves, or are moved onto too. Scalar constraints in `leavable` are
  /// closed, all of them or, where that cannot be, as many as can be, other ones at other points; the others are
  /// State::apart.
  Points(const Judge& judge, std::uint64_t seed, std::size_t cap, std::map<std::uint32_t, cln::cl_RA> fixed = {},
         std::vector<std::size_t> leavable = {});

  /// A state with qddot = 0. Throws Error (Fault::check) once too many were rejected.
  State next();
  /// The state that next() gave cannot be compared after all.
  void reject(const std::string& why);
  const std::map<std::string, std::size_t>& rejected() const { return rejected_; }
  /// The largest distance of a parameter, a start, a rate or a time from 1, in powers of ten.
  double decades() const;

 private:
  struct Choice {
    double center = 0, scale = 1, rate_center = 0, rate_scale = 1;
    bool has_lower = false, has_upper = false;
    double lower = 0, upper = 0;
  };
  /// Which of `leavable` are open.
  struct Choosing {
    std::set<std::size_t> open;
    std::size_t failures = 0, outside = 0;
    bool reached = false;
  };
  bool give_up_closing(Choosing& choosing);
  void leave_one_open();
  double uniform();                // in (0, 1)
  double symmetric();              // in (-1, 1)
  Real exact(double value) const;  // the same number at full precision
  void read_scene();
  void read_ranges(const State& start);
  void read_scales();
  void settle(State start, const std::vector<bool>& given);
  void fix(std::vector<Real>& parameters) const;
  State draw();
  double draw_coordinate(const Choice& choice);
  /// Those that are `held` stay where they are.
  void project_positions(State& state, const std::vector<bool>* held = nullptr) const;
  void project_velocities(State& state) const;
  std::vector<Real> correction(const State& state, bool rates, const std::vector<bool>* held, bool by_room) const;
  Real room(const State& state, std::size_t coordinate) const;
  bool move_inside(State& state, const std::vector<Real>& step) const;
  void close_implied(State& state);
  void require_implied(const State& state) const;
  std::optional<std::size_t> first_open(const State& state, bool rates) const;
  void require_inside(const State& state) const;
  void require_smooth(const State& state) const;

  const Judge& judge_;
  std::mt19937_64 engine_;
  std::size_t cap_;
  std::map<std::uint32_t, cln::cl_RA> fixed_;
  std::vector<std::size_t> leavable_;
  std::vector<Choosing> choosings_;  // taken in turn
  std::size_t turn_ = 0;
  std::set<std::size_t> open_;   // implied constraints that positions are moved onto all the same
  std::vector<Choice> choices_;  // per coordinate
  std::vector<Real> defaults_;   // of the parameters
  std::vector<double> input_defaults_;
  double t0_ = 0, t1_ = 1;
  double spread_ = 1;  // narrows about the defaults as points are rejected
  std::size_t rejections_ = 0;
  std::map<std::string, std::size_t> rejected_;
};

}  // namespace eomgen::verify
