// SPDX-License-Identifier: MIT
// Contacts whose forces are inputs of the compiled code, during one run: the functions that bound their modes, and the
// changes at the zeros of these functions. In: a Problem, its Model. Out: velocities after impacts, new modes, the
// events to record, the rows to which a run projects its states.
//
// Three functions for each contact, all positive inside its mode: the gap of an open one, the normal force of a closed
// one; what is left to the limit of sticking friction, or the slip in its sense; the margin of the law of sliding.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/contacts/transitions.hpp"
#include "eom/events/locator.hpp"
#include "eom/hybrid/impact_work.hpp"
#include "eom/hybrid/model.hpp"
#include "eom/modes/machine.hpp"

namespace eom::hybrid {

class SolvedContacts {
 public:
  static constexpr std::size_t values_per_contact = contacts::values_per_contact;
  /// `changed`: called after velocities change, with the state before and after. Returns the work.
  using Changed = std::function<double(double t, std::span<const double> before, std::span<const double> after)>;

  SolvedContacts(const Problem& problem, Model& model, Changed changed, Energy energy)
      : problem_(problem),
        model_(model),
        forces_(*model.contact_forces()),
        transitions_(forces_, problem.n()),
        changed_(std::move(changed)),
        energy_(std::move(energy)),
        thresholds_(forces_, problem.n(), problem.rtol, problem.atol),
        hits_(size()),
        is_clear_(size(), false) {
    transitions_.set_input_count(problem.inputs.size());
  }

  std::size_t size() const { return forces_.set().contacts.size(); }
  std::size_t functions() const { return values_per_contact * size(); }

  struct Change {
    std::string kind, name;
    double work = 0;  // of an impact
    std::vector<ContactImpulse> impulses = {};
  };
  const std::vector<Change>& changes() const { return changes_; }
  std::optional<Outcome> end_outcome() const { return end_; }
  /// The contact without a unique force, if end_outcome() reports one.
  std::size_t end_contact() const { return end_contact_; }

  void set_tolerances(double rtol, double atol) { thresholds_.set_tolerances(rtol, atol); }

  /// Determines the modes of a start. Contacts with `open` are open; the others touch.
  std::vector<Change> start(double t, std::span<double> x, const std::vector<bool>& open) {
    end_.reset();
    changes_.clear();
    chatter_.reset();
    forces_.reset();
    transitions_.start();
    thresholds_.start();
    std::vector<std::size_t> touching;
    for (std::size_t j = 0; j < size(); ++j) {
      forces_.states()[j] = {};
      const bool starts_open = forces_.contact(j).unilateral && j < open.size() && open[j];
      if (starts_open) forces_.states()[j].mode = contacts::Mode::open;
      if (!starts_open && forces_.contact(j).has_constraint()) touching.push_back(j);
    }
    std::vector<bool> slides(size(), false);
    if (forces_.evaluate_rows(t, x.data(), model_.inputs_without_contacts(t)) == 0) {
      thresholds_.observe(x.data());
      for (std::size_t j = 0; j < size(); ++j) slides[j] = forces_.slip_speed(j) > thresholds_.negligible_speed();
    }
    meet(t, x, touching, {}, false, {});
    std::erase_if(changes_, [&](const Change& change) {  // what slides already does not begin to
      for (std::size_t j = 0; j < size(); ++j)
        if (change.name == name(j)) return change.kind == "slip" && slides[j];
      return false;
    });
    return changes_;
  }

  /// The state from which another run of the same problem continues.
  struct State {
    std::vector<contacts::ContactState> states = {};
    modes::ChatterDetector chatter = {};
    contacts::Thresholds::Sizes sizes = {};
    std::vector<std::size_t> hits = {};
  };
  State save() const { return {forces_.states(), chatter_, thresholds_.sizes(), hits_}; }
  void restore(const State& from) {
    forces_.states() = from.states;
    chatter_ = from.chatter;
    thresholds_.restore(from.sizes);
    hits_ = from.hits;
    forces_.discard_factors();
    end_.reset();
    model_.forget_contact_forces();
  }

  void watch(std::span<EventFunction> functions) const {
    for (EventFunction& f : functions) f = {Direction::down, Watch::off, false};
    for (std::size_t j = 0; j < size(); ++j) {
      const contacts::Description& at = forces_.contact(j);
      EventFunction* const f = &functions[values_per_contact * j];
      const EventFunction bound{Direction::down, Watch::breaking, true};
      if (at.has_constraint()) f[0] = bound;
      if (!forces_.is_closed(j) || at.slip.empty()) continue;
      if (at.sticks) f[1] = bound;
      if (forces_.has_friction(j) && at.has_constraint()) f[2] = bound;
    }
  }

  /// Whether the gap of an open contact is known to stay positive. Its functions then have the value 1.
  void set_clear(std::size_t j, bool clear) { is_clear_[j] = clear; }
  void forget_clear() { is_clear_.assign(size(), false); }

  /// Values of all functions at a state.
  int operator()(double t, const double* x, double* g) {
    if (const int code = model_.solve_contacts(t, x, contacts::ForceChoice::admissible); code != 0) return code;
    if (forces_.all_open()) {
      if (const int code = forces_.evaluate_rows(t, x, model_.inputs(t)); code != 0) return code;
    }
    thresholds_.observe(x, is_clear_);
    for (std::size_t j = 0; j < size(); ++j) {
      double* const value = g + values_per_contact * j;
      value[0] = value[1] = value[2] = 1;
      if (is_clear_[j]) continue;
      const contacts::Description& at = forces_.contact(j);
      if (!forces_.is_closed(j)) {
        value[0] = gap_beyond_rounding(j, x);
        continue;
      }
      thresholds_.observe_force(j);
      const double rounding = thresholds_.force_rounding(j);
      if (at.has_constraint()) value[0] = (at.unilateral ? forces_.lambda(j) : sign(j) * forces_.lambda(j)) + rounding;
      if (at.sticks) value[1] = bound_of_friction(j, rounding);
      value[2] = forces_.margin(j);
    }
    const bool failed = std::any_of(g, g + functions(), [](double value) { return std::isnan(value); });
    return failed ? contacts::ContactForces::code_not_finite : 0;
  }

  /// The first function of an open contact; NaN if there is no value.
  double gap_value(double t, const double* x, std::size_t j) {
    model_.forget_contact_forces();
    if (forces_.evaluate_rows(t, x, model_.inputs(t)) != 0) return std::numeric_limits<double>::quiet_NaN();
    if (is_clear_[j]) return 1;
    thresholds_.observe_contact(j, x);
    return gap_beyond_rounding(j, x);
  }

  /// Called at the start of each step.
  void update(const double* x) {
    if (forces_.all_open()) return;
    set_least_slip(x);
    for (std::size_t j = 0; j < size(); ++j)
      if (std::as_const(forces_).states()[j].starts && has_started(j)) forces_.states()[j].starts = false;
  }

  EventAction handle_event(double& t, std::span<double> x, const Crossing& crossing,
                           std::span<EventFunction> functions) {
    const std::size_t j = crossing.function / values_per_contact, which = crossing.function % values_per_contact;
    changes_.clear();
    if (which == 2) {
      end_ = forces_.has_several(j) ? Outcome::friction_many_solutions : Outcome::friction_no_solution;
      end_contact_ = j;
      return EventAction::stop;
    }
    const contacts::Description& at = forces_.contact(j);
    if (which == 0 && !at.unilateral) {
      forces_.states()[j].normal_sign = -sign(j);
      model_.forget_contact_forces();
      watch(functions);
      return EventAction::restart;
    }
    const bool sticks = forces_.is_sticking(j);
    contacts::Hint hint{j, which == 0 && forces_.is_closed(j), which == 1 && sticks, which == 1 && !sticks};
    transitions_.set_friction_before(forces_.friction(j));
    std::vector<std::size_t> touching;
    for (std::size_t i = 0; i < size(); ++i)
      if (forces_.contact(i).has_constraint() && (forces_.is_closed(i) || i == j)) touching.push_back(i);
    std::vector<bool> plastic(size(), false);
    bool rest = false;
    const bool meets = which == 0 && !forces_.is_closed(j);
    if (meets) {
      add_touching(t, x, j, touching);
      set_least_slip(x.data());
      if (chatter_.add_transition(t)) end_bounces(j, touching, plastic);
      rest = stop_low_bounces(t, x, touching, plastic);
    }
    meet(t, x, touching, plastic, rest, hint,
         hint.slips || hint.parts ? later_state(t, x, crossing.function) : std::nullopt);
    if (end_) return EventAction::stop;
    if (!progresses(t)) {
      end_ = Outcome::step_too_small;
      return EventAction::stop;
    }
    watch(functions);
    return meets ? EventAction::collide : EventAction::restart;
  }

  /// Rows of closed contacts: gaps; and velocities: of sticking ones.
  std::size_t gap_rows() const {
    std::size_t count = 0;
    for (std::size_t j = 0; j < size(); ++j) count += has_gap_row(j) ? 1 : 0;
    return count;
  }
  std::size_t slip_rows() const {
    std::size_t count = 0;
    for (std::size_t j = 0; j < size(); ++j) count += forces_.is_sticking(j) ? forces_.contact(j).slip.size() : 0;
    return count;
  }
  /// Calls gap(psi, row, b) for each gap row and slip(row, b) for each slip row, with b such that A qdot + b is the
  /// velocity. Returns a code.
  template <class Gap, class Slip>
  int rows(double t, const double* x, Gap&& gap, Slip&& slip) {
    if (forces_.all_open()) return 0;
    if (const int code = forces_.evaluate_rows(t, x, model_.inputs(t)); code != 0) return code;
    const double* const rates = x + problem_.n();
    const auto rest = [&](const contacts::Row& row) {
      double sum = forces_.rate(row);
      for (std::size_t k = 0; k < row.columns.size(); ++k) sum -= forces_.value(row.slope(k)) * rates[row.columns[k]];
      return sum;
    };
    for (std::size_t j = 0; j < size(); ++j)
      if (has_gap_row(j))
        gap(forces_.value(forces_.contact(j).gap), forces_.contact(j).normal, rest(forces_.contact(j).normal));
    for (std::size_t j = 0; j < size(); ++j) {
      if (!forces_.is_sticking(j)) continue;
      for (const contacts::Row& row : forces_.contact(j).slip) slip(row, rest(row));
    }
    model_.forget_contact_forces();
    return 0;
  }
  double slope(const contacts::Row& row, std::size_t k) const { return forces_.value(row.slope(k)); }

  /// Differs after each access that may change modes.
  std::size_t changed_modes() const { return forces_.changes(); }
  bool has_closed_contact() const {
    for (std::size_t j = 0; j < size(); ++j)
      if (forces_.contact(j).has_constraint() && forces_.is_closed(j)) return true;
    return false;
  }
  /// The largest complementarity residual of the changes since the start (contacts/friction_problem.hpp).
  double largest_residual() const { return transitions_.largest_residual(); }
  /// Whether the motion has determined all forces since the start.
  bool forces_determined() const { return !forces_.undetermined(); }
  bool is_open(std::size_t j) const { return !forces_.is_closed(j); }
  const std::string& name(std::size_t j) const { return forces_.contact(j).name; }
  /// The gap of a contact that can open, at a state; 0 for the others.
  double gap(double t, const double* x, std::size_t j) {
    if (!forces_.contact(j).unilateral) return 0;
    model_.forget_contact_forces();
    return forces_.evaluate_rows(t, x, model_.inputs(t)) == 0 ? forces_.value(forces_.contact(j).gap) : std::nan("");
  }

 private:
  double sign(std::size_t j) const { return forces_.states()[j].normal_sign; }
  bool has_gap_row(std::size_t j) const { return forces_.contact(j).has_constraint() && forces_.is_closed(j); }

  double gap_beyond_rounding(std::size_t j, const double* x) const {
    const contacts::Description& at = forces_.contact(j);
    const double rounding = thresholds_.gap_rounding(j, x), gap = forces_.value(at.gap) + rounding;
    // A contact that separates does not meet, though the error of its place may leave it below the surface.
    return gap <= 0 && forces_.rate(at.normal) > 0 ? rounding : gap;
  }

  void set_least_slip(const double* x) {
    const double least = thresholds_.least_slip(x);
    forces_.set_least_slip(least, thresholds_.start_slip(least));
  }
  bool has_started(std::size_t j) const {
    const std::vector<contacts::Row>& slip = forces_.contact(j).slip;
    return contacts::has_started({forces_.rate(slip[0]), forces_.rate(slip[1])}, forces_.states()[j].direction,
                                 forces_.least_slip(), forces_.start_slip());
  }

  double bound_of_friction(std::size_t j, double rounding) const {
    const contacts::Description& at = forces_.contact(j);
    if (forces_.states()[j].mode == contacts::Mode::closed) {
      const std::array<double, 2>& phi = forces_.friction(j);
      return forces_.value(at.static_coefficient) * std::abs(forces_.normal_force(j)) - std::hypot(phi[0], phi[1]) +
             rounding;
    }
    if (at.slip.size() == 1)
      return static_cast<double>(forces_.states()[j].mode) * forces_.rate(at.slip[0]) + thresholds_.speed_rounding();
    return forces_.states()[j].starts ? 1 : forces_.slip_speed(j) - forces_.least_slip();
  }

  /// Adds open contacts that meet when contact j does.
  void add_touching(double t, std::span<double> x, std::size_t j, std::vector<std::size_t>& touching);
  /// An infinite sequence of ever smaller bounces ends with lasting contact of all contacts that took turns.
  void end_bounces(std::size_t j, std::vector<std::size_t>& touching, std::vector<bool>& plastic);
  /// A bounce lower than the rounding of the gap is none. If all motion of contacts that meet is lower, they come to
  /// rest together with those whose gaps are no larger (a box that rocks on its edges). Returns whether they do.
  bool stop_low_bounces(double t, std::span<double> x, std::vector<std::size_t>& touching, std::vector<bool>& plastic);
  /// Impulses of contacts that approach, then new modes.
  void meet(double t, std::span<double> x, const std::vector<std::size_t>& touching, std::vector<bool> plastic,
            bool rest, const contacts::Hint& hint, std::optional<contacts::LaterState> later = {});
  /// A state after (t, x), at which this function has crossed zero, where it is negative by more than rounding.
  std::optional<contacts::LaterState> later_state(double t, std::span<const double> x, std::size_t function);
  bool approaches(const std::vector<std::size_t>& touching) const;
  /// The impulses of the last impact, which ended in the state x.
  std::vector<ContactImpulse> impulses(double t, std::span<const double> x);
  void report(const std::vector<contacts::ContactState>& before, const std::vector<std::size_t>& hit, double work,
              std::vector<ContactImpulse> impulses);

  /// False after many changes at the same time, but for rounding.
  bool progresses(double t) {
    constexpr int most = 1000;
    constexpr double rounding = 1e-14;
    repeated_ = std::abs(t - last_event_) <= rounding * std::abs(t) ? repeated_ + 1 : 0;
    last_event_ = t;
    return repeated_ < most;
  }

  const Problem& problem_;
  Model& model_;
  contacts::ContactForces& forces_;
  contacts::Transitions transitions_;
  Changed changed_;
  Energy energy_;
  contacts::Thresholds thresholds_;
  std::vector<std::size_t> hits_;  // number of impacts
  std::vector<bool> is_clear_;     // set_clear()
  modes::ChatterDetector chatter_;
  std::vector<Change> changes_;  // of the last event
  std::optional<Outcome> end_;
  std::size_t end_contact_ = contacts::none;
  double last_event_ = std::numeric_limits<double>::quiet_NaN();
  int repeated_ = 0;
};

}  // namespace eom::hybrid

#include "eom/hybrid/solved_contact_changes.hpp"  // the members that change modes
