// SPDX-License-Identifier: MIT
// The members of SolvedContacts that change velocities and modes. In: the state at an event. Out: velocities after
// impacts, new modes, the events to record with their impulses.
#pragma once

#include "eom/hybrid/solved_contacts.hpp"

namespace eom::hybrid {

inline void SolvedContacts::add_touching(double t, std::span<double> x, std::size_t j,
                                         std::vector<std::size_t>& touching) {
  if (forces_.evaluate_rows(t, x.data(), model_.inputs_without_contacts(t)) != 0) return;
  for (std::size_t i = 0; i < size(); ++i) {
    const contacts::Description& at = forces_.contact(i);
    if (!at.unilateral || forces_.is_closed(i) || std::find(touching.begin(), touching.end(), i) != touching.end())
      continue;
    const double rate = forces_.rate(at.normal), negligible = thresholds_.negligible_speed();
    const bool meets = forces_.value(at.gap) <= thresholds_.gap_rounding(i, x.data()) && rate < negligible;
    if (meets || (rate < -negligible && thresholds_.meets_with(i, j, x.data()))) touching.push_back(i);
  }
  std::sort(touching.begin(), touching.end());
}

inline void SolvedContacts::end_bounces(std::size_t j, std::vector<std::size_t>& touching, std::vector<bool>& plastic) {
  constexpr std::size_t turns = 3;
  constexpr double low = 1e-8;
  chatter_.reset();
  plastic[j] = true;
  for (std::size_t i = 0; i < size(); ++i) {
    const contacts::Description& at = forces_.contact(i);
    if (i == j || !at.unilateral || forces_.is_closed(i) || hits_[i] < turns) continue;
    if (forces_.value(at.gap) > low * thresholds_.sizes().gap[i]) continue;
    plastic[i] = true;
    if (std::find(touching.begin(), touching.end(), i) == touching.end()) touching.push_back(i);
  }
  std::sort(touching.begin(), touching.end());
}

inline bool SolvedContacts::stop_low_bounces(double t, std::span<double> x, std::vector<std::size_t>& touching,
                                             std::vector<bool>& plastic) {
  contacts::ContactForces::Vector qddot;
  if (forces_.evaluate_accelerations(t, x.data(), model_.inputs_without_contacts(t), qddot) != 0) return false;
  bool meets = false, rest = true;
  for (const std::size_t i : touching) {
    const contacts::Description& at = forces_.contact(i);
    // A contact at rest may approach later in a sequence of impacts.
    if (!at.unilateral || !(forces_.rate(at.normal) < -thresholds_.negligible_speed())) continue;
    const double speed = -forces_.rate(at.normal), away = speed * forces_.value(at.restitution);
    const double back = -forces_.acceleration(at.normal, qddot);
    const double known = thresholds_.low_bounce(i, x.data());
    if (away > 0 && back > 0 && away * away / (2 * back) <= known) plastic[i] = true;
    if (away <= thresholds_.negligible_speed()) plastic[i] = true;
    meets = true;
    rest = rest && back > 0 && speed * speed / (2 * back) <= known;
  }
  if (!meets || !rest) return false;
  for (std::size_t i = 0; i < size(); ++i) {
    const contacts::Description& at = forces_.contact(i);
    if (!at.unilateral || std::find(touching.begin(), touching.end(), i) != touching.end()) continue;
    if (forces_.value(at.gap) <= thresholds_.low_bounce(i, x.data())) touching.push_back(i);
  }
  std::sort(touching.begin(), touching.end());
  return true;
}

inline void SolvedContacts::meet(double t, std::span<double> x, const std::vector<std::size_t>& touching,
                                 std::vector<bool> plastic, bool rest, const contacts::Hint& hint,
                                 std::optional<contacts::LaterState> later) {
  plastic.resize(size(), false);
  const std::vector<contacts::ContactState> before = forces_.states();
  const std::vector<double> state(x.begin(), x.end());
  std::vector<std::size_t> hit;
  contacts::Transitions::Result result;
  if (forces_.evaluate_rows(t, x.data(), model_.inputs_without_contacts(t)) == 0 && approaches(touching))
    result = transitions_.impact(t, x.data(), model_.inputs_without_contacts(t), touching, plastic, rest,
                                 thresholds_.tolerances(), hit);
  if (result.outcome == contacts::Transitions::Outcome::done)
    result = transitions_.decide(t, x.data(), model_.inputs_without_contacts(t), touching, hint,
                                 thresholds_.tolerances(), std::move(later));
  model_.forget_contact_forces();
  if (result.outcome != contacts::Transitions::Outcome::done) {
    using Result = contacts::Transitions::Outcome;
    end_ = result.outcome == Result::no_value  ? outcome_of_abi_code(result.code)
           : result.outcome == Result::endless ? Outcome::step_too_small
                                               : Outcome::friction_no_solution;
    end_contact_ = result.contact;
    return;
  }
  double work = 0;
  std::vector<ContactImpulse> of_impact;
  if (!hit.empty()) work = changed_(t, state, x), of_impact = impulses(t, x);
  report(before, hit, work, std::move(of_impact));
}

inline std::optional<contacts::LaterState> SolvedContacts::later_state(double t, std::span<const double> x,
                                                                       std::size_t function) {
  constexpr double clear = 1e-9, far = 1e-3;  // of the forces of the contact
  const std::size_t j = function / values_per_contact, n = problem_.n();
  const contacts::Description& at = forces_.contact(j);
  contacts::ContactForces::Vector qddot;
  if (forces_.evaluate_accelerations(t, x.data(), model_.inputs_without_contacts(t), qddot) != 0) return std::nullopt;
  const double length = std::abs(problem_.t1 - problem_.t0);
  for (double after = 1e-10 * length; after < 1e-3 * length; after *= 10) {
    contacts::LaterState later{t + after, {x.begin(), x.end()}, {}};
    for (std::size_t i = 0; i < n; ++i) {
      later.x[i] += after * x[n + i];
      later.x[n + i] += after * qddot(static_cast<Eigen::Index>(i));
    }
    double* const u = model_.inputs_without_contacts(later.t);
    later.u.assign(u, u + problem_.inputs.size());
    if (forces_.solve(later.t, later.x.data(), u) != 0) return std::nullopt;
    const double value = function % values_per_contact == 1 ? bound_of_friction(j, 0)
                         : at.unilateral                    ? forces_.lambda(j)
                                                            : sign(j) * forces_.lambda(j);
    const double beyond = -value / forces_.force_size(j);
    if (beyond > far) return std::nullopt;
    if (beyond > clear) return later;
  }
  return std::nullopt;
}

inline bool SolvedContacts::approaches(const std::vector<std::size_t>& touching) const {
  return std::any_of(touching.begin(), touching.end(), [&](std::size_t j) {
    const contacts::Description& at = forces_.contact(j);
    return at.unilateral && forces_.rate(at.normal) < -thresholds_.negligible_speed();
  });
}

inline std::vector<ContactImpulse> SolvedContacts::impulses(double t, std::span<const double> x) {
  const std::optional<Eigen::VectorXd> frame = frame_rates(problem_, energy_, t, x);
  std::vector<ContactImpulse> result;
  for (std::size_t j = 0; j < size(); ++j) {
    const contacts::Description& at = forces_.contact(j);
    const contacts::Transitions::Impulse& impulse = transitions_.impulses()[j];
    if (!at.has_constraint()) continue;
    ContactImpulse one{at.name, forces_.value(at.normal_scale) * impulse.lambda, {}, impulse.work};
    if (frame) one.work += impulse.lambda * forces_.change(at.normal, *frame);
    for (std::size_t a = 0; a < at.slip.size(); ++a) {
      one.friction.push_back(impulse.friction[a]);
      if (frame) one.work += impulse.friction[a] * forces_.change(at.slip[a], *frame);
    }
    result.push_back(std::move(one));
  }
  erase_negligible(result);
  return result;
}

inline void SolvedContacts::report(const std::vector<contacts::ContactState>& before,
                                   const std::vector<std::size_t>& hit, double work,
                                   std::vector<ContactImpulse> impulses) {
  using contacts::Mode;
  for (const std::size_t j : hit) {
    ++hits_[j];
    changes_.push_back({"contact", name(j), std::exchange(work, 0.0), std::exchange(impulses, {})});
  }
  for (std::size_t j = 0; j < size(); ++j) {
    const contacts::Description& at = forces_.contact(j);
    const Mode from = before[j].mode, to = forces_.states()[j].mode;
    const bool was_hit = std::find(hit.begin(), hit.end(), j) != hit.end();
    if (from == Mode::open && to != Mode::open && !was_hit) changes_.push_back({"contact", name(j)});
    if (from != Mode::open && to == Mode::open && !was_hit) changes_.push_back({"lose_contact", name(j)});
    if (from == Mode::open || to == Mode::open || !at.sticks || from == to) continue;
    const char* const kind = to == Mode::closed     ? at.rolls ? "roll" : "stick"
                             : from == Mode::closed ? "slip"
                                                    : "reverse";
    changes_.push_back({kind, name(j)});
  }
}

}  // namespace eom::hybrid
