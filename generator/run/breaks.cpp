// SPDX-License-Identifier: GPL-3.0-or-later
// What a run knows beforehand: times at which inputs jump or a kink of time is crossed, what jumps there, and where
// fixed steps have to be shorter.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "run/motion.hpp"

namespace eomgen::run {

std::vector<Integration::Piece> Integration::pieces() const {
  const Scene& scene = request_.scene;
  std::vector<Piece> pieces;
  const std::vector<FinerSteps> finer = finer_steps(scene);
  for (const Signal& signal : scene.inputs) {
    for (const double t : signal.jumps()) {
      if (t > scene.t0 && t < scene.t1) pieces.push_back({t, t, scene.step});
    }
  }
  for (const Break& b : scene.clock.breaks) pieces.push_back({b.before, b.after, scene.step});
  if (scene.step > 0) {
    for (const auto& [begin, end, step] : finer) {
      if (begin > scene.t0) pieces.push_back({begin, begin, scene.step});
      if (end < scene.t1) pieces.push_back({end, end, scene.step});
    }
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.end < b.end; });
  std::size_t kept = 0;
  for (const Piece& piece : pieces) {
    if (piece.next >= scene.t1 || piece.end <= scene.t0) continue;
    if (kept > 0 && piece.end <= pieces[kept - 1].next)
      pieces[kept - 1].next = std::max(pieces[kept - 1].next, piece.next);
    else
      pieces[kept++] = piece;
  }
  pieces.resize(kept);
  pieces.push_back({scene.t1, scene.t1, scene.step});
  if (scene.step > 0) {
    double from = scene.t0;
    for (Piece& piece : pieces) {
      for (const auto& [begin, end, step] : finer) {
        if (from < end && piece.end > begin) piece.step = std::min(piece.step, step);
      }
      from = piece.next;
    }
  }
  return pieces;
}

/// Beyond what lies between two pieces: sides of kinks are counted, and what jumps is told.
void Integration::begin_piece(const Piece& before, eom::Result& total, const OnEvent& event) {
  const int sides = mode_;
  const bool kink = before.next > before.end;
  if (kink && request_.scene.jumps && request_.scene.jumps->by_time()) cross_jump(before, total, event);
  total.t = before.next;
  if (!kink) return;
  hold_sides(total.t, total.x.data(), true);
  for (std::size_t k = 0; k < compiled().kinks.size(); ++k) {
    const std::size_t bit = compiled().first_kink_bit + 2 * k;
    const int was = sides >> bit & 3, is = mode_ >> bit & 3;
    if (was != 0 && is != 0 && was != is) ++kink_crossings[k];
  }
}

void Integration::cross_jump(const Piece& before, eom::Result& total, const OnEvent& event) {
  const auto energy = [&](double t) {
    outputs(t, total.x.data(), y_);
    return y_[energy_];
  };
  const double from = energy(before.end);
  const std::vector<double> u(inputs(before.end), inputs(before.end) + u_.size());
  const std::vector<double> x = total.x;
  const double side = std::exchange(side_, std::nextafter(before.next, request_.scene.t1));
  const Jumps::Told told =
      request_.scene.jumps->cross({before.end, x, u.data()}, before.next, inputs(before.next), total.x);
  jump_ = told.undetermined;
  if (!told.velocities && !told.potential) return;
  const bool touches = contacts_ && compiled().contacts.size() > 0 && any_contact_touches();
  if (jump_.empty() && told.velocities && touches)
    jump_ = fmt::format(
        "the velocity of a support jumps at t = {:.17g} while a contact touches: the equations do not say what the "
        "impulse does there; make it a motion that takes some time",
        before.next);
  total.t = before.next;
  hold_sides(total.t, total.x.data(), true);
  if (jump_.empty() && told.velocities && rows_.size() > 0) {
    const double position = position_correction, velocity = velocity_correction;
    if (project(before.next, total.x.data()) != 0)
      jump_ = fmt::format(
          "the velocity of a support jumps at t = {:.17g}, and no velocities satisfy the constraints after it",
          before.next);
    position_correction = position, velocity_correction = velocity;
    projected_.clear();
  }
  if (!jump_.empty()) {
    side_ = side;
    total.x = x;
    total.t = before.end;
    return;
  }
  const double done = energy(before.next) - from;
  contact_work += done;
  std::string name;
  double largest = 0;
  for (std::size_t i = n_; i < 2 * n_; ++i) largest = std::max(largest, std::abs(total.x[i] - x[i]));
  for (std::size_t i = n_; i < 2 * n_; ++i) {
    if (largest == 0 || std::abs(total.x[i] - x[i]) < 1e-9 * largest) continue;
    if (!name.empty()) name += ", ";
    name += request_.state_names[i];
  }
  if (event)
    event({before.next, "impulse",
           !name.empty()        ? name
           : !told.what.empty() ? told.what
           : told.velocities    ? "constraints"
                                : "potential",
           done},
          total.x);
}

bool Integration::any_contact_touches() const {
  for (std::size_t j = 0; j < compiled().contacts.size(); ++j) {
    if (!compiled().contacts[j].unilateral || eom::contact_digit(mode_ & eom::contact_bits, j) < 3) return true;
  }
  return false;
}

/// Of an event function: where in a step it first leaves its side, though no sample shows it.
std::optional<std::pair<double, double>> Integration::hidden(const eom::StepView& step, std::size_t i, int side,
                                                             double from, double to) const {
  if (!request_.ranges.any() || charts_.second() != 0) return std::nullopt;
  if (i >= first_contact()) {
    const std::size_t j = (i - first_contact()) / eom::contact_values;
    if (j >= compiled().contacts.size() || !compiled().contacts[j].unilateral ||
        eom::contact_digit(mode_ & eom::contact_bits, j) < 3)
      return std::nullopt;
  }
  return request_.ranges.first(step, i, side, from, to, [this](double t) { return inputs(t); });
}

std::vector<FinerSteps> finer_steps(const Scene& scene) {
  std::vector<FinerSteps> result;
  const auto& bounds = scene.clock.bounds;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const double step = bounds[k].step * steps_of_bound, end = k + 1 < bounds.size() ? bounds[k + 1].t : scene.t1;
    if (step < scene.step && end > bounds[k].t) result.push_back({bounds[k].t, end, step});
  }
  return result;
}

}  // namespace eomgen::run
