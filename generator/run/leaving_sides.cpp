// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/leaving_sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "lists.hpp"
#include "run/directional_derivative.hpp"

namespace eomgen::run {
namespace {

constexpr std::size_t most_surfaces = 6;        // at one state: all combinations of their sides are tried
constexpr int shortest = -44, most_times = 38;  // powers of 2 of the span; number of the times

using Values = std::vector<double>;

class LeavingMotion {
 public:
  LeavingMotion(VariationalEquations& in, double t, Values x, double span)
      : in_(in), t_(t), x_(std::move(x)), span_(span), rounding_(roundings()) {}

  /// The kinks on whose surfaces the state lies.
  std::vector<std::size_t> surfaces() {
    const Values g = kinks(t_, x_);
    std::vector<std::size_t> on;
    for (std::size_t k = 0; k < g.size(); ++k)
      if (std::abs(g[k]) <= rounding_[k]) on.push_back(k);
    return on;
  }

  /// The sides of these kinks after short times, in the present branches; 0: the motion stays on the surface.
  std::vector<int> sides(const std::vector<std::size_t>& of) {
    std::vector<Values> rows;
    for (int k = 0; k < most_times; ++k) {
      const double h = std::ldexp(span_, shortest + k);
      const std::optional<Values> x = step(h);
      if (!x) break;
      rows.push_back(kinks(t_ + h, *x));
    }
    return mapped(of, [&](std::size_t kink) { return side(kink, rows); });
  }

  /// How long, and how far, a motion is on the other side of a surface than `side`; 0: of any.
  struct Excursion {
    double time = 0, depth = 0;
  };
  Excursion excursion(std::size_t kink, int side, const Values& rounding) {
    Excursion result;
    double before = 0, last = 0;
    for (int k = 0; k < most_times; ++k) {
      const double h = std::ldexp(span_, shortest + k);
      const std::optional<Values> x = step(h);
      const double g = x ? kinks(t_ + h, *x)[kink] : std::nan("");
      if (!std::isfinite(g)) break;
      if (std::abs(g) > beyond_rounding * rounding[kink] && (side == 0 || (g > 0) != (side > 0))) {
        result = {h, std::max(result.depth, std::abs(g))};
      } else if (last == result.time && last > 0) {
        result.time += (h - last) * std::abs(before) / (std::abs(before) + std::abs(g));
      }
      last = h;
      before = g;
    }
    return result;
  }

  /// The state after the longest of the times.
  Values end() { return step(std::ldexp(span_, shortest + most_times - 1)).value_or(Values(x_.size(), std::nan(""))); }

  const Values& rounding() const { return rounding_; }

 private:
  static constexpr double beyond_rounding = 16;

  Values kinks(double t, const Values& x) {
    Values g(in_.context.events.size());
    const std::size_t count = in_.problem.code->kinks.size();
    if (in_.context.events(t, x.data(), g.data()) != 0) return Values(count, std::nan(""));
    const auto first = g.begin() + static_cast<std::ptrdiff_t>(in_.context.events.first_kink());
    return {first, first + static_cast<std::ptrdiff_t>(count)};
  }

  /// Of the value of each kink: changes by a part of each component and of the time, times the rounding unit.
  Values roundings() {
    constexpr double part = 1e-8, units = 4;
    const Values middle = kinks(t_, x_);
    Values result(middle.size(), 0.0);
    const auto add = [&](const Values& beside) {
      for (std::size_t k = 0; k < middle.size(); ++k) {
        const double change = std::abs(beside[k] - middle[k]);
        if (std::isfinite(change)) result[k] += units * std::numeric_limits<double>::epsilon() * change / part;
      }
    };
    add(kinks(t_ * (1 + part), x_));
    for (std::size_t i = 0; i < x_.size(); ++i) {
      Values beside = x_;
      beside[i] *= 1 + part;
      add(kinks(t_, beside));
    }
    return result;
  }

  /// One step of the classical method of order 4.
  std::optional<Values> step(double h) {
    const std::size_t n = x_.size();
    Values sum(n, 0.0), k(n, 0.0), at(n);
    for (const auto& [place, weight] : {std::pair{0.0, 1.0}, {0.5, 2.0}, {0.5, 2.0}, {1.0, 1.0}}) {
      for (std::size_t i = 0; i < n; ++i) at[i] = x_[i] + place * h * k[i];
      if (in_.context.rhs(t_ + place * h, at.data(), k.data()) != 0) return std::nullopt;
      for (std::size_t i = 0; i < n; ++i) sum[i] += weight / 6 * k[i];
    }
    for (std::size_t i = 0; i < n; ++i) at[i] = x_[i] + h * sum[i];
    return at;
  }

  /// The sign of the first values that grow as a power of the time.
  int side(std::size_t kink, const std::vector<Values>& rows) const {
    constexpr double slowest = 1.8, fastest = 20;  // per doubling of the time: powers 1 to 4
    constexpr int several = 4;
    int growing = 0;
    for (std::size_t j = 1; j < rows.size(); ++j) {
      const double before = rows[j - 1][kink], here = rows[j][kink], ratio = here / before;
      const bool grows = std::abs(before) > beyond_rounding * rounding_[kink] && ratio > slowest && ratio < fastest;
      growing = grows ? growing + 1 : 0;
      if (growing == several) return here > 0 ? 1 : -1;
    }
    return 0;
  }

  VariationalEquations& in_;
  double t_;
  Values x_;
  double span_;
  Values rounding_;
};

/// The largest change of the value of a kink by the components of a change, in its scene: the scale of their sum.
double scale_of_change(VariationalEquations& in, std::size_t kink, double t, const Values& x, const StateBeside& to) {
  const auto value = [&](VariationalEquations& of, double at, const Values& state) {
    Values g(of.context.events.size());
    const int code = of.context.events(at, state.data(), g.data());
    return code == 0 ? g[of.context.events.first_kink() + kink] : std::nan("");
  };
  const double here = value(in, t, x);
  double largest = std::max(std::abs(value(*to.in, t, x) - here), std::abs(value(in, to.t, x) - here));
  for (std::size_t i = 0; i < x.size(); ++i) {
    Values moved = x;
    moved[i] = to.x[i];
    largest = std::max(largest, std::abs(value(in, t, moved) - here));
  }
  return largest;
}

double distance(const Values& a, const Values& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Whether f differs between the sides of a kink.
bool is_jump(VariationalEquations& in, std::size_t kink, double t, const Values& x) {
  eom::hybrid::Model& model = in.context.model;
  const eom::ModeArray mode = model.mode();
  Values above(in.problem.states()), below = above;
  model.set_kink(kink, 1);
  const bool known = in.context.rhs(t, x.data(), above.data()) == 0;
  model.set_kink(kink, -1);
  const bool both = in.context.rhs(t, x.data(), below.data()) == 0 && known;
  model.set_mode(mode);
  return !both || has_jump(above, below);
}

}  // namespace

bool has_jump(const std::vector<double>& before, const std::vector<double>& after) {
  constexpr double rounding = 1e-10;  // of f
  return distance(before, after) > rounding * largest_magnitude(before);
}

bool differs_beside(VariationalEquations& in, std::size_t kink, double t, const std::vector<double>& x, double span,
                    const std::vector<StateBeside>& beside) {
  constexpr double zero = 1e-6;  // of the components of a change that cancel
  const int side = in.context.model.mode().kink(kink);
  const bool jump = is_jump(in, kink, t, x);
  if (side != 0 && !jump) return false;
  const Values rounding = LeavingMotion(in, t, x, span).rounding();
  const auto motion = [&](std::size_t k) { return LeavingMotion(*beside[k].in, beside[k].t, beside[k].x, span); };
  const auto excursion = [&](std::size_t k) { return motion(k).excursion(kink, side, rounding); };
  for (std::size_t of = 0; of < 2; ++of) {
    // At the distances h/4 and h/8. A change that stays on the surface leaves it by its square.
    const std::size_t near = beside.size() - 2 + of, far = near - 2;
    const auto [time, depth] = excursion(near);
    if (!(depth > zero * scale_of_change(in, kink, t, x, beside[near]))) continue;
    if (side != 0) {
      const double longest = std::ldexp(span, shortest + most_times - 1), farther = excursion(far).time;
      const double part =
          time / farther;  // 0.25, if it is the square; 0.5; or 0.7, if the motion leaves it by a square
      if (farther >= longest || (part < 0.85 && part > 0.35)) return true;
      continue;
    }
    if (jump) return true;
    // Half the distance halves the difference of the sides, or quarters it.
    const auto difference = [&](std::size_t k) {
      eom::hybrid::Model& model = beside[k].in->context.model;
      const int kept = model.mode().kink(kink);
      model.set_kink(kink, 1);
      const Values above = motion(k).end();
      model.set_kink(kink, -1);
      const Values below = motion(k).end();
      model.set_kink(kink, kept);
      return distance(above, below);
    };
    const double wide = difference(far), narrow = difference(near);
    if (narrow > zero * distance(x, beside[near].x) && narrow > 0.35 * wide) return true;
  }
  return false;
}

std::vector<std::size_t> leave_surfaces(VariationalEquations& in, double t, const std::vector<double>& x, double span) {
  if (!in.context.kinks.any()) return {};
  LeavingMotion motion(in, t, x, span);
  const std::vector<std::size_t> on = motion.surfaces();
  eom::hybrid::Model& model = in.context.model;
  for (const std::size_t k : on) model.set_kink(k, 0);
  if (on.empty() || on.size() > most_surfaces) return on;
  std::optional<std::vector<int>> found;
  bool is_unique = true;
  for (std::size_t set = 0; set < std::size_t{1} << on.size(); ++set) {
    const auto tried = [&](std::size_t j) { return (set >> j & 1U) != 0 ? -1 : 1; };
    for (std::size_t j = 0; j < on.size(); ++j) model.set_kink(on[j], tried(j));
    const std::vector<int> sides = motion.sides(on);
    bool is_consistent = true;
    for (std::size_t j = 0; j < on.size(); ++j)
      is_consistent = is_consistent && (sides[j] == 0 || sides[j] == tried(j));
    if (!is_consistent) continue;
    is_unique = is_unique && (!found || *found == sides);
    found = sides;
  }
  for (std::size_t j = 0; j < on.size(); ++j) model.set_kink(on[j], found && is_unique ? (*found)[j] : 0);
  return on;
}

}  // namespace eomgen::run
