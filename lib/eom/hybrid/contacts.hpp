// SPDX-License-Identifier: MIT
// The modes of the contacts during one run: eom::Contacts on compiled code. In: the state at which a function of a
// contact crosses zero. Out: the next mode, the velocities after it, the events to record.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eom/hybrid/impacts.hpp"
#include "eom/hybrid/model.hpp"
#include "eom/modes/contacts.hpp"

namespace eom::hybrid {

class ContactModes {
 public:
  /// `changed`: called after velocities change, with the state before and after. Returns the work.
  using Changed = std::function<double(double t, std::span<const double> before, std::span<const double> after)>;
  ContactModes(const Problem& problem, Model& model, ConstraintRows& rows, Changed changed, Energy energy);

  /// NaN is neither inside nor outside of a law.
  static int code_of(const double* g, std::size_t count) {
    return std::any_of(g, g + count, [](double value) { return std::isnan(value); }) ? code_not_finite : 0;
  }
  int mode() const { return switch_ ? switch_->mode : 0; }
  /// Determines the mode of a start. Returns events of contacts that start to slide or open at once.
  std::vector<Event> start(double t, std::span<double> x);
  /// Not 0: a function needed at the start has no value; a code of the ABI.
  int start_code() const { return start_code_; }

  /// The modes and their history, from which another run of the same problem continues.
  struct State;
  State save() const;
  void restore(const State& from);
  void watch(std::span<EventFunction> functions) const { switch_->watch(functions); }
  /// Transforms the functions into the monitored ones, and records the slip speeds.
  void shift_to_watched(double* g);
  /// Called at the start (t, x) of each step.
  void update_min_slip(double t, const double* x);
  void set_tolerances(double rtol, double atol) { velocities_.set_tolerances(rtol, atol); }
  /// Whether slip in two directions changes so much in a step h, relative to its speed, that the step resolves neither
  /// its direction nor its end. `now`: the previous answer; it adds hysteresis.
  bool is_slip_slow(double t, const double* x, double h, bool now);
  /// Handles a crossing of one of the functions and records its events.
  EventAction handle_event(double& t, std::span<double> x, const Crossing& crossing,
                           std::span<EventFunction> functions);
  std::span<const Event> recorded_events() const { return recorded_; }
  /// The outcome, if a contact has ended the run.
  std::optional<Outcome> end_outcome() const;
  const std::string& detail() const { return switch_->detail; }

 private:
  static constexpr double known_gap = 3e-14;       // of the largest gap: rounding of its terms
  static constexpr double most_restitution = 0.9;  // above this value bounces continue for too long

  struct Motion {
    ContactModes* self;
    int impact(double t, std::span<double> x, int mode, std::size_t j, double e) const;
    int close(double t, std::span<double> x, int mode) const;
    int stick(double t, std::span<double> x, int mode, std::size_t j) const;
    int stop(double& t, std::span<double> x, int mode, std::size_t j) const;
    int slide(double t, std::span<double> x, int mode, std::size_t j) const;
    double min_slip_speed(std::size_t j) const { return self->velocities_.min_slip_speed(j); }
    double gap_rate(double t, std::span<const double> x, std::size_t j) const;
    double negligible_speed() const { return self->velocities_.negligible_speed(); }
  };
  struct MetContacts {
    std::vector<std::size_t> contacts;
    bool over = true;  // all bounces are lower than the accuracy of the gaps
  };
  /// Changes the velocities by `move`, which returns a code, and reports the change.
  template <class Move>
  int change(double t, std::span<double> x, Move&& move) {
    const std::vector<double> before(x.begin(), x.end());
    const int code = move();
    if (code == 0) work_ += changed_(t, before, x);
    return code;
  }
  /// The transitions as events; the first impact has the work and the impulses since they were last cleared.
  void record(std::span<const ModeEvent> transitions);
  /// Gaps up to this value are not known from 0: rounding of the terms of the gap, and of the coordinates.
  double gap_accuracy(double t, std::span<const double> x, std::size_t j) {
    return std::max(known_gap * largest_gap_, velocities_.gap_rounding(t, x, model_.inputs(t), j));
  }
  void update_starts(int mode);
  bool compute_gap_decelerations(double t, std::span<double> x, int mode, std::vector<double>& result);
  MetContacts contacts_met(double t, std::span<double> x, std::size_t j, double time);
  void end_bounce_sequence(double& t, std::span<double> x, std::size_t j);

  /// Callables for eom::Contacts, with the mode of the contacts as argument.
  struct Rhs {
    Model* model;
    int operator()(double t, const double* x, int mode, double* dx) const { return model->rhs_of(mode, t, x, dx); }
  };
  struct Functions {
    Functions(Model& of, std::size_t before, std::size_t values)
        : model(&of), first(before), count(values), all(before + values) {}
    Model* model;
    std::size_t first, count;  // range of the contact values among all event functions
    std::vector<double> all;
    int operator()(double t, const double* x, int mode, double* g) {
      const int code = model->events_of(mode, t, x, all.data());
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(first), count, g);
      return code != 0 ? code : code_of(g, count);
    }
  };
  using Rule = Contacts<Rhs, Functions, Motion>;

  const Problem& problem_;
  Model& model_;
  ConstraintRows& rows_;
  ContactVelocities velocities_;
  bool two_directions_ = false;      // some contact slides in two directions
  std::vector<double> restitution_;  // of each contact, at the start
  int start_code_ = 0;               // of the evaluation of the restitutions
  double largest_gap_ = 0;           // of open contacts
  Changed changed_;
  double work_ = 0;  // of the changes of velocities at the last crossing
  Rhs rhs_;
  Functions functions_;
  Rule rule_;
  std::vector<double> g_, k_, middle_;
  std::optional<modes::ModeSwitch<Rule>> switch_;
  std::vector<Event> recorded_;  // of the last crossing
};

struct ContactModes::State {
  int mode = 0;
  modes::ChatterDetector chatter = {};
  Rule::Hits hits = {};
  ContactVelocities::ObservedSlip slip = {};
  std::vector<double> restitution = {};
  double largest_gap = 0;
  std::vector<double> force_sizes = {};
};

inline ContactModes::State ContactModes::save() const {
  return {mode(),
          switch_ ? switch_->chatter() : modes::ChatterDetector{},
          rule_.hits(),
          velocities_.observed_slip(),
          restitution_,
          largest_gap_,
          rule_.force_sizes()};
}

inline void ContactModes::restore(const State& from) {
  velocities_.set_observed_slip(from.slip);
  restitution_ = from.restitution;
  for (std::size_t j = 0; j < restitution_.size(); ++j) rule_.set_restitution(j, restitution_[j]);
  rule_.set_hits(from.hits);
  largest_gap_ = from.largest_gap;
  rule_.set_force_sizes(from.force_sizes);
  rows_.set_mode(from.mode);
  switch_.emplace(rule_.table(), rule_, from.mode);
  switch_->set_chatter(from.chatter);
  update_starts(from.mode);
}

inline ContactModes::ContactModes(const Problem& problem, Model& model, ConstraintRows& rows, Changed changed,
                                  Energy energy)
    : problem_(problem),
      model_(model),
      rows_(rows),
      velocities_(problem, rows, std::move(energy)),
      changed_(std::move(changed)),
      rhs_{&model},
      functions_(model, problem.events.size() + problem.code->kinks.size(),
                 contact_values * problem.code->contacts.size()),
      rule_(problem.code->contacts, problem.states(), rhs_, functions_, Motion{this}),
      g_(rule_.functions()) {
  for (const Contact& contact : problem.code->contacts) two_directions_ = two_directions_ || contact.dimensions == 2;
  model_.set_slip_starts(&velocities_.starts());
}

inline int ContactModes::Motion::impact(double t, std::span<double> x, int mode, std::size_t j, double e) const {
  return self->change(t, x, [&] { return self->velocities_.impact(t, x, self->model_.inputs(t), mode, j, e); });
}
inline int ContactModes::Motion::close(double t, std::span<double> x, int mode) const {
  return self->change(t, x, [&] { return self->velocities_.close(t, x, self->model_.inputs(t), mode); });
}
inline int ContactModes::Motion::stick(double t, std::span<double> x, int mode, std::size_t j) const {
  return self->change(t, x, [&] { return self->velocities_.stick(t, x, self->model_.inputs(t), mode, j); });
}
inline int ContactModes::Motion::slide(double t, std::span<double> x, int mode, std::size_t j) const {
  return self->change(t, x, [&] { return self->velocities_.slide(t, x, self->model_.inputs(t), mode, j); });
}
inline double ContactModes::Motion::gap_rate(double t, std::span<const double> x, std::size_t j) const {
  return self->velocities_.gap_rate(t, x, self->model_.inputs(t), j);
}

inline std::vector<Event> ContactModes::start(double t, std::span<double> x) {
  const std::vector<Contact>& contacts = problem_.code->contacts;
  std::vector<double> g(rule_.functions());
  velocities_.reset();
  switch_.reset();  // of a previous run: a value that is a force in one mode is a gap in another
  largest_gap_ = 0;
  restitution_.assign(contacts.size(), 0.0);
  start_code_ = 0;
  if (two_directions_)
    velocities_.update_min_slip(t, x.data(), model_.inputs(t));  // sets the least slip, before it is used
  std::vector<double> slip(contacts.size(), 0.0);
  std::array<bool, max_contacts> open{};
  int begins = 0;  // unilateral contacts as given by the start, all others sticking
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    open[j] = problem_.starts_open[j];
    if (open[j]) begins = with_contact_digit(begins, j, 3);
    const int code = velocities_.restitution(t, x.data(), model_.inputs(t), j, restitution_[j]);
    if (code != 0) start_code_ = code;
    rule_.set_restitution(j, restitution_[j]);
  }
  if (functions_(t, x.data(), begins, g.data()) == 0) {
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const double* const value = g.data() + contact_values * j;
      slip[j] = contacts[j].dimensions == 2 ? std::hypot(value[0], value[2]) : std::abs(value[0]);
    }
    shift_to_watched(g.data());
  }
  const int mode = rule_.start(t, x, std::span<const bool>(open.data(), contacts.size()));
  rows_.set_mode(mode);
  switch_.emplace(rule_.table(), rule_, mode);
  update_starts(mode);
  update_min_slip(t, x.data());
  std::vector<Event> recorded;
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    const int digit = contact_digit(mode, j);
    const bool is_closed = !contacts[j].unilateral || digit < 3;
    if (contacts[j].sticks && is_closed && digit % 3 != 0 && slip[j] <= velocities_.negligible_speed())
      recorded.push_back({t, "slip", contacts[j].name});
    if (!is_closed && !open[j]) recorded.push_back({t, "lose_contact", contacts[j].name});
  }
  return recorded;
}

inline void ContactModes::update_min_slip(double t, const double* x) {
  if (two_directions_) velocities_.update_min_slip(t, x, model_.inputs(t));
}

inline bool ContactModes::is_slip_slow(double t, const double* x, double h, bool now) {
  const double steps = now ? 8 : 4;
  bool slow = false, moved = false;
  for (std::size_t j = 0; j < problem_.code->contacts.size() && !slow; ++j) {
    const Contact& contact = problem_.code->contacts[j];
    if (contact.dimensions != 2 || !contact.sticks || contact_digit(mode(), j) % 3 == 0 ||
        (contact.unilateral && contact_digit(mode(), j) >= 3))
      continue;
    if (!moved) {
      k_.resize(problem_.states());
      if (rhs_(t, x, mode(), k_.data()) != 0) return now;
      middle_.resize(k_.size());
      for (std::size_t i = 0; i < k_.size(); ++i) middle_[i] = x[i] + h * k_[i];
      moved = true;
    }
    const std::array<double, 2> here = velocities_.slip(t, x, model_.inputs(t), j);
    const std::array<double, 2> there = velocities_.slip(t + h, middle_.data(), model_.inputs(t + h), j);
    slow = std::hypot(here[0], here[1]) < steps * std::hypot(there[0] - here[0], there[1] - here[1]);
  }
  return slow;
}

/// Extrapolates to the time at which the slip of contact j vanishes, by the midpoint rule. The remaining time is so
/// short that the slip along its direction is almost linear.
inline int ContactModes::Motion::stop(double& t, std::span<double> x, int mode, std::size_t j) const {
  const auto slip = [&](double at, const double* state) {
    return self->velocities_.slip(at, state, self->model_.inputs(at), j);
  };
  const std::array<double, 2> w = slip(t, x.data());
  const double speed = std::hypot(w[0], w[1]);
  if (!(speed > 0)) return 0;
  std::vector<double>& k = self->k_;
  std::vector<double>& middle = self->middle_;
  k.resize(x.size()), middle.resize(x.size());
  if (const int code = self->rhs_(t, x.data(), mode, k.data()); code != 0) return code;
  const auto moved = [&](double h) {
    for (std::size_t i = 0; i < x.size(); ++i) middle[i] = x[i] + h * k[i];
    const std::array<double, 2> after = slip(t + h, middle.data());
    return (w[0] * after[0] + w[1] * after[1]) / speed;
  };
  // The rate of the slip, from a step in which it changes by a small fraction of itself.
  double h = 1e-6, rate = (moved(h) - speed) / h;
  if (rate < 0) h = -speed / rate / 8, rate = (moved(h) - speed) / h;
  if (!(rate < 0)) return keeps_sliding;
  h = -speed / rate;
  for (std::size_t i = 0; i < x.size(); ++i) middle[i] = x[i] + h / 2 * k[i];
  if (const int code = self->rhs_(t + h / 2, middle.data(), mode, k.data()); code != 0) return code;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * k[i];
  t += h;
  return 0;
}

inline void ContactModes::shift_to_watched(double* g) {
  for (std::size_t j = 0; j < problem_.code->contacts.size(); ++j) {
    const double* const value = g + contact_values * j;
    const double slip =
        problem_.code->contacts[j].dimensions == 2 ? std::hypot(value[0], value[2]) : std::abs(value[0]);
    if (problem_.code->contacts[j].dimensions > 0 && std::isfinite(slip)) velocities_.record_slip_speed(slip);
    if (problem_.code->contacts[j].unilateral && contact_digit(mode(), j) >= 3 && std::isfinite(value[3]))
      largest_gap_ = std::max(largest_gap_, value[3]);  // not the values that trial steps reach below the surface
  }
  rule_.shift_to_watched(g);
  for (std::size_t j = 0; j < problem_.code->contacts.size(); ++j)
    if (velocities_.starts().is_active(j)) g[contact_values * j] = 1;  // its slip has not got its own direction
}

/// Ends starts of contacts that do not slide in this mode.
inline void ContactModes::update_starts(int mode) {
  for (std::size_t j = 0; j < problem_.code->contacts.size(); ++j) {
    const int digit = contact_digit(mode, j);
    if (digit % 3 == 0 || (problem_.code->contacts[j].unilateral && digit >= 3)) velocities_.starts().end(j);
  }
}

inline EventAction ContactModes::handle_event(double& t, std::span<double> x, const Crossing& crossing,
                                              std::span<EventFunction> functions) {
  const std::size_t before = switch_->events.size();
  work_ = 0;
  velocities_.clear_impulses();
  const std::size_t j = crossing.function / contact_values;
  const bool hits =
      crossing.function % contact_values == 3 && problem_.code->contacts[j].unilateral && contact_digit(mode(), j) >= 3;
  const double e = hits ? restitution_[j] : 0;
  if (e > 0 && e < most_restitution) end_bounce_sequence(t, x, j);
  const EventAction answer = switch_->handle_event(t, x, crossing, functions);
  if (e > 0) rule_.set_restitution(j, e);
  rows_.set_mode(switch_->mode);
  update_starts(switch_->mode);
  if (answer == EventAction::restart) update_min_slip(t, x.data());
  record(std::span(switch_->events).subspan(before));
  return answer;
}

inline void ContactModes::record(std::span<const ModeEvent> transitions) {
  recorded_.clear();
  std::vector<ContactImpulse> impulses = velocities_.impulses();
  for (const ModeEvent& one : transitions) {
    recorded_.push_back({one.t, one.kind, one.name});
    if (one.kind != "contact" || impulses.empty()) continue;
    recorded_.back().work = work_;
    recorded_.back().impulses = std::exchange(impulses, {});
  }
}

inline std::optional<Outcome> ContactModes::end_outcome() const {
  if (!switch_ || switch_->end_outcome == Outcome::done) return std::nullopt;
  return switch_->end_outcome;
}

}  // namespace eom::hybrid

#include "eom/hybrid/contact_bounces.hpp"  // the members that end sequences of bounces
