// SPDX-License-Identifier: MIT
// The members of EventLocator that search for crossings. In: the samples of a step, the sides of the functions. Out:
// the first crossing of one function, or of all.
#pragma once

#include "eom/events/locator.hpp"

namespace eom {

/// The crossing that the samples show first, by the line between them.
template <class G>
std::optional<EventLocator::Candidate> EventLocator::first_sampled(const StepView& view, G& g) {
  std::size_t best = functions_.size(), best_k = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    if (functions_[i].watch == Watch::off || is_clear_[i] || side_[i] == 0) continue;
    std::size_t k = 1;
    while (k < places.size() && (places[k] <= position_[i] || side_[i] * sample(k, i) >= 0)) ++k;
    if (k == places.size() || !(side_[i] * sample(k, i) < 0)) continue;
    const double left = std::max(position_[i], places[k - 1]);
    const double before = left > places[k - 1] ? 0 : std::max(0.0, side_[i] * sample(k - 1, i));
    const double s = left + (places[k] - left) * before / (before - side_[i] * sample(k, i));
    if (s < least) least = s, best = i, best_k = k;
  }
  if (best == functions_.size()) return std::nullopt;
  const int side = side_[best];
  const double left = std::max(position_[best], places[best_k - 1]);
  const bool is_known = position_[best] == 0 || left > position_[best];
  const double at_left = is_known ? side * sample(best_k - 1, best) : none;
  const auto inward = [&](double s) { return side * value(view, s, best, g); };
  return Candidate{best, root(inward, left, at_left, places[best_k], side * sample(best_k, best)), side};
}

/// The first crossing after the function's position: by samples, or earlier if the function has bounds that do not
/// exclude it. Only crossings before `known` are searched for, with crossing_values_ there.
template <class G>
std::optional<EventLocator::Candidate> EventLocator::crossing(const StepView& view, std::size_t i, G& g,
                                                              const std::optional<Candidate>& known) {
  const std::optional<Candidate> sampled = between_samples(view, i, g, known);
  if constexpr (requires { g.hidden_crossing(view, i, 1, 0.0, 1.0); }) {
    const int side = side_[i];
    if (side == 0) return sampled;
    const auto found = g.hidden_crossing(view, i, side, position_[i], sampled ? sampled->s : known ? known->s : 1.0);
    if (!found) return sampled;
    const auto inward = [&](double s) { return side * value(view, s, i, g); };
    const double at_right = inward(found->second);
    if (!(at_right < 0)) return sampled;
    const double s =
        root(inward, found->first, found->first == position_[i] ? none : inward(found->first), found->second, at_right);
    if (!sampled || s < sampled->s - tolerance) return Candidate{i, s, side};
  }
  return sampled;
}

/// The search ends at a point without a value.
template <class G>
std::optional<EventLocator::Candidate> EventLocator::between_samples(const StepView& view, std::size_t i, G& g,
                                                                     const std::optional<Candidate>& known) {
  const int side = side_[i];
  if (side == 0) return std::nullopt;
  const auto inward = [&](double s) { return side * value(view, s, i, g); };  // positive on the function's side
  double left = position_[i];
  double at_left = left == 0 ? side * sample(0, i) : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double here = side * sample(k, i);
    if (places[k] <= left) continue;
    if (!std::isfinite(here) || (known && left >= known->s)) break;
    if (here < 0 && known && places[k] > known->s) {
      const double there = i == known->function ? 0 : side * crossing_values_[i];
      if (!(there < 0) || !exceeds_rounding(i, there)) break;
      return Candidate{i, root(inward, left, at_left, known->s, there), side};
    }
    if (here < 0) return Candidate{i, root(inward, left, at_left, places[k], here), side};
    if (k + 1 < places.size()) {
      const events::Point b{left, at_left}, c{places[k], here}, d{places[k + 1], side * sample(k + 1, i)};
      double dip = k > 1 && places[k - 2] >= position_[i]
                       ? events::find_dip_of_lines({places[k - 2], side * sample(k - 2, i)}, b, c, d, inward)
                       : none;
      if (!std::isfinite(dip)) dip = events::find_dip(inward, left, at_left, places[k], here, d.s, d.value);
      if (std::isfinite(dip)) return Candidate{i, root(inward, left, at_left, dip, inward(dip)), side};
    }
    left = places[k];
    at_left = here;
  }
  return std::nullopt;
}

/// The first of the other functions that has crossed before the given crossing: it is beyond zero there.
template <class G>
std::optional<EventLocator::Candidate> EventLocator::find_earlier_crossing(const StepView& view, const Candidate& found,
                                                                           G& g) {
  std::optional<Candidate> first;
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    const int side = side_[i];
    const double there = side * crossing_values_[i];
    if (i == found.function || is_clear_[i] || functions_[i].watch == Watch::off || !(there < 0) ||
        !exceeds_rounding(i, there) || position_[i] >= found.s)
      continue;
    double left = position_[i], at_left = left == 0 ? side * sample(0, i) : none;
    for (std::size_t k = 1; k < places.size() && places[k] < found.s; ++k) {
      if (places[k] > left && side * sample(k, i) > 0) left = places[k], at_left = side * sample(k, i);
    }
    const auto inward = [&](double s) { return side * value(view, s, i, g); };
    const double s = root(inward, left, at_left, found.s, there);
    if (s < found.s && (!first || s < first->s)) first = Candidate{i, s, side};
  }
  return first;
}

/// The root between left (on the function's side, or its last crossing) and right (beyond it).
template <class F>
double EventLocator::root(F& inward, double left, double at_left, double right, double at_right) {
  if (!(at_left > 0)) {
    // At the surface up to rounding: takes the first point beyond it that is on the function's side; else the root is
    // here.
    double found = std::numeric_limits<double>::quiet_NaN();
    for (double part = tolerance; part < 1 && !(found > 0); part *= 10) {
      const double s = left + part * (right - left);
      const double v = inward(s);
      if (v > 0) left = s, found = v;
    }
    if (!(found > 0)) return left;
    at_left = found;
  }
  return events::find_root(inward, left, at_left, right, at_right, tolerance);
}

}  // namespace eom
