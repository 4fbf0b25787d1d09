// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/contact_modes.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {
namespace {

constexpr double known_gap = 3e-14;       // of the largest: rounding of what it is made of
constexpr double most_restitution = 0.9;  // beyond it bounces go on for long

}  // namespace

ContactModes::ContactModes(const RunRequest& request, ConstraintRows& rows, std::size_t states, Inputs inputs,
                           Function rhs, Function functions,
                           std::function<void(double, std::span<const double>, std::span<const double>)> changed)
    : request_(request),
      rows_(rows),
      velocities_(request, rows),
      inputs_(std::move(inputs)),
      changed_(std::move(changed)),
      rhs_(std::move(rhs)),
      functions_(std::move(functions)),
      rule_(request.code.contacts, states, rhs_, functions_, Motion{this}),
      g_(rule_.functions()) {
  for (const eom::Contact& contact : request.code.contacts)
    two_directions_ = two_directions_ || contact.dimensions == 2;
}

int ContactModes::Motion::impact(double t, std::span<double> x, int mode, std::size_t j, double e) const {
  const std::vector<double> before(x.begin(), x.end());
  const int code = self->velocities_.impact(t, x, self->inputs_(t), mode, j, e);
  if (code == 0) self->changed_(t, before, x);
  return code;
}
int ContactModes::Motion::close(double t, std::span<double> x, int mode) const {
  const std::vector<double> before(x.begin(), x.end());
  const int code = self->velocities_.close(t, x, self->inputs_(t), mode);
  if (code == 0) self->changed_(t, before, x);
  return code;
}
int ContactModes::Motion::stick(double t, std::span<double> x, int mode, std::size_t j) const {
  const std::vector<double> before(x.begin(), x.end());
  const int code = self->velocities_.stick(t, x, self->inputs_(t), mode, j);
  if (code == 0) self->changed_(t, before, x);
  return code;
}
int ContactModes::Motion::slide(double t, std::span<double> x, int mode, std::size_t j) const {
  const std::vector<double> before(x.begin(), x.end());
  const int code = self->velocities_.slide(t, x, self->inputs_(t), mode, j);
  if (code == 0) self->changed_(t, before, x);
  return code;
}
double ContactModes::Motion::approach(double t, std::span<const double> x, std::size_t j) const {
  return self->velocities_.approach(t, x, self->inputs_(t), j);
}

std::vector<eom::ModeEvent> ContactModes::start(double t, std::span<double> x) {
  const std::vector<eom::Contact>& contacts = request_.code.contacts;
  std::vector<double> g(rule_.functions());
  velocities_.forget();
  largest_gap_ = 0;
  restitution_.assign(contacts.size(), 0.0);
  if (two_directions_) velocities_.hold(t, x.data(), inputs_(t), 0);  // how much slip counts, before any is given
  std::vector<double> slip(contacts.size(), 0.0);
  std::array<bool, eom::max_contacts> apart{};
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    apart[j] = request_.scene.apart[j];
    restitution_[j] = velocities_.restitution(t, x.data(), inputs_(t), j);
    rule_.restitution(j, restitution_[j]);
  }
  if (functions_(t, x.data(), 0, g.data()) == 0) {
    for (std::size_t j = 0; j < contacts.size(); ++j) {
      const double* const value = g.data() + eom::contact_values * j;
      slip[j] = contacts[j].dimensions == 2 ? std::hypot(value[0], value[2]) : std::abs(value[0]);
    }
    adjust(g.data());
  }
  const int mode = rule_.start(t, x, std::span<const bool>(apart.data(), contacts.size()));
  rows_.mode(mode);
  switch_.emplace(rule_.table(), rule_, mode);
  hold(t, x.data());
  std::vector<eom::ModeEvent> told;
  for (std::size_t j = 0; j < contacts.size(); ++j) {
    const int digit = eom::contact_digit(mode, j);
    const bool touches = !contacts[j].unilateral || digit < 3;
    if (contacts[j].sticks && touches && digit % 3 != 0 && slip[j] <= velocities_.still())
      told.push_back({t, "slip", contacts[j].name, 0, mode});
    if (!touches && !apart[j]) told.push_back({t, "lose_contact", contacts[j].name, 0, mode});
  }
  return told;
}

void ContactModes::hold(double t, const double* x) {
  if (two_directions_) velocities_.hold(t, x, inputs_(t), mode());
}

bool ContactModes::slow_slip(double t, const double* x, double h, bool now) {
  const double steps = now ? 8 : 4;
  bool slow = false, moved = false;
  for (std::size_t j = 0; j < request_.code.contacts.size() && !slow; ++j) {
    const eom::Contact& contact = request_.code.contacts[j];
    if (contact.dimensions != 2 || !contact.sticks || eom::contact_digit(mode(), j) % 3 == 0 ||
        (contact.unilateral && eom::contact_digit(mode(), j) >= 3))
      continue;
    if (!moved) {
      k_.resize(request_.code.free.size() * 2 + request_.code.integrals + (request_.watch_power ? 1 : 0));
      if (rhs_(t, x, mode(), k_.data()) != 0) return now;
      middle_.resize(k_.size());
      for (std::size_t i = 0; i < k_.size(); ++i) middle_[i] = x[i] + h * k_[i];
      moved = true;
    }
    const std::array<double, 2> here = velocities_.slip(t, x, inputs_(t), mode(), j);
    const std::array<double, 2> there = velocities_.slip(t + h, middle_.data(), inputs_(t + h), mode(), j);
    slow = std::hypot(here[0], here[1]) < steps * std::hypot(there[0] - here[0], there[1] - here[1]);
  }
  return slow;
}

/// Where the slip of contact j vanishes, by the midpoint rule over the short time that is left: the slip along its
/// direction is all but linear there.
int ContactModes::Motion::stop(double& t, std::span<double> x, int mode, std::size_t j) const {
  const auto slip = [&](double at, const double* state) {
    return self->velocities_.slip(at, state, self->inputs_(at), mode, j);
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
  // The rate of the slip from a step in which it changes by a small part of itself.
  double h = 1e-6, rate = (moved(h) - speed) / h;
  if (rate < 0) h = -speed / rate / 8, rate = (moved(h) - speed) / h;
  if (!(rate < 0)) return eom::slips_on;
  h = -speed / rate;
  for (std::size_t i = 0; i < x.size(); ++i) middle[i] = x[i] + h / 2 * k[i];
  if (const int code = self->rhs_(t + h / 2, middle.data(), mode, k.data()); code != 0) return code;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += h * k[i];
  t += h;
  return 0;
}

void ContactModes::adjust(double* g) {
  for (std::size_t j = 0; j < request_.code.contacts.size(); ++j) {
    const double* const value = g + eom::contact_values * j;
    const double slip = request_.code.contacts[j].dimensions == 2 ? std::hypot(value[0], value[2]) : std::abs(value[0]);
    if (request_.code.contacts[j].dimensions > 0 && std::isfinite(slip)) velocities_.see_slip(slip);
    if (request_.code.contacts[j].unilateral && eom::contact_digit(mode(), j) >= 3 && std::isfinite(value[3]))
      largest_gap_ = std::max(largest_gap_, std::abs(value[3]));
  }
  rule_.shift(g);
}

/// Where the bounce that follows is lower than the gap is known, so are all after it: they are over after the sum of
/// their times, in which the motion goes on as it begins, and the contact stays.
void ContactModes::end_bounces(double& t, std::span<double> x, std::size_t j) {
  const Motion motion{this};
  const double e = restitution_[j], up = -e * motion.approach(t, x, j);
  k_.resize(x.size()), middle_.resize(x.size());
  if (!(up > 0) || rhs_(t, x.data(), mode(), k_.data()) != 0) return;
  const double h = 1e-6;
  for (std::size_t i = 0; i < x.size(); ++i) middle_[i] = x[i] + h * k_[i];
  const double falls = (motion.approach(t, x, j) - motion.approach(t + h, middle_, j)) / h;
  if (!(falls > 0) || up * up / (2 * falls) > known_gap * largest_gap_) return;
  if (motion.impact(t, x, eom::with_contact_digit(mode(), j, 0), j, e) != 0 ||
      rhs_(t, x.data(), mode(), k_.data()) != 0)
    return;
  const double time = 2 * up / (falls * (1 - e));
  const std::size_t n = request_.code.free.size();
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += time * (k_[i] + (i < n ? time / 2 * k_[n + i] : 0));
  t += time;
  rule_.restitution(j, 0);
}

eom::AtEvent ContactModes::take(double& t, std::span<double> x, const eom::Crossing& crossing,
                                std::span<eom::EventFunction> functions) {
  const std::size_t before = switch_->events.size();
  const std::size_t j = crossing.function / eom::contact_values;
  const bool hits = crossing.function % eom::contact_values == 3 && request_.code.contacts[j].unilateral &&
                    eom::contact_digit(mode(), j) >= 3;
  const double e = hits ? restitution_[j] : 0;
  if (e > 0 && e < most_restitution) end_bounces(t, x, j);
  const eom::AtEvent answer = switch_->take(t, x, crossing, functions);
  if (e > 0) rule_.restitution(j, e);
  rows_.mode(switch_->mode);
  if (answer == eom::AtEvent::restart) hold(t, x.data());
  told_.reset();
  if (switch_->events.size() > before) told_ = switch_->events.back();
  return answer;
}

std::optional<eom::Outcome> ContactModes::ended() const {
  if (!switch_ || switch_->ended == eom::Outcome::done) return std::nullopt;
  return switch_->ended;
}

}  // namespace eomgen::run
