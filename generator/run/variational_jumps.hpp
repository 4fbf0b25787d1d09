// SPDX-License-Identifier: GPL-3.0-or-later
// Interruptions of a run, for the derivatives s of its state along directions of change (the formulas are in
// variational.hpp): samples and kinks at times, surfaces of kinks, resets at events, changes of contacts, the end. In:
// a run, directions, the state x with every s. Out: x and every s behind the interruption.
#pragma once

#include <array>
#include <eom/events/integrate.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "run/direction.hpp"
#include "run/directional_derivative.hpp"
#include "run/leaving_sides.hpp"
#include "run/runner.hpp"
#include "run/variational_equations.hpp"

namespace eomgen::run {

/// Inputs of the scenes beside that of a run: their own ones, whose jumps may be at other times, or those of the run
/// with their changes at fixed t, so that no jump lies between a time of the run and the same time beside it.
enum class NeighbourInputs { of_scene, of_same_times };

/// Thrown where changes of one state alone cannot cross an interruption, which the directions of a run may.
struct NoAdjointEquations {
  std::string reason;
};

class VariationalJumps {
 public:
  /// All arguments have to outlive it. A direction without scenes beside it changes the state alone.
  VariationalJumps(const RunRequest& request, const RunResult& motion, const std::string& solver,
                   const std::vector<Direction>& directions);

  VariationalEquations& equations() { return own_; }
  /// Number of states of x.
  std::size_t states() const { return n_; }
  /// The segment between kinks in time, from start() on.
  std::size_t segment() const { return segment_; }
  const DifferenceScales& scales() const { return scales_; }
  bool is_last_segment() const { return segment_ == own_.kinks.size() || own_.kinks[segment_].after >= motion_.t; }
  double segment_end() const { return is_last_segment() ? motion_.t : own_.kinks[segment_].before; }
  /// Which events and surfaces interrupt.
  std::vector<eom::EventFunction> watched_functions();

  /// Of the integration that follows. coarse: those of slip in two directions, where rounding ended an earlier one.
  void set_tolerances(double rtol, double atol, bool coarse = false);

  // The following change total.x or point.x: x, then s of each direction times its scale. False of those with a result:
  // f has no value, and the run ends. All throw Error{stage "run"} if an interruption does not follow smoothly.

  /// At the start: the samples there, and s at the fixed time t0.
  bool start(eom::Result& total);
  /// At the end of a segment that is not the last one. The next one begins.
  bool cross_kink_in_time(eom::Result& total);
  /// At the end of the run: s at the moving end. It appends the change of the time of the end per direction, times the
  /// scale.
  bool end(eom::Result& total);
  /// At an event, the surface of a kink that depends on the state, or a change of a contact, which may move point.t and
  /// changes what is watched. False: x and s go on unchanged.
  bool cross_event(const eom::EventPoint& point);
  /// Before cross_event(), at the surface of a kink whose branch still follows the state: it gets its side before.
  void settle_branch(const eom::Crossing& crossing);
  /// After a step to (t, x): branches that still follow the state get the side to which it has moved, and slip that has
  /// just begun its own direction.
  void observe_state(double t, const double* x) { own_.context.observe_state(t, x); }

  /// Whether the state lay on the surface of a jump, off which changes of the state alone lead: derivatives exist if
  /// the directions that are wanted do not.
  bool is_on_jump() const { return is_on_jump_; }

  /// The scenes beside that of the run along direction d, with the contacts in its modes.
  /// nearness: from 0, those of the direction, to nearnesses - 1.
  const std::vector<std::unique_ptr<VariationalEquations>>& neighbours(
      std::size_t d, NeighbourInputs inputs = NeighbourInputs::of_scene, int nearness = 0);
  static constexpr int nearnesses = 3;
  static constexpr int nearer = -4;  // from one nearness to the next, as a power of 2
  /// Of the differences of these scenes, which are at difference_offsets(step).
  static double step_of(const Direction& direction, int nearness);
  /// A scene beside that of the run, in the segment and the mode of the run.
  VariationalEquations& in_segment(VariationalEquations& neighbour);

 private:
  using ValuesIn = std::function<std::vector<double>(VariationalEquations& in, double t, const std::vector<double>& x)>;
  using ValuesBeside = std::function<std::vector<double>(VariationalEquations& in)>;
  std::vector<double> by_scene(std::size_t d, const std::vector<double>& middle, const Described& what,
                               const ValuesBeside& values);
  std::vector<double> by_scene(std::size_t d, double t, const std::vector<double>& x, const Described& what,
                               const ValuesIn& values);
  std::vector<double> state_of(const std::vector<double>& x) const;
  std::vector<double> sensitivity(const std::vector<double>& x, std::size_t d) const;
  bool shift(eom::Result& total, const std::vector<double>& dt);
  std::vector<double> changes_of_time(const std::function<double(const Direction&)>& dt) const;
  void require_samples_to_stay(const std::vector<DueSample>& due);
  bool cross(VariationalEquations& in, std::vector<double>& x) const;
  void change_by_impulse(const std::vector<double>& x, const std::vector<double>& after, std::size_t d,
                         std::vector<double>& out);
  void change_by_samples(const std::vector<DueSample>& due, eom::Result& total, const std::vector<double>& dt);
  bool reset(const eom::EventPoint& point);
  bool cross_surface(const eom::EventPoint& point);
  bool change_contact(const eom::EventPoint& point);
  bool begins_by_jump(std::size_t function, double t, const std::vector<double>& x, const std::vector<double>& f);
  void start_contacts(const std::vector<double>& x);
  void project_start_rates(eom::Result& total);
  bool keeps_contacts_sticking(double t, const std::vector<double>& x, std::size_t d, const std::vector<double>& s);
  bool is_slip_ended_by_friction(double t, const std::vector<double>& x, const std::vector<double>& s);
  /// A change of the state and of the time at which it is reached, without scale.
  struct Change {
    std::vector<double> dx;
    double dt;
  };
  void enter_branches(double t, const std::vector<double>& x, const std::vector<Change>& changes);
  /// Whether the first directions are changes of each state alone, and the others start from no change.
  bool has_unit_vectors() const { return !directions_.empty() && directions_.front().beside.empty(); }
  std::vector<Change> changes_at(const std::vector<double>& x, const std::function<double(const Direction&)>& dt) const;
  std::vector<StateBeside> states_beside(double t, const std::vector<double>& x, std::size_t d, const Change& change);
  double size_of_terms(const ValuesIn& value, double t, const std::vector<double>& x);
  double time_change(const ValuesIn& value, double t, const std::vector<double>& x, std::size_t d);
  double time_change(std::size_t function, double t, const std::vector<double>& x, std::size_t d);
  std::optional<std::size_t> stopping_event() const;
  bool rhs(double t, const double* x, std::vector<double>& f) { return own_.context.rhs(t, x, f.data()) == 0; }

  const Scene& scene_;
  const RunResult& motion_;
  DifferenceScales scales_;
  const std::vector<Direction>& directions_;
  VariationalEquations own_;
  std::size_t n_, segment_ = 0;
  bool is_on_jump_ = false;
  std::vector<double> f_;
  using Neighbours = std::vector<std::vector<std::unique_ptr<VariationalEquations>>>;
  std::array<Neighbours, nearnesses> neighbours_, neighbours_of_same_times_;  // per direction, made where needed
};

}  // namespace eomgen::run
