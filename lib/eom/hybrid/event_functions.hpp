// SPDX-License-Identifier: MIT
// All functions whose sign changes a run monitors, in one array g: events of the model, kinks, contact_values of each
// contact, surfaces at which something may jump. In: the compiled model. Out: values; the monitored directions; bounds
// along a step for functions that are available as expressions.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/clearance.hpp"
#include "eom/hybrid/contacts.hpp"
#include "eom/hybrid/event_ranges.hpp"
#include "eom/hybrid/jumps.hpp"
#include "eom/hybrid/kinks.hpp"
#include "eom/hybrid/model.hpp"
#include "eom/hybrid/solved_contacts.hpp"

namespace eom::hybrid {

class EventFunctions {
 public:
  /// contacts: null if there are none.
  EventFunctions(const Problem& problem, Model& model, const std::unique_ptr<ContactModes>& contacts)
      : problem_(problem),
        model_(model),
        contacts_(contacts),
        ranges_(problem),
        jumps_(problem),
        clearance_(ranges_, size(), problem.n()) {}

  std::size_t first_kink() const { return problem_.events.size(); }
  std::size_t first_contact() const { return first_kink() + problem_.code->kinks.size(); }
  std::size_t first_solved_contact() const { return first_contact() + contact_values * problem_.code->contacts.size(); }
  std::size_t first_jump() const {
    return first_solved_contact() + SolvedContacts::values_per_contact * problem_.code->contact_set.contacts.size();
  }
  std::size_t size() const { return first_jump() + jumps_.surfaces(); }

  /// Values of all functions; those of contacts in the monitored form.
  int operator()(double t, const double* x, double* g) {
    const int code = model_.events(t, x, g);
    if (code == 0 && jumps_.surfaces() > 0)
      jumps_.values({t, {x, problem_.states()}, model_.inputs(t)}, g + first_jump());
    if (code == 0 && solved_contacts_ != nullptr) return (*solved_contacts_)(t, x, g + first_solved_contact());
    if (code != 0 || !contacts_) return code;
    double* const of_contacts = g + first_contact();
    if (const int bad = ContactModes::code_of(of_contacts, first_solved_contact() - first_contact()); bad != 0)
      return bad;
    contacts_->shift_to_watched(of_contacts);
    return 0;
  }

  /// The value of function i; NaN if there is none. The gap of an open contact needs no forces.
  double value(double t, const double* x, std::size_t i) {
    if (const std::optional<std::size_t> j = solved_gap(i); j && solved_contacts_->is_open(*j))
      return solved_contacts_->gap_value(t, x, *j);
    values_.resize(size());
    return (*this)(t, x, values_.data()) == 0 ? values_[i] : std::numeric_limits<double>::quiet_NaN();
  }

  Jumps& jumps() { return jumps_; }

  std::vector<EventFunction> watched() const {
    std::vector<EventFunction> functions;
    for (const WatchedEvent& event : problem_.events)
      functions.push_back({event.direction, event.stop || !event.reset.set.empty() ? Watch::breaking : Watch::passing,
                           false, !event.reset.set.empty()});
    functions.resize(size());
    if (contacts_) contacts_->watch(of_contacts(functions));
    if (solved_contacts_ != nullptr) solved_contacts_->watch(of_solved_contacts(functions));
    return functions;
  }
  std::span<EventFunction> of_contacts(std::span<EventFunction> functions) const {
    return functions.subspan(first_contact(), first_solved_contact() - first_contact());
  }
  std::span<EventFunction> of_solved_contacts(std::span<EventFunction> functions) const {
    return functions.subspan(first_solved_contact(), first_jump() - first_solved_contact());
  }
  /// Contacts whose forces are inputs.
  void set_contacts(SolvedContacts* contacts) { solved_contacts_ = contacts; }

  /// The interval of a step in which function i first leaves its side although no sample shows it.
  std::optional<std::pair<double, double>> hidden_crossing(const StepView& step, std::size_t i, int side, double from,
                                                           double to, const Sampling& sampling) const {
    if (!is_available(i)) return std::nullopt;
    return ranges_.first(step, i, side, from, to, sampling);
  }

  /// To be called at each new step, before is_clear() and hidden_crossing().
  void begin_step(const StepView& step) {
    if (clearance_.is_extended()) observe(step.t0, step.x0.data());
    ranges_.begin_step();
    clearance_.begin_step(step);
  }
  /// Whether function i has the sign `side` throughout the step. Only gaps of contacts are tested: other events are
  /// few, and ensembles, which evaluate the same ones, count the evaluations of each step.
  bool is_clear(std::size_t i, int side) {
    if (i < first_contact()) return false;
    const bool clear = is_available(i) && clearance_.is_clear(i, side);
    if (const std::optional<std::size_t> j = solved_gap(i)) solved_contacts_->set_clear(*j, clear);
    return clear;
  }
  /// To be called at the start of a run.
  void start() { clearance_.start(); }
  Clearance::State save() const { return clearance_.save(problem_.parameters); }
  void restore(const Clearance::State& from) { clearance_.restore(from, problem_.parameters); }
  /// All functions are evaluated again: the state may have changed.
  void forget_step() {
    if (solved_contacts_ != nullptr) solved_contacts_->forget_clear();
  }

 private:
  /// The contact whose gap, or normal force, function i is; none: it is another function.
  std::optional<std::size_t> solved_gap(std::size_t i) const {
    constexpr std::size_t per = SolvedContacts::values_per_contact;
    if (i < first_solved_contact() || i >= first_jump() || (i - first_solved_contact()) % per != 0) return std::nullopt;
    return (i - first_solved_contact()) / per;
  }
  /// Whether function i is available as an expression, in the present modes.
  bool is_available(std::size_t i) const {
    if (model_.mode().charts() != 0) return false;
    if (i >= first_solved_contact() && i < first_jump())
      return solved_contacts_->is_open((i - first_solved_contact()) / SolvedContacts::values_per_contact);
    if (i < first_contact()) return true;
    const std::size_t j = (i - first_contact()) / contact_values;
    return j < problem_.code->contacts.size() && problem_.code->contacts[j].unilateral &&
           contact_digit(model_.contact_mode(), j) >= 3;
  }
  /// Contacts observe the sizes of their gaps and speeds, from which roundings follow.
  void observe(double t, const double* x) {
    if (!contacts_ && solved_contacts_ == nullptr) return;
    forget_step();
    values_.resize(size());
    (*this)(t, x, values_.data());
  }

  const Problem& problem_;
  Model& model_;
  const std::unique_ptr<ContactModes>& contacts_;
  SolvedContacts* solved_contacts_ = nullptr;
  EventRanges ranges_;
  Jumps jumps_;
  Clearance clearance_;
  std::vector<double> values_;
};

}  // namespace eom::hybrid
