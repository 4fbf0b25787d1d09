// SPDX-License-Identifier: MIT
// Changes of the state by the model itself: resets at events, samples at given times. In: events that occurred, the
// times of a boundary between two segments. Out: the state after all changes, recorded events, or a reason if a change
// has no valid result.
//
// All values of one reset are those before it. Events that occur at the same time are handled in declared order. A
// reset that moves another event function across zero makes that event occur too, at the same time.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eom/hybrid/run_context.hpp"
#include "eom/hybrid/samples.hpp"

namespace eom::hybrid {

/// Changes of the state at events and samples of the model.
class Resets {
 public:
  /// The context must outlive this object.
  explicit Resets(RunContext& context) : context_(context), problem_(context.problem), r_(problem_.code->reset_values) {
    const auto changes = [](const WatchedEvent& event) { return !event.reset.set.empty(); };
    has_events_ = std::any_of(problem_.events.begin(), problem_.events.end(), changes);
    start();
  }

  /// Whether an event or a sample changes the state.
  bool any() const { return has_events_ || !problem_.samples.empty(); }
  /// Begins a run: no sample has been taken.
  void start() { taken_.assign(problem_.samples.size(), none_taken); }

  /// The last sample of each kind that was taken.
  const std::vector<std::int64_t>& taken() const { return taken_; }
  /// Restores the last samples.
  void set_taken(const std::vector<std::int64_t>& taken) { taken_ = taken; }

  /// Whether event i occurs at (t, x): it has no condition, or its condition holds.
  bool occurs(std::size_t i, double t, const double* x) {
    const std::optional<std::size_t>& condition = problem_.events[i].reset.condition;
    return !condition || (context_.model.resets(t, x, r_.data()) == 0 && r_[*condition] > 0.5);
  }

  /// Values of the event functions of the model.
  std::vector<double> event_values(double t, const double* x) {
    std::vector<double> g(context_.events.size());
    if (problem_.events.empty() || context_.events(t, x, g.data()) != 0)
      std::fill(g.begin(), g.end(), std::numeric_limits<double>::quiet_NaN());
    g.resize(problem_.events.size());
    return g;
  }

  /// Takes the samples that belong to the boundary between two segments, `until` being the start of the next one.
  Reason take_samples(double from, double until, std::span<double> x, const OnEvent& event) {
    for (std::size_t i = 0; i < problem_.samples.size(); ++i) {
      const std::optional<std::int64_t> k = sample_between(problem_.samples[i], from, until);
      if (!k || *k <= taken_[i]) continue;
      taken_[i] = *k;
      if (const Reason failed = take_sample(i, *k, until, x, event)) return failed;
    }
    return {};
  }

  /// Takes sample k of kind i at the time t, whether or not it belongs there.
  Reason take_sample(std::size_t i, std::int64_t k, double t, std::span<double> x, const OnEvent& event) {
    const Sample& sample = problem_.samples[i];
    bool made = false;
    if (const Reason failed = change(t, x, sample.reset, sample.noise, k, sample.name, made)) return failed;
    if (made && event) event({t, "sample", sample.name}, x);
    return {};
  }

  /// Result of occur().
  struct Changes {
    bool changed = false, stopped = false;
    Reason failed;
  };
  /// Handles events that occurred at (t, x), and those that their resets cause. sides: of the event functions just
  /// before, 0: unknown; those of the events that occurred are behind their crossing.
  Changes occur(std::vector<std::size_t> occurred, std::vector<int> sides, double t, std::span<double> x,
                const OnEvent& event) {
    Changes result;
    std::string chain;
    for (std::size_t count = 0; !occurred.empty(); ++count) {
      const auto first = std::min_element(occurred.begin(), occurred.end());
      const std::size_t i = *first;
      occurred.erase(first);
      if (!occurs(i, t, x.data())) continue;
      const WatchedEvent& watched = problem_.events[i];
      if (count + shown_events >= longest_chain) chain += (chain.empty() ? "" : ", ") + watched.name;
      if (count >= longest_chain) {
        result.failed = {Reason::Kind::event_chain, t, 0, chain};
        return result;
      }
      result.stopped = result.stopped || watched.stop;
      if (watched.reset.set.empty()) {
        if (event) event({t, watched.stop ? "stop" : "custom", watched.name}, x);
        continue;
      }
      if (event) event({t, "before_reset", watched.name}, x);
      const double energy = context_.outputs.energy(t, x.data());
      bool made = false;
      result.failed = change(t, x, watched.reset, {}, 0, watched.name, made);
      if (result.failed) return result;
      result.changed = true;
      if (event) {
        event({t, "reset", watched.name, context_.outputs.energy(t, x.data()) - energy}, x);
        if (watched.stop) event({t, "stop", watched.name}, x);
      }
      for (const std::size_t j : crossed(sides, event_values(t, x.data()))) {
        if (j != i && std::find(occurred.begin(), occurred.end(), j) == occurred.end()) occurred.push_back(j);
      }
    }
    return result;
  }

  /// Events whose functions are on another side than before, in their direction. Updates the sides.
  std::vector<std::size_t> crossed(std::vector<int>& sides, const std::vector<double>& values) const {
    std::vector<std::size_t> found;
    for (std::size_t j = 0; j < sides.size(); ++j) {
      const int side = values[j] > 0 ? 1 : values[j] < 0 ? -1 : 0;
      if (side == 0) continue;
      const Direction direction = problem_.events[j].direction;
      const bool wanted = direction == Direction::any || (direction == Direction::up) == (side > 0);
      if (sides[j] == -side && wanted) found.push_back(j);
      sides[j] = side;
    }
    return found;
  }

 private:
  static constexpr std::size_t longest_chain = 100, shown_events = 4;
  static constexpr double position_tolerance = 1e-8;  // relative to the largest coordinate

  /// Makes one reset, unless its condition does not hold.
  Reason change(double t, std::span<double> x, const Reset& reset, std::span<const Noise> noise, std::int64_t k,
                const std::string& name, bool& made) {
    const double energy = context_.outputs.energy(t, x.data());
    for (const Noise& drawn : noise) x[drawn.component] = random_number(drawn, k);
    made = !noise.empty();
    if (!reset.set.empty()) {
      if (context_.model.resets(t, x.data(), r_.data()) != 0) return {Reason::Kind::reset_without_value, t, 0, name};
      if (!reset.condition || r_[*reset.condition] > 0.5) {
        made = true;
        const std::size_t others = problem_.code->layout().first_order_begin();
        bool moves = false, displaces = false;
        for (const Reset::Entry& entry : reset.set) {
          if (!std::isfinite(r_[entry.value])) return {Reason::Kind::reset_without_value, t, 0, name};
          moves = moves || (entry.component < others && x[entry.component] != r_[entry.value]);
          displaces = displaces || entry.component < problem_.n();
          x[entry.component] = r_[entry.value];
        }
        if (moves) {
          if (const Reason failed = make_consistent(t, x, name, displaces)) return failed;
        }
        if (context_.has_contacts() && (moves || displaces)) restart_contacts(t, x);
      }
    }
    if (!made) return {};
    context_.freeze_branches(t, x.data(), true);
    context_.impulse_work += context_.outputs.energy(t, x.data()) - energy;
    return {};
  }

  /// Adds the impulses of the constraints, which M determines, to the new velocities. New coordinates must satisfy the
  /// constraints.
  Reason make_consistent(double t, std::span<double> x, const std::string& name, bool displaces) {
    if (context_.rows.size() == 0) return {};
    if (displaces) context_.rows.start(t, x.data(), context_.model.inputs(t));
    const StateProjection::Corrections before = context_.projection.largest();
    context_.projection.restore_corrections({});
    const int code = context_.projection(t, x.data());
    const double moved = context_.projection.largest().position;
    context_.projection.restore_corrections(before);
    double size = 1;
    for (std::size_t i = 0; i < problem_.n(); ++i) size = std::max(size, std::abs(x[i]));
    if (code != 0 || (displaces && moved > position_tolerance * size))
      return {Reason::Kind::reset_off_constraints, t, moved, name};
    return {};
  }

  void restart_contacts(double t, std::span<double> x) {
    const double work = context_.impulse_work;
    context_.start_contacts(t, x);
    context_.impulse_work = work;
  }

  RunContext& context_;
  const Problem& problem_;
  bool has_events_ = false;
  std::vector<std::int64_t> taken_;
  std::vector<double> r_;
};

}  // namespace eom::hybrid
