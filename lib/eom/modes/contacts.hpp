// SPDX-License-Identifier: MIT
// Contacts as modes (sticking, sliding, open): the functions that bound each mode, and the transitions at their zeros.
// In: the contacts of a model, its functions rhs(t, x, mode, dx) and contacts(t, x, mode, g) in the numbering of the
// C ABI (docs/abi.md, "Modes"), five values per contact:
//   slip    the slip speed along the (first) tangent
//   above   one direction: mu_s |N| - phi; two: mu_s |N| - |phi|
//   below   one direction: mu_s |N| + phi; two: the slip speed along the second tangent
//   hold    the normal force, positive in compression; for an open contact the gap
//   margin  of the solution of the friction law: if it is negative there is none, or several
// and the changes of velocities (ContactMotion below). Out: the table and the rule of integrate_modes(), and the mode
// of a start.
//
// Sliding in two directions has no direction at slip 0. It ends at the least slip that counts, from which the end is
// extrapolated. It starts with twice that slip, in the direction in which friction yields.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eom/modes/contact_table.hpp"
#include "eom/modes/machine.hpp"

namespace eom {

/// For contacts with one sliding direction that cannot open: velocities never change.
struct ContactMotion {
  /// Velocities after an impact at contact j, with the closed contacts of `mode`. Returns a code of the ABI.
  int impact(double, std::span<double>, int, std::size_t, double) { return 0; }
  /// Sets the gap speeds of all closed contacts of `mode` to 0.
  int close(double, std::span<double>, int) { return 0; }
  /// Sets the slip at contact j to 0, in `mode`.
  int stick(double, std::span<double>, int, std::size_t) { return 0; }
  /// Advances from (t, x), where contact j slides slowly, to its stop. Returns keeps_sliding if the slip grows instead.
  int stop(double&, std::span<double>, int, std::size_t) { return 0; }
  /// Sets twice the least slip, in the direction in which contact j yields. In `mode` it still sticks.
  int slide(double, std::span<double>, int, std::size_t) { return 0; }
  /// The least slip in two directions that counts.
  double min_slip_speed(std::size_t) const { return 1e-12; }
  /// d(gap)/dt of contact j.
  double gap_rate(double, std::span<const double>, std::size_t) { return 0; }
  /// Slip and gap speeds up to this value count as zero.
  double negligible_speed() const { return 1e-12; }
};

/// Returned by ContactMotion::stop in place of a code.
inline constexpr int keeps_sliding = -1;

/// The rule of transitions of contacts, for integrate_modes().
template <class Rhs, class Functions, class Motion = ContactMotion>
class Contacts {
 public:
  /// states: length of x. rhs(t, x, mode, dx) and functions(t, x, mode, g) return codes. Throws std::invalid_argument
  /// for too many contacts, or if contacts change velocities and no `motion` is given.
  Contacts(std::vector<Contact> contacts, std::size_t states, Rhs rhs, Functions functions, Motion motion = {})
      : contacts_(std::move(contacts)),
        dx_(states),
        g_(contact_values * contacts_.size()),
        force_size_(contacts_.size(), 0.0),
        rhs_(std::move(rhs)),
        functions_(std::move(functions)),
        motion_(std::move(motion)) {
    if (contacts_.size() > max_contacts)
      throw std::invalid_argument("eom::Contacts: more contacts than a mode has digits for");
    for (const Contact& contact : contacts_) {
      if (std::is_same_v<Motion, ContactMotion> && (contact.dimensions == 2 || contact.unilateral))
        throw std::invalid_argument("eom::Contacts: '" + contact.name + "' changes velocities, and no motion is given");
    }
    table_ = modes::contact_mode_table(contacts_);
  }

  /// Number of event functions: contact_values of each contact.
  std::size_t functions() const { return g_.size(); }
  /// The monitored surfaces of each mode.
  std::span<const Mode> table() const { return table_; }
  /// e: speed after an impact / speed before it, in [0, 1].
  void set_restitution(std::size_t contact, double e) { contacts_[contact].restitution = e; }
  /// The next impact closes all of these contacts, whose bounces have ended. Closing one after the other would open the
  /// earlier ones.
  void close_together(std::vector<std::size_t> contacts) { close_together_ = std::move(contacts); }

  /// The most recent impacts.
  struct Hits {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::array<std::size_t, 8> contacts{none, none, none, none, none, none, none, none};
    std::size_t count = 0;

    /// Records an impact of this contact.
    void add(std::size_t contact) { contacts[count++ % contacts.size()] = contact; }
    /// Number of recorded impacts of this contact.
    std::ptrdiff_t of(std::size_t contact) const { return std::count(contacts.begin(), contacts.end(), contact); }
  };
  /// The most recent impacts.
  const Hits& hits() const { return hits_; }
  /// Restores the recorded impacts.
  void set_hits(const Hits& hits) { hits_ = hits; }

  /// Per contact: the largest normal force that a decision has met.
  const std::vector<double>& force_sizes() const { return force_size_; }
  /// Restores these forces.
  void set_force_sizes(const std::vector<double>& sizes) { force_size_ = sizes; }

  /// Transforms the functions into the monitored ones: the slip speed in two directions, minus the least one.
  void shift_to_watched(double* g) const {
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (contacts_[j].dimensions != 2) continue;
      double* const value = g + contact_values * j;
      value[0] = std::hypot(value[0], value[2]) - motion_.min_slip_speed(j);
      value[2] = 1;
    }
  }

  /// The mode of a start. A contact with slip slides. Without slip it sticks if the static law allows, else it starts
  /// to slide. Unilateral contacts that are open, or open at once, are open. `open`: per contact; empty: all are
  /// closed. x changes if an impact occurs at the start.
  int start(double t, std::span<double> x, std::span<const bool> open = {}) {
    int mode = 0;
    for (std::size_t j = 0; j < open.size(); ++j)
      if (contacts_[j].unilateral && open[j]) mode = with_contact_digit(mode, j, 3);
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (!contacts_[j].unilateral || contact_digit(mode, j) == 3) continue;
      const double speed = motion_.gap_rate(t, x, j);
      if (speed > motion_.negligible_speed()) mode = with_contact_digit(mode, j, 3);
      if (speed < -motion_.negligible_speed()) mode = apply_impact(t, x, mode, j).mode;
    }
    return consistent_mode(t, x, mode);
  }

  /// The next mode after a crossing. Changes the velocities in `point.x` at an impact.
  Transition operator()(const ModePoint& point) {
    const std::size_t j = point.crossing.function / contact_values;
    switch (point.crossing.function % contact_values) {
      case 0: return stop_sliding(point, j);
      // If friction reaches its limit along the tangent, sliding starts against it, and vice versa.
      case 1: return start_sliding(point, j, contacts_[j].dimensions == 2 ? 1 : 2);
      case 2: return start_sliding(point, j, 1);
      case 3: return change_normal_force(point, j);
      default: break;
    }
    const int code = rhs_(point.t, point.x.data(), point.mode, dx_.data());
    return {point.mode, "singular_configuration", contacts_[j].name,
            code == 4 ? Outcome::friction_many_solutions : Outcome::friction_no_solution};
  }

  /// An infinite sequence of ever smaller bounces ends with lasting contact of all contacts that took turns, as in a
  /// corner.
  std::optional<Transition> settle_chattering(const ModePoint& point) {
    const std::size_t j = point.crossing.function / contact_values;
    if (point.crossing.function % contact_values != 3 || !contacts_[j].unilateral) return std::nullopt;
    int mode = with_contact_digit(point.mode, j, 0);
    bool alone = true;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      constexpr std::ptrdiff_t turns = 3;
      if (i == j || !contacts_[i].unilateral || hits_.of(i) < turns) continue;
      mode = with_contact_digit(mode, i, 0);
      alone = false;
    }
    if (alone) return apply_impact(point.t, point.x, with_contact_digit(point.mode, j, 3), j, false);
    if (const int code = motion_.close(point.t, point.x, mode); code != 0) return failed(point, code);
    const std::vector<std::string> further_names = newly_closed_names(j, point.mode, mode);
    return Transition{consistent_mode(point.t, point.x, mode), "contact", contacts_[j].name, Outcome::done,
                      further_names};
  }

 private:
  Transition failed(const ModePoint& point, int code) const { return {point.mode, "", "", outcome_of_abi_code(code)}; }

  double speed(const double* g, std::size_t j) const {
    const double* const value = g + contact_values * j;
    return contacts_[j].dimensions == 2 ? std::hypot(value[0], value[2]) : std::abs(value[0]);
  }
  bool static_law_holds(std::size_t j) const {
    const double* const g = g_.data() + contact_values * j;
    return g[1] >= 0 && (contacts_[j].dimensions == 2 || g[2] >= 0);
  }

  Transition stop_sliding(const ModePoint& point, std::size_t j) {
    const int digit = contact_digit(point.mode, j), sign = digit - digit % 3,
              sticking = with_contact_digit(point.mode, j, sign);
    const std::string& name = contacts_[j].name;
    if (contacts_[j].dimensions == 2) {
      const int code = motion_.stop(point.t, point.x, point.mode, j);
      if (code == keeps_sliding) return {point.mode};
      if (code != 0) return failed(point, code);
    }
    if (const int code = functions_(point.t, point.x.data(), sticking, g_.data()); code != 0)
      return failed(point, code);
    if (contacts_[j].unilateral && g_[contact_values * j + 3] < 0) {
      const int now = consistent_mode(point.t, point.x, sticking), state = contact_digit(now, j);
      if (state % 3 != 0 || state == 3) return {now, state == 3 ? "lose_contact" : "reverse", name};
    }
    if (static_law_holds(j)) {
      const int code = contacts_[j].dimensions == 2 ? motion_.stick(point.t, point.x, sticking, j) : 0;
      return code != 0 ? failed(point, code) : Transition{sticking, contacts_[j].rolls ? "roll" : "stick", name};
    }
    if (contacts_[j].dimensions == 2) {
      const int code = motion_.slide(point.t, point.x, sticking, j);
      return code != 0 ? failed(point, code) : Transition{point.mode, "reverse", name};
    }
    return {with_contact_digit(point.mode, j, sign + 3 - digit % 3), "reverse", name};
  }

  Transition start_sliding(const ModePoint& point, std::size_t j, int way) {
    const int digit = contact_digit(point.mode, j);
    if (contacts_[j].dimensions == 2) {
      if (const int code = motion_.slide(point.t, point.x, point.mode, j); code != 0) return failed(point, code);
    }
    return {with_contact_digit(point.mode, j, digit - digit % 3 + way), "slip", contacts_[j].name};
  }

  Transition change_normal_force(const ModePoint& point, std::size_t j) {
    const int digit = contact_digit(point.mode, j);
    if (!contacts_[j].unilateral) return {with_contact_digit(point.mode, j, (digit + 3) % 6)};
    if (digit == 3) return apply_impact(point.t, point.x, point.mode, j);
    return {with_contact_digit(point.mode, j, 3), "lose_contact", contacts_[j].name};
  }

  /// Names of the contacts other than j that are open in one mode and closed in the next.
  std::vector<std::string> newly_closed_names(std::size_t j, int before, int after) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (i != j && contacts_[i].unilateral && contact_digit(before, i) == 3 && contact_digit(after, i) < 3)
        names.push_back(contacts_[i].name);
    }
    return names;
  }

  /// Handles an impact at contact j, which is open. It remains open if it bounces.
  Transition apply_impact(double t, std::span<double> x, int mode, std::size_t j, bool bounces = true) {
    // The gap opens: after an impact, or after the end of the normal force, its rounding errors cross zero once more.
    if (bounces && close_together_.empty()) {
      const double rate = motion_.gap_rate(t, x, j);
      if (rate > motion_.negligible_speed()) return {mode};
      if (rate >= -motion_.negligible_speed() && !is_pressed(t, x, mode, j)) return {mode};
    }
    hits_.add(j);
    if (const std::vector<std::size_t> all = std::exchange(close_together_, {}); !all.empty()) {
      const std::vector<double> before(x.begin(), x.end());
      int closed = mode;
      for (const std::size_t i : all) closed = with_contact_digit(closed, i, 0);
      if (motion_.close(t, x, closed) == 0)
        return {consistent_mode(t, x, closed), "contact", contacts_[j].name, Outcome::done,
                newly_closed_names(j, mode, closed)};
      std::copy(before.begin(), before.end(), x.begin());  // more contacts than degrees of freedom
    }
    const double speed = motion_.gap_rate(t, x, j), e = bounces ? contacts_[j].restitution : 0;
    const bool away = e > 0 && -speed * e > motion_.negligible_speed();
    if (speed < 0) {
      const int code = motion_.impact(t, x, with_contact_digit(mode, j, 0), j, away ? e : 0);
      if (code != 0) return {mode, "", "", outcome_of_abi_code(code)};
    }
    const int after = away ? mode : with_contact_digit(mode, j, 0);
    return {consistent_mode(t, x, after), "contact", contacts_[j].name};
  }

  /// The mode in which the closed contacts of `mode` slide or stick according to the velocities.
  int consistent_mode(double t, std::span<double> x, int mode) {
    const auto is_closed = [&](std::size_t j) { return !contacts_[j].unilateral || contact_digit(mode, j) < 3; };
    const auto evaluate = [&] {
      if (functions_(t, x.data(), mode, g_.data()) != 0) return false;
      for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const double force = std::abs(g_[contact_values * j + 3]);
        if (is_closed(j) && std::isfinite(force)) force_size_[j] = std::max(force_size_[j], force);
      }
      return true;
    };
    for (std::size_t j = 0; j < contacts_.size(); ++j) {  // contacts that an impact elsewhere has opened
      if (contacts_[j].unilateral && is_closed(j) && motion_.gap_rate(t, x, j) > motion_.negligible_speed())
        mode = with_contact_digit(mode, j, 3);
    }
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (!is_closed(j) || !contacts_[j].sticks) continue;
      const int high = contact_digit(mode, j) / 3 * 3;
      mode = with_contact_digit(mode, j, high);
      if (!evaluate()) return mode;
      if (speed(g_.data(), j) <= motion_.negligible_speed()) continue;
      const bool back = contacts_[j].dimensions == 1 && g_[contact_values * j] < 0;
      mode = with_contact_digit(mode, j, high + (back ? 2 : 1));
    }
    // One change may require another. If this leads to no admissible mode, all modes are tried.
    const int touching = mode;
    const std::vector<double> before(x.begin(), x.end());
    for (std::size_t round = 0; round < 4 * contacts_.size(); ++round) {
      if (!evaluate()) return mode;
      const int next = improved_mode(t, x, mode);
      if (next == mode) break;
      mode = next;
    }
    if (is_admissible(t, x, touching, mode)) return mode;
    const std::vector<double> after(x.begin(), x.end());
    std::copy(before.begin(), before.end(), x.begin());
    const int found = searched_mode(t, x, touching, mode);
    if (found == mode) std::copy(after.begin(), after.end(), x.begin());
    return found;
  }

  int improved_mode(double t, std::span<double> x, int mode) {
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      const int digit = contact_digit(mode, j);
      const double* g = g_.data() + contact_values * j;
      if (contacts_[j].unilateral && digit == 3) continue;
      // With a negative margin it would close again at once: neither state obeys the law. The right-hand side reports
      // this.
      if (contacts_[j].unilateral && g[3] < 0 && contacts_[j].dimensions > 0 && g[4] < 0) continue;
      if (contacts_[j].unilateral && g[3] < 0) return with_contact_digit(mode, j, 3);
      if (contacts_[j].surface && g[3] < 0) return with_contact_digit(mode, j, (digit + 3) % 6);
      if (digit % 3 != 0 || !contacts_[j].sticks || static_law_holds(j)) continue;
      if (contacts_[j].dimensions == 1) return with_contact_digit(mode, j, g[1] < 0 ? digit + 2 : digit + 1);
      if (motion_.slide(t, x, mode, j) == 0) return with_contact_digit(mode, j, digit + 1);
    }
    return mode;
  }

  /// Whether contact j, which touches without speed, has a normal force when it is closed. The force of one that has
  /// just opened is 0 but for the error of the time at which it did.
  bool is_pressed(double t, std::span<double> x, int mode, std::size_t j) {
    constexpr double rounding = 1e-9;
    std::vector<double> trial(x.begin(), x.end());  // sliding may begin in it
    const double size = force_size_[j];
    const int closed = consistent_mode(t, trial, with_contact_digit(mode, j, 0));
    if (contact_digit(closed, j) >= 3) return false;
    return functions_(t, trial.data(), closed, g_.data()) != 0 || g_[contact_values * j + 3] > rounding * size;
  }

  /// Whether the closed contacts of `touching`, in the states of `mode`, obey their laws at (t, x).
  bool is_admissible(double t, std::span<double> x, int touching, int mode);
  /// The first admissible mode among all states of the contacts that `touching` leaves open; `mode` if there is none.
  int searched_mode(double t, std::span<double> x, int touching, int mode);
  std::vector<int> candidates(int touching, std::size_t j) const;
  std::vector<double> later(double t, std::span<const double> x, int mode);

  std::vector<Contact> contacts_;
  std::vector<double> dx_, g_;
  std::vector<double> force_size_;  // force_sizes()
  std::vector<Mode> table_;
  Hits hits_;
  std::vector<std::size_t> close_together_;
  Rhs rhs_;
  Functions functions_;
  Motion motion_;
};

}  // namespace eom

#include "eom/modes/contact_search.hpp"  // the members that try modes
