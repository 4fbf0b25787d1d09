// SPDX-License-Identifier: MIT
// Ensembles on an accelerator, one member per thread, each with its own steps; CUDA, HIP, or any C++20 compiler for the
// host. In: a model, a type with
//   static constexpr std::size_t states, parameters;
//   template <class Real> static EOM_DEVICE int rhs(Real t, const Real* x, const Real* p, Real* dx);   a code of the C
//   ABI
// as emitted by target cuda of eomgen. Out: the end of each member. Decisions and sums are those of eom::integrate. In
// binary64, compiled without contraction of products and sums, results are bitwise equal. No allocation, no library.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "eom/explicit_rk/dop853.hpp"
#include "eom/explicit_rk/tsit5.hpp"

#if defined(__CUDACC__) || defined(__HIPCC__)
#define EOM_DEVICE __host__ __device__
#else
#define EOM_DEVICE
#endif

namespace eom::device {

/// Codes of a member; 1 to 5 are those of the C ABI.
inline constexpr int done = 0, not_finite = 5, too_many_steps = 6, step_too_small = 7, diverged = 8;

/// Tolerances and limits of the steps of each member.
struct Settings {
  double rtol = 1e-9, atol = 1e-12;  // in single precision: not below 1e-6
  double max_step = std::numeric_limits<double>::infinity();
  double initial_step = 0;                    // 0: chosen
  unsigned long long max_steps = 50'000'000;  // accepted and rejected together
};

/// Counts of the work of one member.
struct Counts {
  unsigned long long steps = 0, rejected = 0, evaluations = 0;
};

namespace detail {

template <class Real>
EOM_DEVICE inline Real larger(Real a, Real b) {
  return a < b ? b : a;
}
template <class Real>
EOM_DEVICE inline Real smaller(Real a, Real b) {
  return b < a ? b : a;
}
template <class Real>
EOM_DEVICE inline Real size_of(Real a) {
  return a < 0 ? -a : a;
}
template <class Real>
EOM_DEVICE inline bool finite(const Real* x, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    if (!(x[i] - x[i] == 0)) return false;
  }
  return true;
}

// Coefficients of a tableau as variables: device code may not call the operators of std::array.
template <const auto& Rows, std::size_t Row, std::size_t J>
inline constexpr double weight_of = Rows[Row][J];
template <class T, std::size_t Row>
inline constexpr double time_of = T::c[Row];
template <class T>
inline constexpr bool uses_end = explicit_rk::error_uses_end<T>();
template <class T>
inline constexpr std::size_t estimators = T::error.size();

template <const auto& Rows, std::size_t Row, std::size_t J, class Real>
EOM_DEVICE inline void add_weighted(const Real* k, std::size_t n, Real& sum) {
  if constexpr (weight_of<Rows, Row, J> != 0) sum += static_cast<Real>(weight_of<Rows, Row, J>) * k[J * n];
}
template <const auto& Rows, std::size_t Row, class Real, std::size_t... J>
EOM_DEVICE inline Real weighted(const Real* k, std::size_t n, std::index_sequence<J...>) {
  Real sum = 0;
  (add_weighted<Rows, Row, J>(k, n, sum), ...);
  return sum;
}

}  // namespace detail

/// One member; T: a tableau of eom/explicit_rk with an error estimate of one or two rows.
template <class T, class Model, class Real>
class Member {
 public:
  /// p: the parameters of this member. Both must outlive it.
  EOM_DEVICE Member(const Real* p, const Settings& settings)
      : p_(p), settings_(settings), rtol_(static_cast<Real>(settings.rtol)), atol_(static_cast<Real>(settings.atol)) {}

  /// Integrates from x at t0 to t1. x becomes the last accepted state. Returns a code.
  EOM_DEVICE int run(Real t0, Real t1, Real* x, Counts& counts) {
    for (std::size_t i = 0; i < n; ++i) x0_[i] = x[i], carry_[i] = 0;
    t_ = t_start_ = t0, t_end_ = t1, direction_ = t1 < t0 ? Real(-1) : Real(1);
    int code = t0 == t1 ? done : start(counts);
    while (code == done && t_ != t_end_) code = step(counts);
    for (std::size_t i = 0; i < n; ++i) x[i] = x0_[i];
    return code;
  }
  /// The time reached.
  EOM_DEVICE Real time() const { return t_; }

 private:
  static constexpr std::size_t n = Model::states;
  static constexpr double divergence_bound = 1e150, float_bound = 1e30;

  EOM_DEVICE int rhs(Real t, const Real* x, Real* dx, Counts& counts) const {
    ++counts.evaluations;
    return Model::rhs(t, x, p_, dx);
  }

  EOM_DEVICE int start(Counts& counts) {
    if (const int code = rhs(t_, x0_, k_, counts); code != 0) return code;
    if (!detail::finite(x0_, n) || !detail::finite(k_, n)) return not_finite;
    h_ = settings_.initial_step > 0 ? static_cast<Real>(settings_.initial_step) : initial_step(counts);
    h_ = detail::smaller(detail::larger(h_, smallest_step(t_)), longest_step());
    return done;
  }

  EOM_DEVICE int step(Counts& counts) {
    if (counts.steps + counts.rejected >= settings_.max_steps) return too_many_steps;
    const Real left = detail::size_of(t_end_ - t_);
    const Real t_next = Real(1.01) * h_ >= left ? t_end_ : t_ + direction_ * (2 * h_ > left ? Real(0.5) * left : h_);
    const Real h = t_next - t_;
    int code = stages(h, std::make_index_sequence<T::stages>{}, counts);
    Real error = 0;
    if (code == 0) {
      advance(h);
      if constexpr (detail::uses_end<T>) code = rhs(t_next, x1_, k_ + T::stages * n, counts);
    }
    if (code == 0) {
      error = error_norm(h);
      if (!(error - error == 0) || !detail::finite(x1_, n)) code = not_finite;
    }
    if (code == 0 && error > 1) return reject(h, error, counts);
    if constexpr (!detail::uses_end<T>) {
      if (code == 0) code = rhs(t_next, x1_, k_ + T::stages * n, counts);
    }
    if (code == 0 && !detail::finite(k_ + T::stages * n, n)) code = not_finite;
    if (code != 0) return retry(code, counts);
    return accept(t_next, error, counts);
  }

  template <std::size_t... Row>
  EOM_DEVICE int stages(Real h, std::index_sequence<Row...>, Counts& counts) {
    int code = 0;
    ((code == 0 && Row > 0 ? code = column<Row>(h, counts) : 0), ...);
    return code;
  }
  template <std::size_t Row>
  EOM_DEVICE int column(Real h, Counts& counts) {
    for (std::size_t i = 0; i < n; ++i) stage_[i] = x0_[i] + h * sum_of<T::a, Row, explicit_rk::columns<T>>(i);
    return rhs(t_ + static_cast<Real>(detail::time_of<T, Row>) * h, stage_, k_ + Row * n, counts);
  }
  /// Sums over the stored columns: columns of the dense output have no weight in a stage.
  template <const auto& Rows, std::size_t Row, std::size_t Columns>
  EOM_DEVICE Real sum_of(std::size_t i) const {
    constexpr std::size_t there = Columns < T::stages + 1 ? Columns : T::stages + 1;
    return detail::weighted<Rows, Row>(k_ + i, n, std::make_index_sequence<there>{});
  }

  EOM_DEVICE void advance(Real h) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real increment = h * sum_of<T::a, T::stages, explicit_rk::columns<T>>(i) + carry_[i];
      const Real sum = x0_[i] + increment;
      const Real taken = sum - x0_[i];  // Knuth's two-sum: the rounding error of x0 + increment
      new_carry_[i] = (x0_[i] - (sum - taken)) + (increment - taken);
      x1_[i] = sum;
    }
  }

  EOM_DEVICE Real error_norm(Real h) const {
    using std::sqrt;
    Real sum = 0, guard = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Real scale = atol_ + rtol_ * detail::larger(detail::size_of(x0_[i]), detail::size_of(x1_[i]));
      const Real first = sum_of<T::error, 0, T::stages + 1>(i), units = first == 0 ? Real(0) : first / scale;
      sum += units * units;
      if constexpr (detail::estimators<T> == 2) {
        const Real second = sum_of<T::error, 1, T::stages + 1>(i), of_guard = second == 0 ? Real(0) : second / scale;
        guard += of_guard * of_guard;
      }
    }
    const Real count = static_cast<Real>(n);
    if constexpr (detail::estimators<T> == 2) {
      const Real both = sum + Real(0.01) * guard;  // HNW I, eq. (II.10.17)
      return both > 0 ? detail::size_of(h) * sum / sqrt(count * both) : sum;
    }
    return detail::size_of(h) * sqrt(sum / count);
  }

  EOM_DEVICE int accept(Real t_next, Real error, Counts& counts) {
    h_ = detail::smaller(after_accepted(detail::size_of(t_next - t_), error), longest_step());
    t_ = t_next;
    ++counts.steps;
    bool beyond = false;
    for (std::size_t i = 0; i < n; ++i) {
      x0_[i] = x1_[i], carry_[i] = new_carry_[i], k_[i] = k_[T::stages * n + i];
      beyond = beyond || detail::size_of(x0_[i]) >
                             static_cast<Real>(sizeof(Real) < sizeof(double) ? float_bound : divergence_bound);
    }
    return beyond ? diverged : done;
  }
  EOM_DEVICE int reject(Real h, Real error, Counts& counts) {
    using std::pow;
    ++counts.rejected;
    rejected_before_ = true;
    h_ = detail::size_of(h) * detail::smaller(growth(pow(error, exponent())), Real(0.95));
    return h_ >= smallest_step(t_) ? done : step_too_small;
  }
  EOM_DEVICE int retry(int code, Counts& counts) {
    ++counts.rejected;
    rejected_before_ = true;
    h_ = Real(0.25) * detail::smaller(h_, detail::size_of(t_end_ - t_));
    return h_ >= smallest_step(t_) ? done : code;
  }

  // See explicit_rk::Controller.
  static EOM_DEVICE Real exponent() {
    constexpr double value = 1.0 / T::order - 0.75 * T::control.beta;
    return static_cast<Real>(value);
  }
  static EOM_DEVICE Real growth(Real factor) {
    constexpr double safety = T::control.safety, shrink = T::control.shrink, grow = T::control.grow;
    const Real value = static_cast<Real>(safety) / factor;
    return value < static_cast<Real>(shrink) ? static_cast<Real>(shrink)
           : value > static_cast<Real>(grow) ? static_cast<Real>(grow)
                                             : value;
  }
  EOM_DEVICE Real after_accepted(Real h, Real error) {
    using std::pow;
    constexpr double beta = T::control.beta;
    Real factor = pow(error, exponent());
    if constexpr (beta > 0) factor /= pow(error_before_, static_cast<Real>(beta));
    error_before_ = detail::larger(error, Real(1e-4));
    Real by = growth(factor);
    if (rejected_before_) by = detail::smaller(by, Real(1));
    rejected_before_ = false;
    return h * by;
  }

  /// HNW I, section II.4.
  EOM_DEVICE Real initial_step(Counts& counts) {
    using std::pow;
    const Real size_x = norm(x0_), size_f = norm(k_);
    Real h0 = size_x < Real(1e-5) || size_f < Real(1e-5) ? Real(1e-6) : Real(0.01) * size_x / size_f;
    h0 = detail::smaller(h0, longest_step());
    for (std::size_t i = 0; i < n; ++i) x1_[i] = x0_[i] + direction_ * h0 * k_[i];
    if (rhs(t_ + direction_ * h0, x1_, stage_, counts) != 0 || !detail::finite(stage_, n)) return Real(0.01) * h0;
    Real sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Real scale = atol_ + rtol_ * detail::size_of(x0_[i]);
      if (scale == 0) continue;
      const Real value = (stage_[i] - k_[i]) / scale;
      sum += value * value;
    }
    const Real size_change = root(sum) / h0, largest = detail::larger(size_f, size_change);
    const Real h1 = largest <= Real(1e-15) ? detail::larger(Real(1e-6), Real(1e-3) * h0)
                                           : pow(Real(0.01) / largest, order_inverse());
    return detail::smaller(100 * h0, h1);
  }
  static EOM_DEVICE Real order_inverse() {
    constexpr double value = 1.0 / T::order;
    return static_cast<Real>(value);
  }
  static EOM_DEVICE Real root(Real sum) {
    using std::sqrt;
    return sqrt(sum / static_cast<Real>(n));
  }
  EOM_DEVICE Real norm(const Real* values) const {
    Real sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Real scale = atol_ + rtol_ * detail::size_of(x0_[i]);
      if (scale == 0) continue;
      const Real value = values[i] / scale;
      sum += value * value;
    }
    return root(sum);
  }

  EOM_DEVICE Real longest_step() const {
    const Real span = detail::size_of(t_end_ - t_start_);
    return settings_.max_step < static_cast<double>(span) ? static_cast<Real>(settings_.max_step) : span;
  }
  static EOM_DEVICE Real smallest_step(Real t) {
    using std::nextafter;
    const Real magnitude = detail::size_of(t), more = magnitude * 2 + 1;
    return 16 * (nextafter(magnitude, more) - magnitude);
  }

  const Real* p_;
  const Settings& settings_;
  Real rtol_, atol_;
  Real k_[(T::stages + 1) * n], x0_[n], x1_[n], stage_[n], carry_[n], new_carry_[n];
  Real t_ = 0, t_start_ = 0, t_end_ = 0, direction_ = 1, h_ = 0, error_before_ = Real(1e-4);
  bool rejected_before_ = false;
};

/// Integrates member `member` of `members`, in structures of arrays. Entry i of x is x[i * members + member], and so
/// are the entries of p if each member has its own; a shared p is contiguous. t: the end time; counts: arrays of steps,
/// rejected steps and evaluations, one after the other; both may be null.
template <class T, class Model, class Real>
EOM_DEVICE void integrate_member(std::size_t member, std::size_t members, Real t0, Real t1, Real* x, const Real* p,
                                 bool own_parameters, const Settings& settings, int* codes, Real* t,
                                 unsigned long long* counts) {
  constexpr std::size_t n = Model::states, m = Model::parameters;
  Real state[n], parameters[m > 0 ? m : 1];
  for (std::size_t i = 0; i < n; ++i) state[i] = x[i * members + member];
  for (std::size_t i = 0; i < m; ++i) parameters[i] = own_parameters ? p[i * members + member] : p[i];
  Counts made;
  Member<T, Model, Real> run(parameters, settings);
  codes[member] = run.run(t0, t1, state, made);
  for (std::size_t i = 0; i < n; ++i) x[i * members + member] = state[i];
  if (t != nullptr) t[member] = run.time();
  if (counts == nullptr) return;
  counts[member] = made.steps;
  counts[members + member] = made.rejected;
  counts[2 * members + member] = made.evaluations;
}

#if defined(__CUDACC__) || defined(__HIPCC__)
template <class T, class Model, class Real>
__global__ void ensemble(std::size_t members, Real t0, Real t1, Real* x, const Real* p, bool own_parameters,
                         Settings settings, int* codes, Real* t, unsigned long long* counts) {
  const std::size_t member = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (member < members)
    integrate_member<T, Model, Real>(member, members, t0, t1, x, p, own_parameters, settings, codes, t, counts);
}
#endif

}  // namespace eom::device
