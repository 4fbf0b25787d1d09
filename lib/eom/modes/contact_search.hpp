// SPDX-License-Identifier: MIT
// The members of Contacts that try the modes of contacts without slip: friction of several contacts, and friction that
// draws a body to its surface, decide together which contacts stick, slide or open. In: a state, the contacts that
// touch. Out: a mode in which all of them obey their laws.
#pragma once

#include "eom/modes/contacts.hpp"

namespace eom {

namespace detail {

inline constexpr double short_time = 1e-6;  // of differences of velocities

}  // namespace detail

/// The state a short time later in `mode`; empty if it has no value.
template <class Rhs, class Functions, class Motion>
std::vector<double> Contacts<Rhs, Functions, Motion>::later(double t, std::span<const double> x, int mode) {
  if (rhs_(t, x.data(), mode, dx_.data()) != 0) return {};
  std::vector<double> result(x.begin(), x.end());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += detail::short_time * dx_[i];
  return result;
}

template <class Rhs, class Functions, class Motion>
bool Contacts<Rhs, Functions, Motion>::is_admissible(double t, std::span<double> x, int touching, int mode) {
  constexpr double of_forces = 1e-12, of_changes = 1e-8;
  if (functions_(t, x.data(), mode, g_.data()) != 0) return false;
  const std::vector<double> g = g_;
  std::vector<double> next;
  double known = 0;  // differences below this value are rounding
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    const Contact& contact = contacts_[j];
    const int digit = contact_digit(mode, j);
    const double* const value = g.data() + contact_values * j;
    const bool open = contact.unilateral && digit >= 3;
    if (contact.unilateral && contact_digit(touching, j) >= 3) continue;
    if (!open && (contact.unilateral || contact.surface) && !(value[3] >= -of_forces * force_size_[j])) return false;
    if (!open && digit % 3 == 0 && contact.sticks && !(value[1] >= 0 && (contact.dimensions == 2 || value[2] >= 0)))
      return false;
    const bool begins = !open && contact.sticks && digit % 3 != 0 && contact_digit(touching, j) % 3 == 0;
    if (!open && !begins) continue;
    if (next.empty()) {
      next = later(t, x, mode);
      if (next.empty() || functions_(t + detail::short_time, next.data(), mode, g_.data()) != 0) return false;
      for (const double rate : dx_) known = std::max(known, of_changes * detail::short_time * std::abs(rate));
    }
    if (open) {
      if (motion_.gap_rate(t + detail::short_time, next, j) - motion_.gap_rate(t, x, j) < -known) return false;
      continue;
    }
    const double* const then = g_.data() + contact_values * j;
    const double change = contact.dimensions == 2 ? speed(g_.data(), j) - speed(g.data(), j) : then[0] - value[0];
    if ((digit % 3 == 1 ? change : -change) < -known) return false;
  }
  return true;
}

/// The states that contact j may have, those of `touching` first.
template <class Rhs, class Functions, class Motion>
std::vector<int> Contacts<Rhs, Functions, Motion>::candidates(int touching, std::size_t j) const {
  const Contact& contact = contacts_[j];
  const int digit = contact_digit(touching, j);
  if (contact.unilateral && digit >= 3) return {digit};
  std::vector<int> result{digit};
  const int high = digit - digit % 3;
  if (contact.sticks && digit % 3 == 0) {
    result.push_back(high + 1);
    if (contact.dimensions == 1) result.push_back(high + 2);
  }
  if (contact.unilateral) result.push_back(3);
  const std::size_t count = result.size();
  for (std::size_t k = 0; k < count && contact.surface && !contact.unilateral; ++k)
    result.push_back((result[k] + 3) % 6);
  return result;
}

template <class Rhs, class Functions, class Motion>
int Contacts<Rhs, Functions, Motion>::searched_mode(double t, std::span<double> x, int touching, int mode) {
  std::vector<int> modes{touching};
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    std::vector<int> more;
    for (const int digit : candidates(touching, j))
      for (const int begun : modes) more.push_back(with_contact_digit(begun, j, digit));
    modes = std::move(more);
  }
  const std::vector<double> before(x.begin(), x.end());
  for (const int trial : modes) {
    bool begins = true;
    for (std::size_t j = 0; j < contacts_.size() && begins; ++j) {
      const bool slides = contacts_[j].dimensions == 2 && contacts_[j].sticks && contact_digit(trial, j) % 3 == 1 &&
                          contact_digit(touching, j) % 3 == 0 &&
                          !(contacts_[j].unilateral && contact_digit(trial, j) >= 3);
      if (slides) begins = motion_.slide(t, x, with_contact_digit(trial, j, contact_digit(trial, j) - 1), j) == 0;
    }
    if (begins && is_admissible(t, x, touching, trial)) return trial;
    std::copy(before.begin(), before.end(), x.begin());
  }
  return mode;
}

}  // namespace eom
