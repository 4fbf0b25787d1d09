// SPDX-License-Identifier: GPL-3.0-or-later
// The modes of the contacts during one integration: eom::Contacts on compiled code.
#pragma once

#include <functional>
#include <optional>

#include "run/contact_velocities.hpp"

namespace eomgen::run {

class ContactModes {
 public:
  using Inputs = std::function<const double*(double t)>;
  /// Functions of t, x, the mode of the contacts; the second gives contact_values per contact.
  using Function = std::function<int(double, const double*, int, double*)>;

  /// `states`: entries of dx; `changed`: told where velocities change, with the state before and after.
  ContactModes(const RunRequest& request, ConstraintRows& rows, std::size_t states, Inputs inputs, Function rhs,
               Function functions,
               std::function<void(double, std::span<const double> before, std::span<const double> after)> changed);

  std::size_t functions() const { return rule_.functions(); }
  int mode() const { return switch_ ? switch_->mode : 0; }
  /// The mode of a start; what slides off at once is told.
  std::vector<eom::ModeEvent> start(double t, std::span<double> x);
  void watch(std::span<eom::EventFunction> functions) const { switch_->watch(functions); }
  /// Makes the functions those that are watched; sizes of slips are kept in mind.
  void adjust(double* g);
  /// A step begins at (t, x).
  void hold(double t, const double* x);
  void tolerances(double rtol, double atol) { velocities_.tolerances(rtol, atol); }
  /// Whether slip in two directions changes in a step h by so much beside its speed that the step follows neither its
  /// direction nor its end. `now`: the answer before, so that it does not go to and fro.
  bool slow_slip(double t, const double* x, double h, bool now);
  /// A crossing of one of the functions; what is to be told of it.
  eom::AtEvent take(double& t, std::span<double> x, const eom::Crossing& crossing,
                    std::span<eom::EventFunction> functions);
  const eom::ModeEvent* told() const { return told_ ? &*told_ : nullptr; }
  /// Where the run was ended by a contact.
  std::optional<eom::Outcome> ended() const;
  const std::string& detail() const { return switch_->detail; }

 private:
  struct Motion {
    ContactModes* self;
    int impact(double t, std::span<double> x, int mode, std::size_t j, double e) const;
    int close(double t, std::span<double> x, int mode) const;
    int stick(double t, std::span<double> x, int mode, std::size_t j) const;
    int stop(double& t, std::span<double> x, int mode, std::size_t j) const;
    int slide(double t, std::span<double> x, int mode, std::size_t j) const;
    double least_slip(std::size_t j) const { return self->velocities_.least_slip(j); }
    double approach(double t, std::span<const double> x, std::size_t j) const;
    double still() const { return self->velocities_.still(); }
  };
  void end_bounces(double& t, std::span<double> x, std::size_t j);
  using Rule = eom::Contacts<Function, Function, Motion>;

  const RunRequest& request_;
  ConstraintRows& rows_;
  ContactVelocities velocities_;
  bool two_directions_ = false;      // some contact slides in two
  std::vector<double> restitution_;  // of each contact, at the start
  double largest_gap_ = 0;           // of contacts that are apart
  Inputs inputs_;
  std::function<void(double, std::span<const double>, std::span<const double>)> changed_;
  Function rhs_, functions_;
  Rule rule_;
  std::vector<double> g_, k_, middle_;
  std::optional<eom::modes::Switch<Rule>> switch_;
  std::optional<eom::ModeEvent> told_;
};

}  // namespace eomgen::run
