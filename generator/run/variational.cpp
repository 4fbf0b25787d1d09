// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/variational.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "run/central_differences.hpp"
#include "run/slip_turn.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {
namespace {

constexpr double relative_difference = 1e-3;  // of the state

/// The weights of a value in a difference and in one of lower order, both times h. Their difference shows whether h is
/// small enough: where a body rolls on a small obstacle, a part of the distance to the origin is not.
struct Weights {
  double weight, lower;
};

constexpr double remainder_by_state = 1e-5;  // of order 2: that of order 4 is as its square

/// Orders 6 and 4 from the scenes beside at h/2, h/4 and h/8, in the order of difference_offsets. Scenes are as far
/// away as their values change smoothly, and 1/m is not smooth enough for order 4.
constexpr std::array<Weights, 8> scene_weights{{{0, 0},
                                                {0, 0},
                                                {1.0 / 45, 0},
                                                {-1.0 / 45, 0},
                                                {-40.0 / 45, -8.0 / 12},
                                                {40.0 / 45, 8.0 / 12},
                                                {256.0 / 45, 64.0 / 12},
                                                {-256.0 / 45, -64.0 / 12}}};
constexpr double remainder_by_scene = 1e-9;

/// A difference of the right-hand side and of the slips of contacts, and the same to a lower order.
struct Difference {
  std::vector<double> slope, lower;
  Slips rates;
  double largest = 0;  // value

  /// The change from one order to the other, beyond the rounding of the values.
  double change(double rounding, double h) const {
    double result = 0;
    for (std::size_t i = 0; i < slope.size(); ++i) result = std::max(result, std::abs(slope[i] - lower[i]));
    return std::max(0.0, result - rounding / std::abs(h));
  }
};

}  // namespace

class VariationalRun::Run {
 public:
  Run(const RunRequest& request, const RunResult& motion, const std::string& solver,
      const std::vector<Direction>& directions)
      : scene_(request.scene),
        solver_(solver),
        directions_(directions),
        jumps_(request, motion, solver, directions),
        n_(jumps_.states()),
        u_(std::max<std::size_t>(1, scene_.inputs.size())),
        dfdx_(n_ * n_),
        dfdt_(n_),
        dfdp_(n_ * scene_.parameters.size()),
        dfdu_(n_ * u_.size()),
        f_(n_),
        slopes_(n_ * directions.size()) {}

  eom::Result run(const eom::Options& options) {
    eom::Result result = run(options, false);
    if (result.outcome != eom::Outcome::step_too_small || !jumps_.equations().has_slip_of_two()) return result;
    const eom::Statistics first = result.statistics;
    result = run(options, true);
    result.statistics += first;
    return result;
  }

  VariationalJumps& jumps() { return jumps_; }

  // The right-hand side of x and s. dx may alias x: x is read before dx is written.
  int operator()(double t, const double* x, double* dx) {
    auto& context = jumps_.equations().context;
    const eom::hybrid::Code& code = *jumps_.equations().problem.code;
    if (context.solved_contacts || code.jac == nullptr || code.jac_p == nullptr) return differences(t, x, dx);
    eom::hybrid::Model& model = context.model;
    const double* u = model.inputs(t);
    std::copy(u, u + u_.size(), u_.begin());
    const double* const at = model.state_at_slip_start(t, x, u_.data());
    if (const int code = derivatives(t, at, model.mode().data()); code != 0) {
      // As for f: a branch that is frozen beyond its surface may have no value there.
      if (derivatives(t, at, nullptr) != 0) return code;
    }
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const Direction& direction = directions_[d];
      double* slope = slopes_.data() + d * n_;
      add(dfdx_, n_, slope, [&](std::size_t j) { return x[(d + 1) * n_ + j]; });
      add(dfdp_, direction.dp.size(), slope, [&](std::size_t j) { return direction.scale * direction.dp[j]; });
      add(dfdu_, direction.du.size(), slope,
          [&](std::size_t j) { return direction.scale * direction.du[j](t, model.segment_time()); });
    }
    if (const int code = context.rhs(t, x, f_.data()); code != 0) return code;
    std::copy(f_.begin(), f_.end(), dx);
    std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return 0;
  }

 private:
  eom::Result run(const eom::Options& options, bool coarse) {
    eom::Result total;
    jumps_.set_tolerances(options.rtol, options.atol, coarse);
    state_nearness_.assign(directions_.size(), 0);
    scene_nearness_.assign(directions_.size(), 0);
    total.t = scene_.t0;
    total.x = start();
    if (!jumps_.start(total)) return total;
    for (;;) {
      eom::Result part = integrate(total, jumps_.segment_end(), options);
      part.statistics += total.statistics;
      total = std::move(part);
      if (total.outcome != eom::Outcome::done) return total;
      if (jumps_.is_last_segment()) break;
      if (!jumps_.cross_kink_in_time(total)) return total;
    }
    jumps_.end(total);
    return total;
  }

  std::vector<double> start() {
    std::vector<double> x = jumps_.equations().context.own_start();
    for (const Direction& d : directions_) {
      for (const double dx : d.dx) x.push_back(d.scale * dx);
    }
    return x;
  }

  // f(t, x + h s) and f(t, x, p + h dp, u + h du), each nearer until it is smooth.
  int differences(double t, const double* x, double* dx) {
    const std::vector<double> at(x, x + n_ * (directions_.size() + 1));
    SlipTurn turn(jumps_.equations(), t, at.data());
    std::fill(slopes_.begin(), slopes_.end(), 0.0);
    const std::vector<double> own(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(n_));
    for (std::size_t d = 0; d < directions_.size(); ++d) {
      const std::vector<double> s(at.begin() + static_cast<std::ptrdiff_t>((d + 1) * n_),
                                  at.begin() + static_cast<std::ptrdiff_t>((d + 2) * n_));
      Slips rates = turn.zero();
      for (const bool of_scene : {false, true}) {
        if (of_scene ? directions_[d].beside.empty() : largest_magnitude(s) == 0) continue;
        Difference found;
        int& nearness = (of_scene ? scene_nearness_ : state_nearness_)[d];
        for (double before = std::numeric_limits<double>::infinity();;) {
          const double h = of_scene
                               ? VariationalJumps::step_of(directions_[d], nearness) / directions_[d].scale
                               : std::ldexp(relative_difference * jumps_.scales().magnitude(own) / largest_magnitude(s),
                                            nearness * VariationalJumps::nearer);
          Difference next{std::vector<double>(n_), std::vector<double>(n_), turn.zero()};
          const int code = of_scene ? add_scenes(turn, t, own, d, h, next) : add_states(turn, t, own, s, h, next);
          if (code != 0) return code;
          const double change = next.change(rounding_of_values(next.largest), h);
          if (!(change < before) && !found.slope.empty()) {  // wider differences are better
            --nearness;
            break;
          }
          found = std::move(next);
          before = change;
          const double remainder = of_scene ? remainder_by_scene : remainder_by_state;
          if (change <= remainder * largest_magnitude(found.slope) || nearness + 1 == VariationalJumps::nearnesses)
            break;
          ++nearness;
        }
        for (std::size_t i = 0; i < n_; ++i) slopes_[d * n_ + i] += found.slope[i];
        for (std::size_t k = 0; k < rates.size(); ++k)
          for (std::size_t a = 0; a < 2; ++a) rates[k][a] += found.rates[k][a];
      }
      if (const int code = turn.add_turn(t, own.data(), rates, slopes_.data() + d * n_); code != 0) return code;
    }
    if (const int code = jumps_.equations().context.rhs(t, own.data(), f_.data()); code != 0) return code;
    std::copy(f_.begin(), f_.end(), dx);
    std::copy(slopes_.begin(), slopes_.end(), dx + n_);
    return 0;
  }

  /// Forces of contacts may balance larger ones that are applied.
  double rounding_of_values(double largest) {
    constexpr double rounding = 1e-14;
    const eom::contacts::ContactForces* const forces = jumps_.equations().context.model.contact_forces();
    return std::max(rounding * largest, forces != nullptr ? forces->acceleration_rounding() : 0);
  }

  int add_states(SlipTurn& turn, double t, const std::vector<double>& own, const std::vector<double>& s, double h,
                 Difference& sum) {
    std::vector<double> state(n_);
    for (const auto& [offset, weight] : order_four) {
      for (std::size_t i = 0; i < n_; ++i) state[i] = own[i] + offset * h * s[i];
      const Weights weights{weight, std::abs(offset) == 1 ? offset / 2 : 0};
      if (const int code = add_value(jumps_.equations(), turn, t, state, weights, h, sum); code != 0) return code;
    }
    return 0;
  }

  int add_scenes(SlipTurn& turn, double t, const std::vector<double>& own, std::size_t d, double h, Difference& sum) {
    const auto& beside = jumps_.neighbours(d, NeighbourInputs::of_same_times, scene_nearness_[d]);
    for (std::size_t k = 0; k < scene_weights.size() && k < beside.size(); ++k) {
      if (scene_weights[k].weight == 0) continue;
      VariationalEquations& in = jumps_.in_segment(*beside[k]);
      if (const int code = add_value(in, turn, t, own, scene_weights[k], h, sum); code != 0) return code;
    }
    return 0;
  }

  int add_value(VariationalEquations& in, SlipTurn& turn, double t, const std::vector<double>& state, const Weights& of,
                double h, Difference& sum) {
    turn.hold(in);
    if (const int code = turn.add_slips(in, t, state.data(), of.weight / h, sum.rates); code != 0) return code;
    std::vector<double> value(n_);
    if (const int code = in.context.rhs(t, state.data(), value.data()); code != 0) return code;
    for (std::size_t i = 0; i < n_; ++i) {
      sum.slope[i] += of.weight / h * value[i];
      sum.lower[i] += of.lower / h * value[i];
    }
    sum.largest = std::max(sum.largest, largest_magnitude(value));
    return 0;
  }

  int derivatives(double t, const double* x, const int* mode) {
    const eom::hybrid::Code& code = *jumps_.equations().problem.code;
    const double* p = scene_.parameters.data();
    if (const int bad = code.jac(t, x, p, u_.data(), mode, dfdx_.data(), dfdt_.data()); bad != 0) return bad;
    if (const int bad = code.jac_p(t, x, p, u_.data(), mode, dfdp_.data()); bad != 0) return bad;
    return code.jac_u == nullptr ? 0 : code.jac_u(t, x, p, u_.data(), mode, dfdu_.data());
  }

  /// slope += matrix v
  template <class Vector>
  void add(const std::vector<double>& matrix, std::size_t columns, double* slope, const Vector& v) const {
    for (std::size_t j = 0; j < columns; ++j) {
      const double by = v(j);
      if (by == 0) continue;
      for (std::size_t i = 0; i < n_; ++i) slope[i] += matrix[i + n_ * j] * by;
    }
  }

  eom::Result integrate(const eom::Result& from, double end, const eom::Options& options) {
    const auto surfaces = [&](double t, const double* x, double* g) {
      return jumps_.equations().context.events(t, x, g);
    };
    const auto cross = [&](const eom::EventPoint& point) {
      jumps_.settle_branch(point.crossing);
      return jumps_.cross_event(point) ? eom::EventAction::restart : eom::EventAction::resume;
    };
    const auto observe = [&](const eom::StepView& step) {
      jumps_.observe_state(step.t1, step.x1.data());
      return true;
    };
    return eom::integrate_events(solver_, eom::system_of(*this), from.t, from.x, end, options, surfaces,
                                 jumps_.watched_functions(), cross, observe);
  }

  const Scene& scene_;
  const std::string& solver_;
  const std::vector<Direction>& directions_;
  VariationalJumps jumps_;
  std::size_t n_;
  std::vector<double> u_, dfdx_, dfdt_, dfdp_, dfdu_, f_, slopes_;
  std::vector<int> state_nearness_, scene_nearness_;  // of the differences of each direction
};

VariationalRun::VariationalRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
                               const std::vector<Direction>& directions)
    : run_(std::make_unique<Run>(request, motion, solver, directions)) {}
VariationalRun::~VariationalRun() = default;

eom::Result VariationalRun::operator()(const eom::Options& options) { return run_->run(options); }
VariationalJumps& VariationalRun::jumps() { return run_->jumps(); }

}  // namespace eomgen::run
