// SPDX-License-Identifier: MIT
// Contacts as modes: sticking, sliding and apart; which functions bound each, and what follows where one of them is
// crossed. In: the contacts of a model, its functions rhs(t, x, mode, dx) and contacts(t, x, mode, g) in the numbering
// of the C ABI (docs/abi.md, "Modes"), five values per contact:
//   slip    the slip speed along the (first) tangent
//   above   mu_s |N| - phi of one direction, mu_s |N| - |phi| of two
//   below   mu_s |N| + phi of one direction; of two the slip speed along the second tangent
//   hold    the normal force as it presses; of a contact that is apart the gap
//   margin  of the law's solution: where it is negative there is none, or several
// and what changes velocities (ContactMotion below). Out: the table and the rule of integrate_modes(), and the mode of
// a start.
//
// Sliding in two directions has no value at slip 0. It ends at the least slip that counts, from where the little that
// is left is extrapolated, and starts with twice as much in the direction in which friction gives way.
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

#include "eom/modes/contact_state.hpp"
#include "eom/modes/machine.hpp"

namespace eom {

struct Contact : ContactShape {
  std::string name;
  double restitution = 0;  // of impacts where it can be left: speed after over speed before
};

/// For contacts with one direction of sliding that cannot be left: nothing changes velocities.
struct ContactMotion {
  /// Velocities after an impact at contact j, with the contacts that touch in `mode`. Returns a code of the ABI.
  int impact(double, std::span<double>, int, std::size_t, double) { return 0; }
  /// Gap speeds 0 of all contacts that touch in `mode`.
  int close(double, std::span<double>, int) { return 0; }
  /// Slip 0 at contact j in `mode`.
  int stick(double, std::span<double>, int, std::size_t) { return 0; }
  /// Goes on from (t, x), where contact j slides slowly, to where it stops; slips_on where it does not: its slip grows.
  int stop(double&, std::span<double>, int, std::size_t) { return 0; }
  /// Twice the least slip, in the direction in which contact j gives way; `mode` as it still sticks.
  int slide(double, std::span<double>, int, std::size_t) { return 0; }
  /// The least slip in two directions that counts.
  double least_slip(std::size_t) const { return 1e-12; }
  /// d(gap)/dt of contact j.
  double approach(double, std::span<const double>, std::size_t) { return 0; }
  /// Slip and gap speeds up to here count as none.
  double still() const { return 1e-12; }
};

inline constexpr std::size_t contact_values = 5;

/// Of ContactMotion::stop, in place of a code.
inline constexpr int slips_on = -1;

template <class Rhs, class Functions, class Motion = ContactMotion>
class Contacts {
 public:
  Contacts(std::vector<Contact> contacts, std::size_t states, Rhs rhs, Functions functions, Motion motion = {})
      : contacts_(std::move(contacts)),
        dx_(states),
        g_(contact_values * contacts_.size()),
        rhs_(std::move(rhs)),
        functions_(std::move(functions)),
        motion_(std::move(motion)) {
    if (contacts_.size() > max_contacts)
      throw std::invalid_argument("eom::Contacts: more contacts than a mode has digits for");
    for (const Contact& contact : contacts_) {
      if (std::is_same_v<Motion, ContactMotion> && (contact.dimensions == 2 || contact.unilateral))
        throw std::invalid_argument("eom::Contacts: '" + contact.name + "' changes velocities, and no motion is given");
    }
    make_table();
  }

  std::size_t functions() const { return g_.size(); }
  std::span<const Mode> table() const { return table_; }
  void restitution(std::size_t contact, double e) { contacts_[contact].restitution = e; }
  /// The next hit closes these contacts, whose bounces are over, at once: one after the other would lift the one
  /// before.
  void close_next(std::vector<std::size_t> contacts) { close_next_ = std::move(contacts); }

  /// Makes the functions those that are watched: the speed of slip in two directions, beyond the least one.
  void shift(double* g) const {
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (contacts_[j].dimensions != 2) continue;
      double* const value = g + contact_values * j;
      value[0] = std::hypot(value[0], value[2]) - motion_.least_slip(j);
      value[2] = 1;
    }
  }

  /// The mode of a start: what slips slides; what does not sticks if the static law allows, else slides off; what is
  /// apart (of contacts that can be left), or leaves at once, stays apart. `apart`: per contact; empty: all touch. x
  /// changes where something hits at the start.
  int start(double t, std::span<double> x, std::span<const bool> apart = {}) {
    int mode = 0;
    for (std::size_t j = 0; j < apart.size(); ++j)
      if (contacts_[j].unilateral && apart[j]) mode = with_contact_digit(mode, j, 3);
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (!contacts_[j].unilateral || contact_digit(mode, j) == 3) continue;
      const double speed = motion_.approach(t, x, j);
      if (speed > motion_.still()) mode = with_contact_digit(mode, j, 3);
      if (speed < -motion_.still()) mode = hit(t, x, mode, j).mode;
    }
    return settled(t, x, mode);
  }

  Transition operator()(const ModePoint& point) {
    const std::size_t j = point.crossing.function / contact_values;
    switch (point.crossing.function % contact_values) {
      case 0: return stop_sliding(point, j);
      // Friction at its limit along the tangent gives way against it, and the other way round.
      case 1: return start_sliding(point, j, contacts_[j].dimensions == 2 ? 1 : 2);
      case 2: return start_sliding(point, j, 1);
      case 3: return change_hold(point, j);
      default: break;
    }
    const int code = rhs_(point.t, point.x.data(), point.mode, dx_.data());
    return {point.mode, "singular_configuration", contacts_[j].name,
            code == 4 ? Outcome::friction_many_solutions : Outcome::friction_no_solution};
  }

  /// Bounces that accumulate end with contact: of all that took turns, as in a corner.
  std::optional<Transition> settle(const ModePoint& point) {
    const std::size_t j = point.crossing.function / contact_values;
    if (point.crossing.function % contact_values != 3 || !contacts_[j].unilateral) return std::nullopt;
    int mode = with_contact_digit(point.mode, j, 0);
    bool alone = true;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      constexpr std::ptrdiff_t turns = 3;
      if (i == j || !contacts_[i].unilateral || std::count(hits_.begin(), hits_.end(), i) < turns) continue;
      mode = with_contact_digit(mode, i, 0);
      alone = false;
    }
    if (alone) return hit(point.t, point.x, with_contact_digit(point.mode, j, 3), j, false);
    if (const int code = motion_.close(point.t, point.x, mode); code != 0) return failed(point, code);
    const std::vector<std::string> also = closed_beside(j, point.mode, mode);
    return Transition{settled(point.t, point.x, mode), "contact", contacts_[j].name, Outcome::done, also};
  }

 private:
  static constexpr std::size_t no_contact = static_cast<std::size_t>(-1);
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
      if (code == slips_on) return {point.mode};
      if (code != 0) return failed(point, code);
    }
    if (const int code = functions_(point.t, point.x.data(), sticking, g_.data()); code != 0)
      return failed(point, code);
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

  Transition change_hold(const ModePoint& point, std::size_t j) {
    const int digit = contact_digit(point.mode, j);
    if (!contacts_[j].unilateral) return {with_contact_digit(point.mode, j, (digit + 3) % 6)};
    if (digit == 3) return hit(point.t, point.x, point.mode, j);
    return {with_contact_digit(point.mode, j, 3), "lose_contact", contacts_[j].name};
  }

  /// Names of others than j that are apart in one mode and touch in the next.
  std::vector<std::string> closed_beside(std::size_t j, int before, int after) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (i != j && contacts_[i].unilateral && contact_digit(before, i) == 3 && contact_digit(after, i) < 3)
        names.push_back(contacts_[i].name);
    }
    return names;
  }

  /// An impact at contact j, which is apart; it stays so if it bounces.
  Transition hit(double t, std::span<double> x, int mode, std::size_t j, bool bounces = true) {
    hits_[hit_++ % hits_.size()] = j;
    if (const std::vector<std::size_t> all = std::exchange(close_next_, {}); !all.empty()) {
      const std::vector<double> before(x.begin(), x.end());
      int closed = mode;
      for (const std::size_t i : all) closed = with_contact_digit(closed, i, 0);
      if (motion_.close(t, x, closed) == 0)
        return {settled(t, x, closed), "contact", contacts_[j].name, Outcome::done, closed_beside(j, mode, closed)};
      std::copy(before.begin(), before.end(), x.begin());  // more contacts than directions to move in
    }
    const double speed = motion_.approach(t, x, j), e = bounces ? contacts_[j].restitution : 0;
    const bool away = e > 0 && -speed * e > motion_.still();
    if (speed < 0) {
      const int code = motion_.impact(t, x, with_contact_digit(mode, j, 0), j, away ? e : 0);
      if (code != 0) return {mode, "", "", outcome_of_abi_code(code)};
    }
    const int after = away ? mode : with_contact_digit(mode, j, 0);
    return {settled(t, x, after), "contact", contacts_[j].name};
  }

  /// The mode with the contacts that touch in `mode` sliding or sticking as the velocities say.
  int settled(double t, std::span<double> x, int mode) {
    const auto touches = [&](std::size_t j) { return !contacts_[j].unilateral || contact_digit(mode, j) < 3; };
    const auto evaluate = [&] { return functions_(t, x.data(), mode, g_.data()) == 0; };
    for (std::size_t j = 0; j < contacts_.size(); ++j) {  // what an impact elsewhere has lifted
      if (contacts_[j].unilateral && touches(j) && motion_.approach(t, x, j) > motion_.still())
        mode = with_contact_digit(mode, j, 3);
    }
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      if (!touches(j) || !contacts_[j].sticks) continue;
      const int high = contact_digit(mode, j) / 3 * 3;
      mode = with_contact_digit(mode, j, high);
      if (!evaluate()) return mode;
      if (speed(g_.data(), j) <= motion_.still()) continue;
      const bool back = contacts_[j].dimensions == 1 && g_[contact_values * j] < 0;
      mode = with_contact_digit(mode, j, high + (back ? 2 : 1));
    }
    // One change may call for another; contacts that do not settle are left to the rule.
    for (std::size_t round = 0; round < 4 * contacts_.size(); ++round) {
      if (!evaluate()) return mode;
      const int next = better(t, x, mode);
      if (next == mode) break;
      mode = next;
    }
    return mode;
  }

  int better(double t, std::span<double> x, int mode) {
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      const int digit = contact_digit(mode, j);
      const double* g = g_.data() + contact_values * j;
      if (contacts_[j].unilateral && digit == 3) continue;
      // With a margin below 0 it would be driven back at once: neither obeys the law, which the right-hand side tells.
      if (contacts_[j].unilateral && g[3] < 0 && contacts_[j].dimensions > 0 && g[4] < 0) continue;
      if (contacts_[j].unilateral && g[3] < 0) return with_contact_digit(mode, j, 3);
      if (contacts_[j].surface && g[3] < 0) return with_contact_digit(mode, j, (digit + 3) % 6);
      if (digit % 3 != 0 || !contacts_[j].sticks || static_law_holds(j)) continue;
      if (contacts_[j].dimensions == 1) return with_contact_digit(mode, j, g[1] < 0 ? digit + 2 : digit + 1);
      if (motion_.slide(t, x, mode, j) == 0) return with_contact_digit(mode, j, digit + 1);
    }
    return mode;
  }

  void watch_contact(Mode& mode, std::size_t j, int digit) const {
    const Contact& contact = contacts_[j];
    const std::size_t first = contact_values * j;
    const bool apart = contact.unilateral && digit >= 3;
    if (contact.sticks && !apart) {
      if (digit % 3 == 0) {
        mode.watched.push_back({first + 1, Direction::down});
        if (contact.dimensions == 1) mode.watched.push_back({first + 2, Direction::down});
      } else {
        mode.watched.push_back({first, digit % 3 == 1 ? Direction::down : Direction::up});
      }
    }
    if (!apart && contact.dimensions > 0) mode.watched.push_back({first + 4, Direction::down});
    if (contact.surface || contact.unilateral) mode.watched.push_back({first + 3, Direction::down});
    const char* state = apart                               ? " is apart"
                        : contact.dimensions == 0           ? " touches"
                        : !contact.sticks || digit % 3 != 0 ? " slides"
                        : contact.rolls                     ? " rolls"
                                                            : " sticks";
    mode.name += (mode.name.empty() ? "" : ", ") + contact.name + state;
  }

  void make_table() {
    std::size_t modes = 1;
    for (std::size_t j = 0; j < contacts_.size(); ++j) modes *= contact_states;
    table_.resize(modes);
    for (std::size_t m = 0; m < table_.size(); ++m) {
      for (std::size_t j = 0; j < contacts_.size(); ++j)
        watch_contact(table_[m], j, contact_digit(static_cast<int>(m), j));
    }
  }

  std::vector<Contact> contacts_;
  std::vector<double> dx_, g_;
  std::vector<Mode> table_;
  std::array<std::size_t, 8> hits_{no_contact, no_contact, no_contact, no_contact,
                                   no_contact, no_contact, no_contact, no_contact};  // the last ones
  std::size_t hit_ = 0;
  std::vector<std::size_t> close_next_;
  Rhs rhs_;
  Functions functions_;
  Motion motion_;
};

}  // namespace eom
