// SPDX-License-Identifier: MIT
// The method `auto`: dopri5 for rtol above 1e-4, else dop853. While the motion is stiff it is radau for rtol from
// 1e-11 to 1e-5, else radau5. Options::choice records the changes and their reasons.
//
// Explicit methods: after each step |h lambda| is estimated from the last stage and the end, both at t1 (Hairer,
// Wanner, Solving Ordinary Differential Equations II, section IV.2), and averaged. The motion counts as stiff after 15
// steps beyond the stability limit without six in a row below it. The limit of dop853 is 5.96 along vibrations and 6.39
// along decay; that of dopri5 is 3.3 along decay but 1.0 along vibrations, so 50 steps in a row near it lead to dop853
// first. At tight tolerances rounding keeps the fast part of a stiff motion alive and steps stay below the limit.
// Therefore 50 steps of dop853 in a row with three times the |h lambda| of a motion that is itself that fast also count
// as stiff. Implicit methods: h rho(df/dx) by power iteration; 15 steps in a row below half of that value lead back.
//
// A change that is soon undone did not pay. If the implicit steps replaced fewer than 60 explicit ones at their limit
// of stability, the next change to the implicit method requires twice as many stiff steps; likewise the next change
// back after fewer than 60 steps of the explicit method before the motion was stiff. These counts are part of
// Options::choice, since each event begins a new run. With fixed steps the method does not change.
//
// The first ten steps of an implicit method are a trial. Its cost per unit of time, in evaluations of the right-hand
// side (implicit/work.hpp), is compared with that of the explicit method in the steps that led to the change. If it is
// between 1.5 and 4 times as high, the trial goes on, for at most thirty steps, since the step and the order of radau
// may grow. If it remains higher, the explicit method continues, and the next trial requires eight times as many stiff
// steps. Operations are counted, never clocks, so that every process makes the same choice.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "eom/explicit_rk/dop853.hpp"
#include "eom/explicit_rk/dopri5.hpp"
#include "eom/explicit_rk/method.hpp"
#include "eom/implicit/radau.hpp"
#include "eom/implicit/radau5.hpp"
#include "eom/implicit/work.hpp"

namespace eom {

/// The method `auto`: dopri5 or dop853, and radau5 or radau as long as the motion is stiff.
class Automatic {
  enum class Active { dopri5, dop853, radau5, radau };
  using Dopri5 = explicit_rk::Method<explicit_rk::Dopri5, System>;
  using Dop853 = explicit_rk::Method<explicit_rk::Dop853, System>;

  template <class Do>
  decltype(auto) with_active(Do&& act) {
    switch (active_) {
      case Active::dopri5: return act(*dopri5_);
      case Active::dop853: return act(*dop853_);
      case Active::radau: return act(*radau_);
      default: return act(*radau5_);
    }
  }

 public:
  static constexpr const char* name = "auto";
  static constexpr bool adaptive = true;
  static constexpr int order = 5;  // at least
  /// dopri5 above this value of rtol. At equal true errors below 1e-3 dop853 takes less time, with few exceptions.
  static constexpr double rtol_of_dopri5 = 1e-4;
  /// radau5 above this value of rtol, else radau, whose order rises with the accuracy.
  static constexpr double rtol_of_radau5 = 1e-5;
  /// And below this one: quadratures, such as the work of a run, do not control the steps and the order of radau, and
  /// have larger errors there.
  static constexpr double least_rtol_of_radau = 1e-11;
  static constexpr int dense_order = 4;

  Automatic(System& system, std::span<const double> x, const Options& options)
      : system_(system),
        options_(options),
        choice_(options.choice != nullptr ? *options.choice : own_),
        direction_(x.size()) {
    if (choice_.method == nullptr) choice_.method = explicit_name();
    active_ = choice_.method == std::string_view(implicit::Radau5::name)      ? Active::radau5
              : choice_.method == std::string_view(implicit::Radau::name)     ? Active::radau
              : choice_.method == std::string_view(explicit_rk::Dopri5::name) ? Active::dopri5
                                                                              : Active::dop853;
    make(x);
  }

  std::size_t size() const { return direction_.size(); }
  double* x0() {
    return with_active([](auto& m) { return m.x0(); });
  }
  double* x1() {
    return with_active([](auto& m) { return m.x1(); });
  }
  const double* derivative0() {
    return with_active([](auto& m) { return m.derivative0(); });
  }
  const double* derivative1() {
    return with_active([](auto& m) { return m.derivative1(); });
  }
  double* scratch() {
    return with_active([](auto& m) { return m.scratch(); });
  }
  int evaluate(double t, const double* x, double* dx) {
    return with_active([&](auto& m) { return m.evaluate(t, x, dx); });
  }
  int evaluate_start(double t) {
    return with_active([&](auto& m) { return m.evaluate_start(t); });
  }
  int evaluate_end() {
    return with_active([](auto& m) { return m.evaluate_end(); });
  }
  bool end_known() const { return active_ == Active::dopri5; }
  int starting_order() const { return active_ == Active::dop853 ? explicit_rk::Dop853::order : order; }

  int attempt(double t0, double t1) {
    if (steps_ == 0) window_.t = stiff_from_.t = now_.t = t0;
    t1_ = t1;
    return with_active([&](auto& m) { return m.attempt(t0, t1); });
  }
  double error_norm(double rtol, double atol) {
    return with_active([&](auto& m) { return m.error_norm(rtol, atol); });
  }
  double after_rejected(double h, double error) {
    return with_active([&](auto& m) { return m.after_rejected(h, error); });
  }
  double after_failed(double h) {
    return with_active([&](auto& m) { return m.after_failed(h); });
  }

  double after_accepted(double h, double error) {
    add_work();
    const double next = with_active([&](auto& m) { return m.after_accepted(h, error); });
    h_ = h;
    ++steps_;
    is_implicit() ? judge_implicit_method() : detect_stiffness();
    return next_.has_value() ? std::min(h, next) : next;
  }

  void accept(bool moved) {
    with_active([&](auto& m) { m.accept(moved); });
    if (next_.has_value()) change();
  }

  static void interpolate(const void* method, double t, double* x) {
    const Automatic& self = *static_cast<const Automatic*>(method);
    switch (self.active_) {
      case Active::dopri5: return self.dopri5_->interpolate(t, x);
      case Active::dop853: return self.dop853_->interpolate(t, x);
      case Active::radau5: return self.radau5_->interpolate(t, x);
      case Active::radau: return self.radau_->interpolate(t, x);
    }
  }

  Statistics statistics() {
    Statistics sum = past_;
    return sum += with_active([](auto& m) -> Statistics { return m.statistics(); });
  }

 private:
  static constexpr double limit_of_dopri5 = 3.25, limit_of_dop853 = 5.7;
  static constexpr double vibration_start = 0.75;  // of dopri5
  static constexpr int confirming_steps = 50;
  static constexpr double smoothing =
      0.2;  // of the logarithm: in a vibration the estimate varies like the tangent of its phase
  static constexpr int nonstiff_run = 6;  // this many steps in a row that are not stiff reset the count
  static constexpr int required_stiff_steps = MethodChoice::min_stiff_steps;
  static constexpr int most_required = 1 << 24;
  static constexpr int trial_steps = 10;       // of radau5; its step grows most in the first half of them
  static constexpr double trial_margin = 1.5;  // and somewhat in the second half
  static constexpr double rising_margin = 4;   // below it the trial goes on: the step or the order may rise
  static constexpr int short_phase = 4 * required_stiff_steps;

  bool is_implicit() const { return active_ == Active::radau5 || active_ == Active::radau; }
  const char* explicit_name() const {
    return options_.rtol > rtol_of_dopri5 ? explicit_rk::Dopri5::name : explicit_rk::Dop853::name;
  }
  Active explicit_method() const { return options_.rtol > rtol_of_dopri5 ? Active::dopri5 : Active::dop853; }
  Active implicit_method() const {
    return options_.rtol > rtol_of_radau5 || options_.rtol < least_rtol_of_radau ? Active::radau5 : Active::radau;
  }
  /// A change back pays below this |h lambda|. It is well below the value that leads to radau5.
  double explicit_limit() const { return options_.rtol > rtol_of_dopri5 ? vibration_start : 0.5 * accuracy_limit(); }

  void make(std::span<const double> x) {
    switch (active_) {
      case Active::dopri5: dopri5_.emplace(system_, x, options_); return;
      case Active::dop853: dop853_.emplace(system_, x, options_); return;
      case Active::radau5: radau5_.emplace(system_, x, options_); return;
      case Active::radau: radau_.emplace(system_, x, options_); return;
    }
  }

  double tolerance() const { return std::max(options_.rtol, options_.atol); }
  /// The same for dopri5: about 4 tol^(1/5). At 1.5 times this value dop853 pays, whose limit along vibrations is
  /// wider.
  double vibration_limit() const { return std::max(vibration_start, 1.5 * 4 * std::pow(tolerance(), 0.2)); }
  /// dop853 follows a motion of rate lambda and of the size of the state with |h lambda| about 6 tol^(1/8).
  double accuracy_limit() const { return std::min(limit_of_dop853, 3 * 6 * std::pow(tolerance(), 0.125)); }

  void detect_stiffness() {
    ++choice_.steps;
    const bool fifth = active_ == Active::dopri5;
    const double seen = fifth ? dopri5_->stiffness() : dop853_->stiffness();
    if (seen > 0 && std::isfinite(seen)) level_ += (std::log(seen) - level_) * (level_ == 0 ? 1 : smoothing);
    const double value = std::exp(level_);
    const double limit = fifth ? limit_of_dopri5 : limit_of_dop853;
    if (stiff_steps_ == 0 && inaccurate_steps_ == 0) stiff_from_ = now_;
    if (value > limit) {
      nonstiff_steps_ = 0;
      if (++stiff_steps_ >= choice_.required_stiff_steps)
        plan_implicit(ChangeReason::beyond_stability, limit, stiff_steps_);
    } else if (++nonstiff_steps_ == nonstiff_run) {
      stiff_steps_ = 0;
    }
    inaccurate_steps_ = !fifth && value > accuracy_limit() ? inaccurate_steps_ + 1 : 0;
    if (inaccurate_steps_ >= confirming_steps * choice_.required_stiff_steps / required_stiff_steps &&
        !next_.has_value())
      plan_implicit(ChangeReason::beyond_accuracy, accuracy_limit(), inaccurate_steps_);
    vibration_steps_ = fifth && value > vibration_limit() ? vibration_steps_ + 1 : 0;
    if (vibration_steps_ >= confirming_steps && !next_.has_value())
      plan(Active::dop853, ChangeReason::vibrations, vibration_limit(), vibration_steps_);
  }

  /// The motion is stiff. If the explicit method has been in use for a short time only, the next change back requires
  /// more steps.
  void plan_implicit(ChangeReason why, double limit, int steps) {
    const bool hasty = !choice_.changes.empty() && choice_.steps - steps < short_phase;
    choice_.required_nonstiff_steps =
        hasty ? std::min(most_required, 2 * choice_.required_nonstiff_steps) : required_stiff_steps;
    explicit_cost_ = cost_per_time(stiff_from_, now_);
    plan(implicit_method(), why, limit, steps);
  }

  void judge_implicit_method() {
    if (explicit_cost_ > 0 && steps_ % trial_steps == trial_steps / 2) window_ = now_;
    if (explicit_cost_ > 0 && steps_ % trial_steps == 0 && is_costlier()) return;
    detect_end_of_stiffness();
  }

  void detect_end_of_stiffness() {
    const double value = h_ * spectral_radius();
    choice_.steps += 1 + static_cast<int>(std::min(value / limit_of_dop853, 1e6));  // at least those that it replaces
    choice_.steps = std::min(choice_.steps, most_required);
    nonstiff_steps_ = value < explicit_limit() ? nonstiff_steps_ + 1 : 0;
    if (nonstiff_steps_ < choice_.required_nonstiff_steps) return;
    choice_.required_stiff_steps =
        choice_.steps < short_phase ? std::min(most_required, 2 * choice_.required_stiff_steps) : required_stiff_steps;
    plan(explicit_method(), ChangeReason::no_longer_stiff, explicit_limit(), nonstiff_steps_);
  }

  struct Progress {
    double t = 0, cost = 0;
  };

  std::size_t unknowns() const { return size() - options_.quadratures; }
  std::size_t stages() const { return active_ == Active::radau ? radau_->stages() : 3; }

  /// Adds the work since the last step.
  void add_work() {
    const Statistics total = with_active([](auto& m) -> Statistics { return m.statistics(); });
    now_ = {t1_, now_.cost + implicit::work(total - counted_, unknowns(), stages())};
    counted_ = total;
  }

  static double cost_per_time(const Progress& from, const Progress& to) {
    return (to.cost - from.cost) / std::abs(to.t - from.t);
  }

  /// After each ten steps of the trial: whether the implicit method costs more than the explicit one, which then
  /// continues. The trial goes on while the step or the order may rise.
  bool is_costlier() {
    const double ratio = cost_per_time(window_, now_) / explicit_cost_;
    const bool may_fall = ratio > trial_margin && ratio <= rising_margin && steps_ < 3 * trial_steps;
    if (may_fall) return false;
    explicit_cost_ = 0;
    if (!(ratio > trial_margin)) return false;
    constexpr int after_failed_trial = 8;
    choice_.required_stiff_steps = std::min(most_required, after_failed_trial * choice_.required_stiff_steps);
    plan(explicit_method(), ChangeReason::costlier, ratio, trial_steps - trial_steps / 2);
    return true;
  }

  /// sqrt(|J J v| / |v|): exact at once if J J v = -omega^2 v. v turns towards the fastest motion from step to step.
  double spectral_radius() {
    const implicit::Jacobian& J = active_ == Active::radau ? radau_->jacobian() : radau5_->jacobian();
    const std::size_t m = unknowns();
    double* turned = scratch();
    const auto apply = [&](const std::vector<double>& from, double* to) {
      double sum = 0;
      for (std::size_t i = 0; i < m; ++i) {
        to[i] = 0;
        for (std::size_t j = 0; j < m; ++j) to[i] += J(i, j) * from[j];
        sum += to[i] * to[i];
      }
      return std::sqrt(sum);
    };
    const auto scale = [&](double by) {
      for (std::size_t i = 0; i < m; ++i) direction_[i] = turned[i] / by;
    };
    const double first = apply(direction_, turned);
    if (!(first > 0) || !std::isfinite(first)) return start_direction(), std::isnan(first) ? first : 0;
    scale(first);
    const double second = apply(direction_, turned);
    if (!(second > 0) || !std::isfinite(second)) return start_direction(), 0;
    scale(second);
    return std::sqrt(first * second);
  }

  void start_direction() {
    const std::size_t m = unknowns();
    for (std::size_t i = 0; i < m; ++i)
      direction_[i] = (1 + 0.5 * static_cast<double>(i % 3)) / std::sqrt(static_cast<double>(m));
  }

  void plan(Active next, ChangeReason why, double limit, int steps) {
    planned_ = {t1_, choice_.method, choice_.method, why, limit, steps};
    next_ = next;
  }

  void change() {
    past_ = statistics();
    const std::vector<double> x(x0(), x0() + size()), f(derivative0(), derivative0() + size());
    active_ = *next_;
    next_.reset();
    choice_.method = active_ == Active::radau5   ? implicit::Radau5::name
                     : active_ == Active::radau  ? implicit::Radau::name
                     : active_ == Active::dopri5 ? explicit_rk::Dopri5::name
                                                 : explicit_rk::Dop853::name;
    make(x);
    with_active([&](auto& m) { m.start_with_derivative(f.data()); });
    planned_.t = t1_;
    planned_.to = choice_.method;
    choice_.changes.push_back(planned_);
    choice_.steps = steps_ = stiff_steps_ = inaccurate_steps_ = nonstiff_steps_ = vibration_steps_ = 0;
    level_ = 0;
    counted_ = {};
    window_ = now_;
    start_direction();
  }

  System& system_;
  const Options& options_;
  MethodChoice own_;
  MethodChoice& choice_;
  std::vector<double> direction_;
  Active active_;
  std::optional<Dopri5> dopri5_;
  std::optional<Dop853> dop853_;
  std::optional<implicit::Radau5> radau5_;
  std::optional<implicit::Radau> radau_;
  std::optional<Active> next_;
  MethodChange planned_{};
  Statistics past_, counted_;
  double t1_ = 0, h_ = 0, level_ = 0;
  Progress now_, window_, stiff_from_;
  double explicit_cost_ = 0;  // per unit of time, before the trial of the implicit method; 0: no trial
  int steps_ = 0;             // since the last change or the start
  int stiff_steps_ = 0, inaccurate_steps_ = 0, nonstiff_steps_ = 0, vibration_steps_ = 0;
};

}  // namespace eom
