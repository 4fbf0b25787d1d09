// SPDX-License-Identifier: GPL-3.0-or-later
// Random admissible states of a model. In: the oracle. Out: t, parameters around their defaults, coordinates within
// their ranges around the start of the default scene, projected onto the constraints by Newton's method at full
// precision (positions, then velocities). Deterministic for each seed on every platform. States that cannot be compared
// are rejected and counted.
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

#include "oracle/dalembert.hpp"

namespace eomgen::verify {

/// The reason why a state is not compared; rejections are counted by reason.
struct RejectedState : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The projection onto the constraints fails.
struct UnsatisfiedConstraints : RejectedState {
  using RejectedState::RejectedState;
};

/// A coordinate is outside its range.
struct OutOfRange : RejectedState {
  using RejectedState::RejectedState;
};

class StateSampler {
 public:
  /// At most `cap` rejections in all. Parameters in `fixed` have that value at every state. States are projected onto
  /// the constraints, and onto implied ones that do not hold by themselves. The unilateral scalar constraints in
  /// `leavable` are closed, or, if they cannot all be closed, as many as possible, in turn; the others are
  /// State::open.
  StateSampler(const Oracle& oracle, std::uint64_t seed, std::size_t cap,
               std::map<std::uint32_t, cln::cl_RA> fixed = {}, std::vector<std::size_t> unilateral_constraints = {});

  /// The next state, with qddot = 0. Throws Error (ErrorKind::check) after too many rejections.
  State next();
  /// Rejects the last state of next(), which cannot be compared.
  void reject(const std::string& why);
  const std::map<std::string, std::size_t>& rejected() const { return rejected_; }
  /// The largest distance of a parameter, an initial value, a rate or a time from 1, in powers of ten.
  double max_decades_from_one() const;

 private:
  struct SamplingRange {
    double center = 0, scale = 1, rate_center = 0, rate_scale = 1;
    bool has_lower = false, has_upper = false;
    double lower = 0, upper = 0;
  };
  /// The open ones of `leavable`.
  struct OpenContactSet {
    std::set<std::size_t> open;
    std::size_t failures = 0, outside = 0;
    bool reached = false;
  };
  bool give_up_closing(OpenContactSet& contact_set);
  void try_other_contacts(OpenContactSet& contact_set);
  void leave_one_open();
  double uniform();                // in (0, 1)
  double uniform_symmetric();      // in (-1, 1)
  Real exact(double value) const;  // the same number at full precision
  void read_scene();
  void read_states(State& start, const model::Scene* scene);
  void read_ranges(const State& start);
  void read_scales();
  void solve_start(State start, const std::vector<bool>& given);
  void apply_fixed(std::vector<Real>& parameters) const;
  State sample_state();
  double sample_coordinate(const SamplingRange& choice);
  /// Coordinates that are `held` keep their values.
  void project_positions(State& state, const std::vector<bool>* held = nullptr) const;
  void project_velocities(State& state) const;
  std::vector<Real> correction(const State& state, bool rates, const std::vector<bool>* held,
                               bool weighted_by_distance) const;
  Real distance_to_bound(const State& state, std::size_t coordinate) const;
  bool step_within_ranges(State& state, const std::vector<Real>& step) const;
  void close_implied(State& state);
  void require_implied(const State& state) const;
  std::optional<std::size_t> first_open(const State& state, bool rates) const;
  void require_inside(const State& state) const;
  void require_smooth(const State& state) const;

  const Oracle& oracle_;
  std::mt19937_64 engine_;
  std::size_t cap_;
  std::map<std::uint32_t, cln::cl_RA> fixed_;
  std::vector<std::size_t> unilateral_constraints_;
  std::vector<OpenContactSet> contact_sets_;  // used in turn
  std::size_t turn_ = 0;
  std::set<std::size_t> open_;                  // implied constraints that positions are still projected onto
  std::vector<SamplingRange> sampling_ranges_;  // per coordinate
  std::vector<SamplingRange> state_ranges_;     // per Model::states; unused for integrals
  std::vector<Real> defaults_;                  // of the parameters
  std::vector<double> input_defaults_;
  double t0_ = 0, t1_ = 1;
  double spread_ = 1;  // narrows around the defaults as states are rejected
  std::size_t rejections_ = 0;
  std::map<std::string, std::size_t> rejected_;
};

}  // namespace eomgen::verify
