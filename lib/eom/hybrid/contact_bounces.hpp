// SPDX-License-Identifier: MIT
// The members of ContactModes that end sequences of ever smaller bounces. In: the state at an impact. Out: the state
// at the end of the sequence, or the contacts that close together.
#pragma once

#include "eom/hybrid/contacts.hpp"

namespace eom::hybrid {

/// Computes the deceleration of each gap in `mode`. False if the right-hand side has no value.
inline bool ContactModes::compute_gap_decelerations(double t, std::span<double> x, int mode,
                                                    std::vector<double>& result) {
  k_.resize(x.size()), middle_.resize(x.size());
  if (rhs_(t, x.data(), mode, k_.data()) != 0) return false;
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < x.size(); ++i) middle_[i] = x[i] + h * k_[i];
  const Motion motion{this};
  result.assign(problem_.code->contacts.size(), 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!problem_.code->contacts[i].unilateral) continue;
    result[i] = (motion.gap_rate(t, x, i) - motion.gap_rate(t + h, middle_, i)) / h;
  }
  return true;
}

/// The other contacts that the last bounces of contact j, over after `time`, either open or reach by then (as in a
/// corner).
inline ContactModes::MetContacts ContactModes::contacts_met(double t, std::span<double> x, std::size_t j, double time) {
  MetContacts result;
  const std::vector<Contact>& contacts = problem_.code->contacts;
  int open = mode();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (contacts[i].unilateral) open = with_contact_digit(open, i, 3);
  std::vector<double> fall, after(x.begin(), x.end());
  if (!compute_gap_decelerations(t, x, open, fall) || functions_(t, x.data(), open, g_.data()) != 0 ||
      velocities_.impact(t, after, model_.inputs(t), with_contact_digit(mode(), j, 0), j, restitution_[j]) != 0)
    return result;
  velocities_.clear_impulses();  // that impact was a trial
  const Motion motion{this};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i == j || !contacts[i].unilateral) continue;
    const bool is_closed = contact_digit(mode(), i) < 3;
    const double known = gap_accuracy(t, x, i);
    const double gap = is_closed ? 0 : g_[contact_values * i + 3], away = motion.gap_rate(t, after, i);
    const bool alone = is_closed ? std::abs(away) <= velocities_.negligible_speed()
                                 : gap > known && gap + (away - std::max(fall[i], 0.0) * time / 2) * time > 0;
    if (alone) continue;
    const double speed = std::max(std::abs(motion.gap_rate(t, x, i)), std::abs(away));
    result.over = result.over && fall[i] > 0 && speed * speed / (2 * fall[i]) <= known;
    result.contacts.push_back(i);
  }
  return result;
}

/// If the next bounce is lower than the accuracy of the gap, so are all later ones. They end after the sum of their
/// times, during which the motion continues as it begins, and the contact stays closed. In a corner the other contacts
/// close too once their bounces are as low; until then no bounce is skipped.
inline void ContactModes::end_bounce_sequence(double& t, std::span<double> x, std::size_t j) {
  const Motion motion{this};
  const double e = restitution_[j], up = -e * motion.gap_rate(t, x, j);
  std::vector<double> fall;
  if (!(up > 0) || !compute_gap_decelerations(t, x, mode(), fall)) return;
  if (!(fall[j] > 0) || up * up / (2 * fall[j]) > gap_accuracy(t, x, j)) return;
  const double time = 2 * up / (fall[j] * (1 - e));
  MetContacts met = contacts_met(t, x, j, time);
  if (!met.contacts.empty()) {
    if (!met.over) return;
    met.contacts.push_back(j);
    rule_.close_together(std::move(met.contacts));
    return;
  }
  // One bounce of the total duration: it ends at height 0, so that the projection does no work.
  const double as_one = e / (1 - e);
  if (motion.impact(t, x, with_contact_digit(mode(), j, 0), j, as_one) != 0 ||
      rhs_(t, x.data(), mode(), k_.data()) != 0)
    return;
  const std::size_t n = problem_.code->free.size();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += time * (k_[i] + (i < n ? time / 2 * k_[n + i] : 0));
  t += time;
  rule_.set_restitution(j, 0);
}

}  // namespace eom::hybrid
