// SPDX-License-Identifier: MIT
// Storage of members side by side, in rows of lanes, and the operations common to all methods, bitwise equal to those
// of drive.hpp and step_ends.hpp. In: derivatives of many states. Out: the state of each lane, trial states. Allocates
// in the constructor only.
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

/// The lanes of a method as `type`, and takes(options): whether they support these options. Specialised for each method
/// with lanes; other methods integrate members one by one.
template <class Method, class Rhs, bool dense>
struct LanesOf;

/// Rhs: as EnsembleRhs. Steps: step size control of one lane, as for Lane. A method allocates its own rows, f0_ and f1_
/// included.
template <class Rhs, class Steps, std::size_t width>
class LaneRows {
 public:
  /// rows: of the method, `width` members each.
  LaneRows(Rhs& rhs, std::size_t states, std::size_t parameters, const EnsembleOptions& options, std::size_t rows)
      : rhs_(rhs),
        options_(options),
        n_(states),
        n_error_(states - options.quadratures),
        p_count_(parameters),
        lanes_(slots_of(options, width)),
        stride_(lanes_ % 64 == 0 ? lanes_ + 8 : lanes_),  // rows a power of two apart would collide in the cache
        work_((rows + 6 * n_ + p_count_ + 8) * stride_ + n_ + p_count_),
        free_(work_.data()),
        codes_(stride_),
        failed_(stride_) {
    for (double** vector : {&x0_, &x1_, &stage_, &carry_, &new_carry_, &scratch_}) *vector = take(n_);
    p_ = take(p_count_);
    for (double** row : {&t_, &h_, &stage_t_, &error_, &state_, &slope_, &size_, &accepted_}) *row = take(1);
    one_x_ = std::exchange(free_, free_ + n_);
    one_p_ = std::exchange(free_, free_ + p_count_);
    lane_.reserve(lanes_);
  }
  LaneRows(const LaneRows&) = delete;
  LaneRows& operator=(const LaneRows&) = delete;

 protected:
  double* take(std::size_t rows) { return std::exchange(free_, free_ + rows * stride_); }
  std::size_t padded() const { return (lane_.size() + width - 1) / width * width; }

  /// Evaluates derivatives of `count` lanes from `first` on.
  int evaluate(std::size_t first, std::size_t count, const double* t, const double* x, double* dx) {
    for (std::size_t l = first; l < first + count; ++l) lane_[l].count(1);
    return rhs_(count, stride_, t + first, x + first, p_ + first, dx + first, codes_.data() + first);
  }
  /// Evaluates derivatives of all lanes; failed_ receives the first code of each.
  void evaluate_all(const double* t, const double* x, double* dx) {
    for (std::size_t l = 0; l < lane_.size(); ++l) lane_[l].count(failed_[l] == 0 ? 1 : 0);
    fail_by(rhs_(lane_.size(), stride_, t, x, p_, dx, codes_.data()));
  }
  /// Distributes the codes of a call that returned `any`.
  void fail_by(int any) {
    if (any == 0) return;
    for (std::size_t l = 0; l < lane_.size(); ++l) {
      if (failed_[l] == 0) failed_[l] = codes_[l];
    }
  }

  /// Evaluates derivatives at the starts of lanes from `first` on.
  void begin_slopes(std::size_t first, std::size_t count) { evaluate(first, count, t_, x0_, f0_); }
  /// Evaluates derivatives at the ends of trial steps, also for lanes that will be rejected, without counting.
  void end_slopes() { rhs_(lane_.size(), stride_, t_, x1_, p_, f1_, codes_.data()); }

  void move_rows(double* array, std::size_t count, std::size_t to, std::size_t from) {
    for (std::size_t i = 0; i < count; ++i) array[i * stride_ + to] = array[i * stride_ + from];
  }
  void move(std::size_t to, std::size_t from) {
    for (double* array : {f0_, x0_, carry_}) move_rows(array, n_, to, from);
    move_rows(p_, p_count_, to, from);
  }

  /// StepEnds::advance for the lanes from l on in component i.
  [[gnu::always_inline]] void advance(std::size_t i, std::size_t l, Pack increment) {
    const std::size_t at = i * stride_ + l;
    const Pack x = load(x0_ + at);
    increment += load(carry_ + at);
    const Pack sum = x + increment;
    const Pack taken = sum - x;
    store(new_carry_ + at, (x - (sum - taken)) + (increment - taken));
    store(x1_ + at, sum);
  }

  /// Checks the trial states: 0 if all components are finite, else NaN; and computes the largest component.
  void examine() {
    for (std::size_t l = 0; l < padded(); l += width) {
      Pack state{}, slope{}, size{};
      for (std::size_t i = 0; i < n_; ++i) {
        const Pack x = load(x1_ + i * stride_ + l), f = load(f1_ + i * stride_ + l);
        state += x - x;
        slope += f - f;
        size = larger(size, size_of(x));
      }
      store(state_ + l, state);
      store(slope_ + l, slope);
      store(size_ + l, size);
    }
  }

  /// Hook before accepted steps are observed; does nothing by default.
  void prepare_accepted() {}

  /// Makes the end the next start, for lanes with an accepted step.
  void accept() {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t l = 0; l < padded(); l += width) {
        const std::size_t at = i * stride_ + l;
        const Pack zero{}, accepted = load(accepted_ + l);
        store(x0_ + at, accepted == zero ? load(x0_ + at) : load(x1_ + at));
        store(f0_ + at, accepted == zero ? load(f0_ + at) : load(f1_ + at));
        store(carry_ + at, accepted == zero ? load(carry_ + at) : load(new_carry_ + at));
      }
    }
  }

  Rhs& rhs_;
  const EnsembleOptions& options_;
  std::size_t n_, n_error_, p_count_, lanes_, stride_;
  std::vector<double> work_;
  double* free_;  // of work_
  std::vector<int> codes_, failed_;
  std::vector<Lane<Steps>> lane_;
  double *x0_, *x1_, *stage_, *carry_, *new_carry_, *scratch_, *p_;  // rows of lanes, stride_ apart
  double *f0_ = nullptr, *f1_ = nullptr;                             // derivatives at both ends
  double *t_, *h_, *stage_t_, *error_;                               // t_: the end of the trial step
  double *state_, *slope_, *size_, *accepted_;                       // for examine() and the decisions
  double *one_x_, *one_p_;                                           // of one member
};

}  // namespace eom::ensemble
