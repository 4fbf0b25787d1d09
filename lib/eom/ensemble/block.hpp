// SPDX-License-Identifier: MIT
// Some members of an ensemble side by side, each with its own time, step, error and end, by an explicit Runge-Kutta
// method. In: a tableau, derivatives of many states, members. Out: the end of each, with the bits that
// explicit_rk/step.hpp and drive.hpp give it alone. A lane whose member has ended gets the next one. Allocates in the
// constructor only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "eom/ensemble/lane.hpp"
#include "eom/ensemble/members.hpp"
#include "eom/ensemble/pack.hpp"
#include "eom/explicit_rk/tableau.hpp"

namespace eom::ensemble {

/// T: a tableau. Rhs: as EnsembleRhs. Next: (size_t& member) -> bool. Start: (size_t member, EnsembleStart&). Done:
/// (const EnsembleEnd&).
template <class T, class Rhs, class Next, class Start, class Done, std::size_t width = pack_width>
class Block {
 public:
  Block(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options, Next& next, Start& start,
        Done& done)
      : rhs_(rhs),
        next_(next),
        start_(start),
        done_(done),
        options_(options),
        n_(states),
        n_error_(states - options.quadratures),
        p_count_(parameters),
        lanes_((std::max<std::size_t>(options.lanes, 1) + width - 1) / width * width),
        stride_(lanes_ % 64 == 0 ? lanes_ + 8 : lanes_),  // rows a power of two apart displace one another in the cache
        work_((stages + 6) * n_ * stride_ + p_count_ * stride_ + 8 * stride_ + n_ + p_count_),
        codes_(stride_),
        failed_(stride_),
        goes_on_(stride_) {
    double* at = work_.data();
    const auto take = [&](std::size_t rows) { return std::exchange(at, at + rows * stride_); };
    k_ = take(stages * n_);
    x0_ = take(n_);
    x1_ = take(n_);
    stage_ = take(n_);
    carry_ = take(n_);
    new_carry_ = take(n_);
    scratch_ = take(n_);
    p_ = take(p_count_);
    t_ = take(1);
    h_ = take(1);
    stage_t_ = take(1);
    error_ = take(1);
    state_ = take(1);
    slope_ = take(1);
    size_ = take(1);
    accepted_ = take(1);
    one_x_ = at;
    one_p_ = at + n_;
    lane_.reserve(lanes_);
  }

  void run() {
    refill();
    while (!lane_.empty()) {
      if (options_.interrupt != nullptr && options_.interrupt->load(std::memory_order_relaxed)) return interrupt();
      plan();
      attempt();
      decide();
      refill();
    }
  }

 private:
  static constexpr std::size_t stages = T::stages + 1;  // with the derivative at the end
  static constexpr bool adaptive_method = !T::error.empty();
  static constexpr bool end_known = explicit_rk::error_uses_end<T>();
  bool adaptive() const { return adaptive_method && options_.fixed_step <= 0; }
  std::size_t padded() const { return (lane_.size() + width - 1) / width * width; }

  /// The first lanes are the ones under way: a new member comes behind them, and the last one takes the place of one
  /// that has ended.
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
    lane_.emplace_back(member, start.t0, start.t1, T::control, T::order);
    for (std::size_t i = 0; i < n_; ++i) x0_[i * stride_ + l] = one_x_[i], carry_[i * stride_ + l] = 0;
    for (std::size_t i = 0; i < p_count_; ++i) p_[i * stride_ + l] = one_p_[i];
  }

  void finish(std::size_t l) {
    for (std::size_t i = 0; i < n_; ++i) one_x_[i] = x0_[i * stride_ + l];
    for (std::size_t i = 0; i < p_count_; ++i) one_p_[i] = p_[i * stride_ + l];
    done_(EnsembleEnd{
        lane_[l].member(), lane_[l].outcome(), lane_[l].t(), {one_x_, n_}, {one_p_, p_count_}, lane_[l].statistics()});
  }
  void leave(std::size_t l) {
    finish(l);
    const std::size_t last = lane_.size() - 1;
    lane_[l] = lane_[last];
    lane_.pop_back();
    if (l == last) return;
    const auto move = [&](double* rows, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) rows[i * stride_ + l] = rows[i * stride_ + last];
    };
    move(k_, n_);
    move(x0_, n_);
    move(carry_, n_);
    move(p_, p_count_);
  }
  void interrupt() {
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      lane_[l].end(Outcome::interrupted);
      finish(l);
    }
    lane_.clear();
  }

  /// Derivatives of lanes from `first` on.
  int evaluate(std::size_t first, std::size_t count, const double* t, const double* x, double* dx) {
    for (std::size_t l = first; l < first + count; ++l) lane_[l].count(1);
    return rhs_(count, stride_, t + first, x + first, p_ + first, dx + first, codes_.data() + first);
  }

  bool finite(const double* rows, std::size_t l) const {
    for (std::size_t i = 0; i < n_; ++i) {
      if (!std::isfinite(rows[i * stride_ + l])) return false;
    }
    return true;
  }

  /// Derivative and step size of the lanes from `first` on: Run::start and Run::initial_step (HNW I, section II.4).
  void begin(std::size_t first) {
    const std::size_t count = lane_.size() - first;
    for (std::size_t l = first; l < lane_.size(); ++l) t_[l] = lane_[l].t();
    evaluate(first, count, t_, x0_, k_);
    for (std::size_t l = first; l < lane_.size(); ++l) {
      failed_[l] = 0;
      if (lane_[l].at_end()) {  // nothing is to be done: nothing was evaluated
        lane_[l].count(static_cast<std::size_t>(-1));
        failed_[l] = 1;
      } else if (codes_[l] != 0) {
        failed_[l] = 1;
        lane_[l].end(outcome_of_abi_code(codes_[l]));
      } else if (!finite(x0_, l) || !finite(k_, l)) {
        failed_[l] = 1;
        lane_[l].end(Outcome::not_finite);
      } else if (!adaptive()) {
        failed_[l] = lane_[l].plan_fixed_steps(options_) ? 0 : 1;
      } else if (options_.initial_step > 0) {
        lane_[l].start_with(options_.initial_step, options_);
      }
    }
    if (adaptive() && !(options_.initial_step > 0)) first_steps(first, count);
    for (std::size_t l = lane_.size(); l-- > first;) {
      if (failed_[l] != 0) leave(l);
    }
  }

  void first_steps(std::size_t first, std::size_t count) {
    for (std::size_t l = first; l < first + count; ++l) {
      const double size_x = norm(l, x0_), size_f = norm(l, k_);
      double h0 = size_x < 1e-5 || size_f < 1e-5 ? 1e-6 : 0.01 * size_x / size_f;
      h0 = std::min(h0, lane_[l].longest_step(options_));
      h_[l] = h0;
      t_[l] = lane_[l].t() + lane_[l].direction() * h0;
      for (std::size_t i = 0; i < n_; ++i)
        x1_[i * stride_ + l] = x0_[i * stride_ + l] + lane_[l].direction() * h0 * k_[i * stride_ + l];
    }
    evaluate(first, count, t_, x1_, stage_);
    for (std::size_t l = first; l < first + count; ++l) {
      if (failed_[l] != 0) {
        lane_[l].count(static_cast<std::size_t>(-1));
        continue;
      }
      lane_[l].start_with(codes_[l] != 0 || !finite(stage_, l) ? 0.01 * h_[l] : first_step(l), options_);
    }
  }
  double first_step(std::size_t l) {
    const double size_f = norm(l, k_);
    for (std::size_t i = 0; i < n_; ++i) scratch_[i * stride_ + l] = stage_[i * stride_ + l] - k_[i * stride_ + l];
    const double size_change = norm(l, scratch_) / h_[l];
    const double largest = std::max(size_f, size_change);
    const double h1 = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h_[l]) : std::pow(0.01 / largest, 1.0 / T::order);
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
      if (!lane_[l].go_on(options_)) leave(l);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      t_[l] = lane_[l].next_time(options_);
      h_[l] = t_[l] - lane_[l].t();
      failed_[l] = 0;
    }
  }

  /// Trial states at t1 of all lanes; failed_ has the first code of each.
  void attempt() {
    stages_from<1>();
    advance();
    if constexpr (end_known) evaluate_column(t_, x1_, k_ + (stages - 1) * n_ * stride_);
    if constexpr (adaptive_method) errors();
  }
  template <std::size_t Row>
  void stages_from() {
    if constexpr (Row < T::stages) {
      for (std::size_t l = 0; l < lane_.size(); ++l) stage_t_[l] = lane_[l].t() + T::c[Row] * h_[l];
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t l = 0; l < padded(); l += width) {
          const std::size_t at = i * stride_ + l;
          store(stage_ + at,
                load(x0_ + at) + load(h_ + l) * weighted<T::a, Row>(k_ + at, std::make_index_sequence<stages>{}));
        }
      }
      evaluate_column(stage_t_, stage_, k_ + Row * n_ * stride_);
      stages_from<Row + 1>();
    }
  }
  void evaluate_column(const double* t, const double* x, double* dx) {
    for (std::size_t l = 0; l < lane_.size(); ++l) lane_[l].count(failed_[l] == 0 ? 1 : 0);
    if (rhs_(lane_.size(), stride_, t, x, p_, dx, codes_.data()) == 0) return;
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0) failed_[l] = codes_[l];
    }
  }

  template <const auto& Rows, std::size_t Row, std::size_t... J>
  [[gnu::always_inline]] Pack weighted(const double* k, std::index_sequence<J...>) const {
    Pack sum{};
    (
        [&] {
          if constexpr (Rows[Row][J] != 0) sum += Rows[Row][J] * load(k + J * n_ * stride_);
        }(),
        ...);
    return sum;
  }

  void advance() {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        const Pack x = load(x0_ + at);
        const Pack increment =
            load(h_ + l) * weighted<T::a, T::stages>(k_ + at, std::make_index_sequence<stages>{}) + load(carry_ + at);
        const Pack sum = x + increment;
        const Pack taken = sum - x;
        store(new_carry_ + at, (x - (sum - taken)) + (increment - taken));
        store(x1_ + at, sum);
      }
    }
  }

  /// Stepper::error_norm of all lanes.
  void errors() {
    const double count = static_cast<double>(n_error_);
    const Pack zero{};
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack sum{}, guard{};
      for (std::size_t i = 0; i < n_error_; ++i) {
        const std::size_t at = i * stride_ + l;
        const Pack scale = options_.atol + options_.rtol * larger(size_of(load(x0_ + at)), size_of(load(x1_ + at)));
        const auto square = [&](Pack error) {
          const Pack value = error == zero ? zero : error / scale;
          return value * value;
        };
        sum += square(weighted<T::error, 0>(k_ + at, std::make_index_sequence<stages>{}));
        if constexpr (T::error.size() == 2)
          guard += square(weighted<T::error, 1>(k_ + at, std::make_index_sequence<stages>{}));
      }
      store(error_ + l, sum);
      if constexpr (T::error.size() == 2) store(stage_t_ + l, sum + 0.01 * guard);
    }
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const double size = std::abs(h_[l]);
      if constexpr (T::error.size() == 2) {
        if (stage_t_[l] > 0) error_[l] = size * error_[l] / std::sqrt(count * stage_t_[l]);
      } else {
        error_[l] = size * std::sqrt(error_[l] / count);
      }
    }
  }

  /// Of the trial states: 0 where all is finite, else no number; and the largest component.
  void examine(const double* end) {
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack state{}, slope{}, size{};
      for (std::size_t i = 0; i < n_; ++i) {
        const Pack x = load(x1_ + i * stride_ + l), f = load(end + i * stride_ + l);
        state += x - x;
        slope += f - f;
        size = larger(size, size_of(x));
      }
      store(state_ + l, state);
      store(slope_ + l, slope);
      store(size_ + l, size);
    }
  }

  void decide() {
    const double* const end = k_ + (stages - 1) * n_ * stride_;
    if constexpr (!end_known) {  // of lanes that will not be accepted too, for which nothing is counted
      rhs_(lane_.size(), stride_, t_, x1_, p_, k_ + (stages - 1) * n_ * stride_, codes_.data());
    }
    examine(end);
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      const double error = adaptive() ? error_[l] : 0;
      accepted_[l] = 0;
      if (failed_[l] != 0) {
        goes_on_[l] = lane_[l].retry(failed_[l]);
      } else if (!std::isfinite(error) || state_[l] != 0) {
        goes_on_[l] = lane_[l].retry(code_not_finite);
      } else if (error > 1) {
        goes_on_[l] = lane_[l].reject(h_[l], error);
      } else {
        goes_on_[l] = complete(l, error);
      }
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        const Pack zero{}, accepted = load(accepted_ + l);
        store(x0_ + at, accepted == zero ? load(x0_ + at) : load(x1_ + at));
        store(k_ + at, accepted == zero ? load(k_ + at) : load(end + at));
        store(carry_ + at, accepted == zero ? load(carry_ + at) : load(new_carry_ + at));
      }
    }
    for (std::size_t l = lane_.size(); l-- > 0;) {
      if (!goes_on_[l]) leave(l);
    }
  }
  bool complete(std::size_t l, double error) {
    if constexpr (!end_known) {
      lane_[l].count(1);
      if (codes_[l] != 0) return lane_[l].retry(codes_[l]);
    }
    if (slope_[l] != 0) return lane_[l].retry(code_not_finite);
    accepted_[l] = 1;
    const bool goes_on = lane_[l].accept(t_[l], error, options_);
    return size_[l] > divergence_bound ? lane_[l].end(Outcome::diverged) : goes_on;
  }

  Rhs& rhs_;
  Next& next_;
  Start& start_;
  Done& done_;
  const EnsembleOptions& options_;
  std::size_t n_, n_error_, p_count_, lanes_, stride_;
  std::vector<double> work_;
  std::vector<int> codes_, failed_;
  std::vector<char> goes_on_;
  std::vector<Lane> lane_;
  double *k_, *x0_, *x1_, *stage_, *carry_, *new_carry_, *scratch_, *p_;  // rows of lanes, stride_ apart
  double *t_, *h_, *stage_t_, *error_;                                    // t_: where the trial step ends
  double *state_, *slope_, *size_, *accepted_;                            // of examine() and decide()
  double *one_x_, *one_p_;                                                // of one member
};

}  // namespace eom::ensemble
