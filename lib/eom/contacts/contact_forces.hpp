// SPDX-License-Identifier: MIT
// Forces of contacts in a given set of closed, sticking and sliding ones. In: compiled code whose inputs hold these
// forces, a state. Out: the forces with which closed contacts stay closed and sticking ones stick; the quantities from
// which the next set follows.
//
// The accelerations are affine in the forces. Evaluations of the right-hand side with unit forces give their slopes, in
// every formulation of the equations (unit_responses.hpp). Dependent rows (four corners on a plane) have forces within
// their laws, if there are any (admissible_forces.hpp).
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/contacts/admissible_forces.hpp"
#include "eom/contacts/description.hpp"
#include "eom/contacts/least_norm.hpp"
#include "eom/contacts/slip_start.hpp"
#include "eom/contacts/unit_responses.hpp"

namespace eom::contacts {

/// The mode of a contact, as in the output mode.NAME.
enum class Mode { sliding_back = -1, closed = 0, sliding = 1, open = 2 };

/// The mode of a contact, with what it needs beside it.
struct ContactState {
  Mode mode = Mode::closed;           // closed: sticks, or has no friction
  double normal_sign = 1;             // of lambda, for contacts that cannot open
  std::array<double, 2> direction{};  // of slip in two directions, where the slip is too small to have one
  bool starts = false;                // slip in two directions has begun and is still that small
};

/// Which of the forces are wanted that the motion does not determine.
enum class ForceChoice {
  any,         // for accelerations, which do not depend on it
  admissible,  // within the limits of all laws, if any are: for their signs
  unique       // the same ones for the same state: for outputs
};

/// The forces of all contacts at one state, in given modes.
class ContactForces {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// Both must outlive this object.
  ContactForces(const Set& set, System& system)
      : set_(set),
        system_(system),
        responses_of_(set, system),
        n_(system.coordinates()),
        states_(set.contacts.size()),
        c_(set.values),
        lambda_(set.contacts.size(), 0.0),
        phi_(set.contacts.size()),
        free_(n_) {
    for (std::size_t j = 0; j < set_.contacts.size(); ++j) {
      for (std::size_t i = 0; i < set_.contacts.size() && contact(j).unilateral; ++i) {
        for (const Row& slip : contact(i).slip)
          if (i != j && slip.columns == contact(j).normal.columns) alike_.push_back({j, i, &slip});
      }
    }
  }

  /// The contacts.
  const Set& set() const { return set_; }
  /// The mode of each contact.
  std::vector<ContactState>& states() {
    ++changes_;
    return states_;
  }
  const std::vector<ContactState>& states() const { return states_; }
  /// Differs after each access that may change modes.
  std::size_t changes() const { return changes_; }
  /// The description of contact j.
  const Description& contact(std::size_t j) const { return set_.contacts[j]; }
  /// Whether contact j is not open.
  bool is_closed(std::size_t j) const { return states_[j].mode != Mode::open; }
  /// Whether contact j is closed and has static friction.
  bool is_sticking(std::size_t j) const { return contact(j).sticks && states_[j].mode == Mode::closed; }

  /// The least slip in two directions that has a direction, and the slip at which a start ends (slip_start.hpp).
  void set_least_slip(double least, double start) { least_slip_ = least, start_slip_ = start; }
  /// The speeds set by set_least_slip().
  double least_slip() const { return least_slip_; }
  double start_slip() const { return start_slip_; }

  /// Evaluates the rows at (t, x); u has no contact forces.
  int evaluate_rows(double t, const double* x, const double* u) { return system_.rows(t, x, u, c_.data()); }
  /// An entry of the array c at the last state.
  double value(std::size_t place) const { return c_[place]; }
  /// The velocity of the row at the last state.
  double rate(const Row& row) const { return c_[row.rate()]; }
  /// The magnitude of the slip of contact j.
  double slip_speed(std::size_t j) const {
    double square = 0;
    for (const Row& row : contact(j).slip) square += rate(row) * rate(row);
    return std::sqrt(square);
  }
  /// The acceleration of a row's velocity.
  double acceleration(const Row& row, const Vector& qddot) const { return c_[row.bias()] + change(row, qddot); }
  /// The acceleration of the row that qddot causes.
  double change(const Row& row, const Eigen::Ref<const Vector>& qddot) const {
    double sum = 0;
    for (std::size_t k = 0; k < row.columns.size(); ++k)
      sum += c_[row.slope(k)] * qddot(static_cast<Index>(row.columns[k]));
    return sum;
  }
  /// The sum of the absolute values of the terms of a row times a vector of coordinates or rates.
  double terms(const Row& row, const double* values) const {
    double sum = 0;
    for (std::size_t k = 0; k < row.columns.size(); ++k) sum += std::abs(c_[row.slope(k)] * values[row.columns[k]]);
    return sum;
  }

  /// The direction of slip of a sliding contact, times the share of the Coulomb force that its law gives.
  std::array<double, 2> direction(std::size_t j) const {
    if (j < prescribed_.size() && prescribed_[j]) return *prescribed_[j];
    const Description& at = contact(j);
    std::array<double, 2> w{};
    for (std::size_t a = 0; a < at.slip.size(); ++a) w[a] = rate(at.slip[a]);
    if (at.width != none) {
      const double size = std::sqrt(w[0] * w[0] + w[1] * w[1] + c_[at.width] * c_[at.width]);
      if (size == 0) return {};  // a slip that constraints prescribe has no width
      return {w[0] / size, w[1] / size};
    }
    if (at.slip.size() == 1) return {states_[j].mode == Mode::sliding_back ? -1.0 : 1.0, 0};
    return friction_direction(w, states_[j].direction, least_slip_, states_[j].starts ? start_slip_ : least_slip_);
  }
  /// Sets the directions of contacts, in place of those of their slip; empty: none. For derivatives, where the slip is
  /// much smaller than the widths of differences.
  void prescribe_directions(std::vector<std::optional<std::array<double, 2>>> directions) {
    ++changes_;
    prescribed_ = std::move(directions);
  }
  /// Whether the friction of a contact follows from its normal force and its slip.
  bool has_friction(std::size_t j) const {
    return is_closed(j) && !contact(j).slip.empty() && !(contact(j).sticks && states_[j].mode == Mode::closed);
  }

  using Pattern = contacts::Pattern;
  /// The unit force of lambda of contact j; with_friction: and of the friction that follows from it.
  Pattern normal_pattern(std::size_t j, bool with_friction) const {
    const Description& at = contact(j);
    Pattern pattern{j, -1, {{at.force_input, 1.0}}};
    if (!with_friction || !has_friction(j)) return pattern;
    const std::array<double, 2> along = direction(j);
    const double strength = c_[at.dynamic_coefficient] * c_[at.normal_scale] * states_[j].normal_sign;
    for (std::size_t a = 0; a < at.slip.size(); ++a)
      pattern.inputs.emplace_back(at.friction_input + a, -strength * along[a]);
    return pattern;
  }
  /// The unit friction of contact j along tangent a.
  Pattern tangent_pattern(std::size_t j, std::size_t a) const {
    return {j, static_cast<int>(a), {{contact(j).friction_input + a, 1.0}}};
  }

  /// The accelerations without forces of contacts but for friction with a given normal force. They stay in `u`.
  int evaluate_free(double t, const double* x, double* u) {
    for (std::size_t j = 0; j < set_.contacts.size(); ++j) {
      const Description& at = contact(j);
      if (at.has_constraint() || !has_friction(j)) continue;
      const std::array<double, 2> along = direction(j);
      const double force = c_[at.dynamic_coefficient] * std::abs(c_[at.given_normal]);
      for (std::size_t a = 0; a < at.slip.size(); ++a) u[at.friction_input + a] = -force * along[a];
    }
    const int code = system_.accelerations(t, x, u, free_.data());
    return code != 0 || free_.allFinite() ? code : code_not_finite;
  }
  /// The result of evaluate_free(): n.
  const Vector& free_accelerations() const { return free_; }
  /// The accelerations with the forces of the current states. u has no contact forces. Rows are evaluated.
  int evaluate_accelerations(double t, const double* x, double* u, Vector& qddot) {
    if (const int code = solve(t, x, u, ForceChoice::any); code != 0) return code;
    if (const int code = evaluate_rows(t, x, u); code != 0) return code;
    qddot.resize(static_cast<Index>(n_));
    return system_.accelerations(t, x, u, qddot.data());
  }

  /// The changes of the accelerations for unit forces, one column each, after evaluate_free().
  int responses(double t, const double* x, double* u, const std::vector<Pattern>& patterns,
                UnitResponses::Groups& groups, Matrix& result) {
    return responses_of_.evaluate(t, x, u, free_, patterns, groups, result);
  }

  /// Whether all contacts are open: there are no forces, and the rows need not be evaluated.
  bool all_open() const {
    return std::all_of(states_.begin(), states_.end(), [](const ContactState& s) { return s.mode == Mode::open; });
  }

  /// Solves for the forces in the current states and adds them to u, whose contact forces are 0. Returns a code. Rows
  /// are evaluated unless all contacts are open. choice: of forces that the motion does not determine.
  int solve(double t, const double* x, double* u, ForceChoice choice = ForceChoice::unique) {
    if (all_open()) {
      margins_.assign(set_.contacts.size(), 1.0);
      force_size_.assign(set_.contacts.size(), 0.0);
      force_per_acceleration_.assign(set_.contacts.size(), 0.0);
      std::fill(lambda_.begin(), lambda_.end(), 0.0);
      std::fill(phi_.begin(), phi_.end(), std::array<double, 2>{});
      write_modes(u);
      return 0;
    }
    if (const int code = evaluate_rows(t, x, u); code != 0) return code;
    if (const int code = evaluate_free(t, x, u); code != 0) return code;
    std::vector<Pattern>& patterns = patterns_;
    patterns.clear();
    rows_.clear();
    for (std::size_t j = 0; j < set_.contacts.size(); ++j) {
      if (!is_closed(j)) continue;
      if (contact(j).has_constraint() && !is_prevented_by_sticking(j))
        patterns.push_back(normal_pattern(j, true)), rows_.push_back(&contact(j).normal);
      for (std::size_t a = 0; a < contact(j).slip.size() && is_sticking(j); ++a)
        patterns.push_back(tangent_pattern(j, a)), rows_.push_back(&contact(j).slip[a]);
    }
    const auto count = static_cast<Index>(patterns.size());
    force_size_.assign(set_.contacts.size(), 0.0);
    force_per_acceleration_.assign(set_.contacts.size(), 0.0);
    const std::size_t before = groups_.changes;
    if (const int code = responses(t, x, u, patterns, groups_, responses_); code != 0) return code;
    if (before != groups_.changes) couple_rows();
    Matrix& W = W_;
    W.setZero(count, count);
    Vector right(count);
    for (Index k = 0; k < count; ++k) {
      for (const std::size_t i : coupled_[static_cast<std::size_t>(k)])
        W(static_cast<Index>(i), k) = change(*rows_[i], responses_.col(k));
      const Row& row = *rows_[static_cast<std::size_t>(k)];
      right(k) = -acceleration(row, free_);
      const double share = std::abs(W(k, k)), size = observe_acceleration(row);
      const std::size_t j = patterns[static_cast<std::size_t>(k)].contact;
      if (!(share > 0)) continue;
      force_size_[j] += size / share;
      force_per_acceleration_[j] = std::max(force_per_acceleration_[j], 1 / share);
    }
    margins_.assign(set_.contacts.size(), 1.0);
    choice_error_ = 0;
    std::fill(lambda_.begin(), lambda_.end(), 0.0);
    std::fill(phi_.begin(), phi_.end(), std::array<double, 2>{});
    if (count > 0) {
      LeastNorm forces = least_norm_.solve(W, right);
      undetermined_ = undetermined_ || forces.rank < count;
      if (forces.rank < count) make_admissible(forces.x, choice);
      for (Index k = 0; k < count; ++k) {
        const Pattern& pattern = patterns[static_cast<std::size_t>(k)];
        push(u, pattern, forces.x(k));
        if (pattern.component < 0) {
          lambda_[pattern.contact] = forces.x(k);
          if (has_friction(pattern.contact))
            margins_[pattern.contact] = W(k, k), signs_of_margins(pattern.contact, right(k));
        } else {
          pass_to_stop(u, pattern, forces.x(k));
        }
      }
    }
    for (std::size_t j = 0; j < set_.contacts.size(); ++j)
      for (std::size_t a = 0; a < contact(j).slip.size(); ++a) phi_[j][a] = u[contact(j).friction_input + a];
    write_modes(u);
    return 0;
  }

  /// Writes the modes of all contacts into the inputs u.
  void write_modes(double* u) const {
    for (std::size_t j = 0; j < set_.contacts.size(); ++j)
      u[contact(j).mode_input] = static_cast<double>(states_[j].mode);
  }

  /// Of the last solve(): lambda, the friction, the normal force (positive in compression).
  double lambda(std::size_t j) const { return lambda_[j]; }
  /// The friction along the tangents.
  const std::array<double, 2>& friction(std::size_t j) const { return phi_[j]; }
  /// The normal force.
  double normal_force(std::size_t j) const {
    const Description& at = contact(j);
    return at.has_constraint() ? c_[at.normal_scale] * lambda_[j] : std::abs(c_[at.given_normal]);
  }
  /// Smaller accelerations of gaps and slip are rounding: a share of the largest sum of terms, of any contact, since
  /// reset().
  double acceleration_rounding() const { return 1e-13 * largest_acceleration_; }
  /// Observes the accelerations of all contacts, after evaluate_free() and evaluate_rows().
  void observe_accelerations() {
    for (const Description& at : set_.contacts)
      if (at.has_constraint()) observe_acceleration(at.normal);
  }
  /// The force of contact j that changes the acceleration of its gap by 1, of the last solve(); 0 if it is open.
  double force_per_acceleration(std::size_t j) const { return force_per_acceleration_[j]; }
  /// The size of the forces that balance the terms of the accelerations of a contact: the scale of their rounding.
  double force_size(std::size_t j) const { return force_size_[j]; }
  /// The error of forces that the motion does not determine, of the last solve(): a disc in a corner touches the wall
  /// without a force.
  double choice_error() const { return choice_error_; }
  /// Of a sliding contact: the derivative of the acceleration of its gap with respect to lambda. Not positive:
  /// Painleve's case, in which its law has no solution or several.
  double margin(std::size_t j) const { return margins_[j]; }
  /// Whether a law with a negative margin has several solutions (the free contact separates), not none.
  bool has_several(std::size_t j) const { return several_.size() > j && several_[j]; }
  /// Whether the forces of some state were not unique.
  bool undetermined() const { return undetermined_; }
  /// Begins anew with undetermined() and acceleration_rounding().
  void reset() { undetermined_ = false, largest_acceleration_ = 0, discard_factors(); }
  /// Solves the next equations anew, without factors of earlier states.
  void discard_factors() {
    least_norm_.reset();
    preload_.resize(0);
    effect_inverse_.resize(0, 0);
  }

  static constexpr int code_not_finite = UnitResponses::code_not_finite;

 private:
  /// The rows whose accelerations a pattern may change, after a change of the patterns.
  void couple_rows() {
    discard_factors();
    std::vector<std::vector<std::size_t>> rows_of(n_);  // per coordinate
    for (std::size_t i = 0; i < rows_.size(); ++i)
      for (const std::size_t column : rows_[i]->columns) rows_of[column].push_back(i);
    coupled_.assign(patterns_.size(), {});
    for (std::size_t k = 0; k < patterns_.size(); ++k) {
      for (const std::size_t column : responses_of_.affected(patterns_[k]))
        coupled_[k].insert(coupled_[k].end(), rows_of[column].begin(), rows_of[column].end());
      std::sort(coupled_[k].begin(), coupled_[k].end());
      coupled_[k].erase(std::unique(coupled_[k].begin(), coupled_[k].end()), coupled_[k].end());
    }
  }
  /// The sum of the terms of the acceleration of a row.
  double observe_acceleration(const Row& row) {
    const double size = std::abs(c_[row.bias()]) + terms(row, free_.data());
    if (std::isfinite(size)) largest_acceleration_ = std::max(largest_acceleration_, size);
    return size;
  }
  /// s with row = s times the other, of the same columns; 0 if they are not parallel.
  double ratio(const Row& row, const Row& other) const;
  /// Whether friction sticks along the normal of contact j, as of a coordinate on its end stop: their rows are one.
  bool is_prevented_by_sticking(std::size_t j) const;
  /// What friction would take of a force that presses on a contact along its direction is the force of that contact:
  /// friction acts where nothing else prevents slip.
  void pass_to_stop(double* u, const Pattern& tangent, double force);
  /// Moves forces that the motion does not determine, of patterns_, within the limits of their laws.
  void make_admissible(Vector& forces, ForceChoice choice);
  /// limits_ of patterns_.
  void write_limits();
  /// Removes the part of forces of patterns_ that changes accelerations. False: forces are unchanged.
  bool remove_effect(Vector& forces);
  void signs_of_margins(std::size_t j, double minus_free) {
    several_.resize(set_.contacts.size());
    several_[j] = minus_free < 0;
  }

  /// A contact that can open, and the slip of another one in the same coordinates.
  struct Alike {
    std::size_t stop, sticking;
    const Row* slip;
  };

  const Set& set_;
  System& system_;
  UnitResponses responses_of_;
  std::size_t n_;
  std::vector<ContactState> states_;
  std::vector<double> c_, lambda_, margins_, force_size_, force_per_acceleration_;
  std::vector<std::array<double, 2>> phi_;
  std::vector<std::optional<std::array<double, 2>>> prescribed_;
  std::vector<bool> several_;
  std::vector<Alike> alike_;
  std::vector<Pattern> patterns_;
  std::vector<const Row*> rows_;
  UnitResponses::Groups groups_;                   // of patterns_
  std::vector<std::vector<std::size_t>> coupled_;  // per pattern: the rows whose accelerations it may change
  LeastNormSolver least_norm_;
  std::vector<ForceLimit> limits_;  // of the forces of patterns_
  Vector preload_;                  // forces without effect that had the largest margins in some earlier state
  double preload_margin_ = 0;       // the least of these margins
  Matrix effect_inverse_;           // pseudoinverse of responses_ of some earlier state, columns of length 1
  Vector free_;
  Matrix responses_, W_;  // n x patterns; of rows_
  double least_slip_ = 0, start_slip_ = 0, largest_acceleration_ = 0, choice_error_ = 0;
  std::size_t changes_ = 0;
  bool undetermined_ = false;
};

}  // namespace eom::contacts

#include "eom/contacts/force_limits.hpp"       // the members that find admissible forces
#include "eom/contacts/friction_at_stops.hpp"  // the members for friction along the normal of another contact
