// SPDX-License-Identifier: MIT
// Members of an ensemble that are integrated side by side, each with its own time, step, error and end. In: a method
// for lanes, members, an observer. Out: the end of each member, bitwise equal to that of the method with drive.hpp. A
// free lane takes the next member. Allocates in the constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/ensemble/lane.hpp"
#include "eom/ensemble/members.hpp"
#include "eom/ensemble/pack.hpp"

namespace eom::ensemble {

/// An observer that does nothing.
struct Unwatched {
  static constexpr bool dense = false;
};

/// Lanes: a method based on LaneRows, with adaptive_method, end_known and order, steps() of a lane at its start,
/// attempt(), interpolate(lane, t, x), and optionally first_step(lane), begin_slopes(), end_slopes(),
/// prepare_accepted(), move(), accept(). Next: (size_t& member) -> bool. Start: (size_t member, EnsembleStart&). Done:
/// (const EnsembleEnd&). Watch: Unwatched, or a type with begin(slot, start, member) -> Outcome, step(slot, StepView)
/// -> bool (false ends the member) and end(slot, EnsembleEnd&, t), which may change the end. A member keeps its slot;
/// there are as many slots as lanes.
template <class Lanes, class Next, class Start, class Done, class Watch = Unwatched>
class Block : Lanes {
  static constexpr bool watched = Watch::dense;

 public:
  template <class Rhs>
  Block(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options, Next& next, Start& start,
        Done& done, Watch& watch)
      : Lanes(rhs, states, parameters, options),
        next_(next),
        start_(start),
        done_(done),
        watch_(watch),
        continues_(stride_),
        view_x0_(watched ? states : 0),
        view_x1_(watched ? states : 0) {
    slot_.reserve(lanes_);
    for (std::size_t slot = lanes_; slot-- > 0;) free_.push_back(slot);
  }

  void run() {
    refill();
    while (!lane_.empty()) {
      if (options_.interrupt != nullptr && options_.interrupt->load(std::memory_order_relaxed)) return interrupt();
      plan();
      this->attempt();
      decide();
      refill();
    }
  }

 private:
  using Lanes::accepted_;
  using Lanes::adaptive_method;
  using Lanes::carry_;
  using Lanes::codes_;
  using Lanes::end_known;
  using Lanes::error_;
  using Lanes::evaluate;
  using Lanes::f0_;
  using Lanes::failed_;
  using Lanes::h_;
  using Lanes::lane_;
  using Lanes::lanes_;
  using Lanes::n_;
  using Lanes::n_error_;
  using Lanes::one_p_;
  using Lanes::one_x_;
  using Lanes::options_;
  using Lanes::p_;
  using Lanes::p_count_;
  using Lanes::scratch_;
  using Lanes::size_;
  using Lanes::slope_;
  using Lanes::stage_;
  using Lanes::state_;
  using Lanes::stride_;
  using Lanes::t_;
  using Lanes::x0_;
  using Lanes::x1_;

  bool adaptive() const { return adaptive_method && options_.fixed_step <= 0; }

  /// The first lanes are active. A new member is appended, and the last lane replaces one that has ended.
  void refill() {
    for (bool more = true; more && lane_.size() < lanes_;) {
      const std::size_t first = lane_.size();
      std::size_t member = 0;
      while (lane_.size() < lanes_ && (more = next_(member))) enter(member);
      if (lane_.size() > first) begin(first);
    }
  }
  void enter(std::size_t member) {
    const std::size_t l = lane_.size();
    EnsembleStart start{0, 0, {one_x_, n_}, {one_p_, p_count_}};
    start_(member, start);
    lane_.emplace_back(member, start.t0, start.t1, this->steps());
    for (std::size_t i = 0; i < n_; ++i) x0_[i * stride_ + l] = one_x_[i], carry_[i * stride_ + l] = 0;
    for (std::size_t i = 0; i < p_count_; ++i) p_[i * stride_ + l] = one_p_[i];
    if constexpr (watched) {
      slot_.push_back(free_.back());
      free_.pop_back();
      lane_[l].end(watch_.begin(slot_[l], member, start));
    }
  }

  void finish(std::size_t l) {
    for (std::size_t i = 0; i < n_; ++i) one_x_[i] = x0_[i * stride_ + l];
    for (std::size_t i = 0; i < p_count_; ++i) one_p_[i] = p_[i * stride_ + l];
    EnsembleEnd end{lane_[l].member(), lane_[l].outcome(), lane_[l].t(),
                    {one_x_, n_},      {one_p_, p_count_}, lane_[l].statistics()};
    if constexpr (watched) watch_.end(slot_[l], end, std::span<double>(one_x_, n_));
    done_(end);
  }
  void leave(std::size_t l) {
    finish(l);
    const std::size_t last = lane_.size() - 1;
    if constexpr (watched) {
      free_.push_back(slot_[l]);
      slot_[l] = slot_[last];
      slot_.pop_back();
    }
    lane_[l] = lane_[last];
    lane_.pop_back();
    if (l != last) this->move(l, last);
  }
  void interrupt() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      lane_[l].end(Outcome::interrupted);
      finish(l);
    }
    lane_.clear();
  }

  bool finite(const double* rows, std::size_t l) const {
    for (std::size_t i = 0; i < n_; ++i) {
      if (!std::isfinite(rows[i * stride_ + l])) return false;
    }
    return true;
  }

  /// Derivative and step size of the lanes from `first` on, as in Run::start and Run::initial_step (HNW I, section
  /// II.4).
  void begin(std::size_t first) {
    const std::size_t count = lane_.size() - first;
    for (std::size_t l = first; l < lane_.size(); ++l) t_[l] = lane_[l].t();
    this->begin_slopes(first, count);
    for (std::size_t l = first; l < lane_.size(); ++l) {
      failed_[l] = 0;
      if (lane_[l].at_end() || lane_[l].outcome() != Outcome::done) {  // start and end coincide: nothing was evaluated
        lane_[l].count(static_cast<std::size_t>(-1));
        failed_[l] = 1;
      } else if (codes_[l] != 0) {
        failed_[l] = 1;
        lane_[l].end(outcome_of_abi_code(codes_[l]));
      } else if (!finite(x0_, l) || !finite(f0_, l)) {
        failed_[l] = 1;
        lane_[l].end(Outcome::not_finite);
      } else if (!adaptive()) {
        failed_[l] = lane_[l].plan_fixed_steps(options_) ? 0 : 1;
      } else if (options_.initial_step > 0) {
        lane_[l].start_with(options_.initial_step, options_);
      } else if constexpr (requires { this->first_step(l); }) {
        lane_[l].start_with(this->first_step(l), options_);
      }
    }
    if constexpr (!requires { this->first_step(first); }) {
      if (adaptive() && !(options_.initial_step > 0)) first_steps(first, count);
    }
    for (std::size_t l = lane_.size(); l-- > first;) {
      if (failed_[l] != 0) leave(l);
    }
  }

  void first_steps(std::size_t first, std::size_t count) {
    for (std::size_t l = first; l < first + count; ++l) {
      const double size_x = norm(l, x0_), size_f = norm(l, f0_);
      double h0 = size_x < 1e-5 || size_f < 1e-5 ? 1e-6 : 0.01 * size_x / size_f;
      h0 = std::min(h0, lane_[l].longest_step(options_));
      h_[l] = h0;
      t_[l] = lane_[l].t() + lane_[l].direction() * h0;
      for (std::size_t i = 0; i < n_; ++i)
        x1_[i * stride_ + l] = x0_[i * stride_ + l] + lane_[l].direction() * h0 * f0_[i * stride_ + l];
    }
    evaluate(first, count, t_, x1_, stage_);
    for (std::size_t l = first; l < first + count; ++l) {
      if (failed_[l] != 0) {
        lane_[l].count(static_cast<std::size_t>(-1));
        continue;
      }
      lane_[l].start_with(codes_[l] != 0 || !finite(stage_, l) ? 0.01 * h_[l] : euler_step(l), options_);
    }
  }
  double euler_step(std::size_t l) {
    const double size_f = norm(l, f0_);
    for (std::size_t i = 0; i < n_; ++i) scratch_[i * stride_ + l] = stage_[i * stride_ + l] - f0_[i * stride_ + l];
    const double size_change = norm(l, scratch_) / h_[l];
    const double largest = std::max(size_f, size_change);
    const double h1 = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h_[l]) : std::pow(0.01 / largest, 1.0 / Lanes::order);
    return std::min(100 * h_[l], h1);
  }
  double norm(std::size_t l, const double* rows) const {
    double sum = 0;
    for (std::size_t i = 0; i < n_error_; ++i) {
      const double scale = options_.atol + options_.rtol * std::abs(x0_[i * stride_ + l]);
      if (scale == 0) continue;
      const double value = rows[i * stride_ + l] / scale;
      sum += value * value;
    }
    return std::sqrt(sum / static_cast<double>(n_error_));
  }

  void plan() {
    for (std::size_t l = lane_.size(); l-- > 0;) {
      if (!lane_[l].has_steps_left(options_)) leave(l);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      t_[l] = lane_[l].next_time(options_);
      h_[l] = t_[l] - lane_[l].t();
      failed_[l] = 0;
    }
  }

  void decide() {
    if constexpr (!end_known) this->end_slopes();
    this->examine();
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const double error = adaptive() ? error_[l] : 0;
      const int code = failed_[l] != 0 ? failed_[l] : !std::isfinite(error) || state_[l] != 0 ? code_not_finite : 0;
      accepted_[l] = 0;
      if (code != 0)
        continues_[l] = lane_[l].retry(code);
      else if (error > 1)
        continues_[l] = lane_[l].reject(h_[l], error);
      else
        complete(l);
    }
    this->prepare_accepted();
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (accepted_[l] != 0) continues_[l] = accept(l, adaptive() ? error_[l] : 0);
    }
    Lanes::accept();
    for (std::size_t l = lane_.size(); l-- > 0;) {
      if (!continues_[l]) leave(l);
    }
  }
  void complete(std::size_t l) {
    int code = 0;
    if constexpr (!end_known) {
      lane_[l].count(1);
      code = codes_[l];
    }
    if (code == 0 && slope_[l] != 0) code = code_not_finite;
    if (code != 0)
      continues_[l] = lane_[l].retry(code);
    else
      accepted_[l] = 1;
  }
  bool accept(std::size_t l, double error) {
    bool wanted = true;
    if constexpr (watched) wanted = observe_step(l);
    const bool continues = lane_[l].accept(t_[l], error, options_);
    if (!wanted) return lane_[l].end(Outcome::stopped_by_event);
    return size_[l] > divergence_bound ? lane_[l].end(Outcome::diverged) : continues;
  }

  struct LaneView {
    const Lanes* lanes;
    std::size_t lane;
    static void interpolate(const void* view, double t, double* x) {
      const auto* const of = static_cast<const LaneView*>(view);
      of->lanes->interpolate(of->lane, t, x);
    }
  };
  bool observe_step(std::size_t l) {
    for (std::size_t i = 0; i < n_; ++i) {
      view_x0_[i] = x0_[i * stride_ + l];
      view_x1_[i] = x1_[i * stride_ + l];
    }
    const LaneView of{this, l};
    return watch_.step(slot_[l], StepView{lane_[l].t(), t_[l], view_x0_, view_x1_, &of, &LaneView::interpolate});
  }

  Next& next_;
  Start& start_;
  Done& done_;
  Watch& watch_;
  std::vector<char> continues_;
  std::vector<std::size_t> slot_, free_;   // of observed members: slots of the lanes; free slots
  std::vector<double> view_x0_, view_x1_;  // of an observed step
};

}  // namespace eom::ensemble
