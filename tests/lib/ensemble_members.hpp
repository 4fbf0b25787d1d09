// Members of an ensemble for tests: many states by the functions of one state, starts, ends and statistics. In:
// nothing. Out: right-hand sides in the form that integrate_ensemble() expects, comparisons.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "eom/ensemble/integrate.hpp"
#include "lib/series_problems.hpp"

namespace members {

/// function(s, x, p) -> code for every state s, with its entries one after the other; the first code that is not 0.
template <std::size_t entries, std::size_t own, class Function>
int each(std::size_t count, std::size_t stride, const double* x, const double* p, int* codes,
         const Function& function) {
  int first = 0;
  for (std::size_t s = 0; s < count; ++s) {
    double at[entries], with[own + 1];
    for (std::size_t i = 0; i < entries; ++i) at[i] = x[i * stride + s];
    for (std::size_t i = 0; i < own; ++i) with[i] = p[i * stride + s];
    codes[s] = function(s, at, with);
    if (first == 0) first = codes[s];
  }
  return first;
}

/// Stores the results of a function of one state at the position of state s.
inline void put(const double* from, std::size_t entries, std::size_t s, std::size_t stride, double* to) {
  for (std::size_t i = 0; i < entries; ++i) to[i * stride + s] = from[i];
}

constexpr std::size_t states = 4, parameters = 2;

/// Kepler's problem with its own mass and centre per member. Further parameters cause codes and values that are not
/// finite.
inline int slopes(double t, const double* x, const double* p, double* dx) {
  if (p[1] == 2 && t > 1.5) return 1;  // a region that no step skips
  if (p[1] == 3 && x[0] < 0.5) return 3;
  const double r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * std::sqrt(r2);
  dx[0] = x[2];
  dx[1] = x[3];
  dx[2] = -p[0] * x[0] / r3;
  dx[3] = -p[0] * x[1] / r3;
  if (p[1] == 4) dx[3] = std::sqrt(1 - t);
  if (p[1] == 5) dx[0] = x[0] * x[0] * 20;
  return 0;
}

/// Their derivatives, of the first m components, by columns.
inline int jacobian(double t, const double* x, const double* p, std::size_t m, double* dfdx, double* dfdt) {
  if (p[1] == 3 && x[0] < 0.4) return 2;
  const double r2 = x[0] * x[0] + x[1] * x[1], r3 = r2 * std::sqrt(r2), r5 = r2 * r3;
  double all[states][states] = {{0, 0, 1, 0}, {0, 0, 0, 1}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) all[2 + i][j] = p[0] * (3 * x[i] * x[j] / r5 - (i == j ? 1 / r3 : 0));
  }
  if (p[1] == 4) all[3][0] = all[3][1] = 0;
  if (p[1] == 5) all[0][0] = x[0] * 40, all[0][2] = 0;
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t i = 0; i < m; ++i) dfdx[i + m * j] = all[i][j];
    dfdt[j] = j == 3 && p[1] == 4 ? -0.5 / std::sqrt(1 - t) : 0;
  }
  return 0;
}

/// Crossings of the axis, of a line that some members never reach, and of a speed, twice in a step here and there.
inline int event_functions(const double* x, const double* p, double* values) {
  values[0] = x[1];
  values[1] = x[0] + 0.2 * p[0];
  values[2] = x[2] * x[2] + x[3] * x[3] - 0.9;
  return p[1] == 3 ? 4 : 0;
}

/// The right-hand side of the members, also of a single one.
struct Plain {
  struct One {
    const double* p;
    int operator()(double t, const double* x, double* dx) const { return slopes(t, x, p, dx); }
    int events(double, const double* x, double* values) const { return event_functions(x, p, values); }
  };
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return each<states, parameters>(count, stride, x, p, codes,
                                    [&](std::size_t s, const double* at, const double* own) {
                                      double result[states];
                                      const int code = slopes(t[s], at, own, result);
                                      if (code == 0) put(result, states, s, stride, dx);
                                      return code;
                                    });
  }
  One member_rhs(std::size_t, const double* p) const { return {p}; }
};

/// With Jacobians; m components are not quadratures.
struct WithJacobians : Plain {
  explicit WithJacobians(std::size_t components = states) : m(components) {}
  std::size_t m;
  struct One : Plain::One {
    std::size_t m;
    int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
      return members::jacobian(t, x, p, m, dfdx, dfdt);
    }
  };
  int jacobian(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dfdx,
               double* dfdt, int* codes) const {
    return each<states, parameters>(count, stride, x, p, codes,
                                    [&](std::size_t s, const double* at, const double* own) {
                                      double result[states * states], by_t[states];
                                      const int code = members::jacobian(t[s], at, own, m, result, by_t);
                                      if (code != 0) return code;
                                      put(result, m * m, s, stride, dfdx);
                                      put(by_t, m, s, stride, dfdt);
                                      return 0;
                                    });
  }
  One member_rhs(std::size_t, const double* p) const { return {{p}, m}; }
};

/// Kepler's problem with its series; a region without a value, a region that no step skips, and a jump of the slopes at
/// t = 1.5 that no series detects.
struct WithSeries {
  struct One {
    const double* p;
    int operator()(double t, const double* x, double* dx) const {
      problems::KeplerSeries()(t, x, dx);
      return finish(t, x, dx);
    }
    int taylor(double t, const double* x, int order, double* c) const {
      problems::KeplerSeries().taylor(t, x, order, c);
      return order > 0 ? finish(t, x, c + states) : 0;
    }
    int finish(double t, const double* x, double* dx) const {
      if (p[1] == 2 && t > 1.5) return 1;
      if (p[1] == 3 && x[0] < 0.5) return 3;
      if (p[1] == 4 && t > 1.5) dx[3] += 0.1;
      return 0;
    }
    int events(double, const double* x, double* values) const { return event_functions(x, p, values); }
    int taylor_order() const { return 22; }  // less than some members need
    std::size_t taylor_states() const { return states; }
  };
  int operator()(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p, double* dx,
                 int* codes) const {
    return each<states, parameters>(count, stride, x, p, codes,
                                    [&](std::size_t s, const double* at, const double* own) {
                                      double result[states];
                                      const int code = One{own}(t[s], at, result);
                                      put(result, states, s, stride, dx);
                                      return code;
                                    });
  }
  int taylor(std::size_t count, std::size_t stride, const double* t, const double* x, const double* p,
             const int* orders, double* c, int* codes) const {
    return each<states, parameters>(count, stride, x, p, codes,
                                    [&](std::size_t s, const double* at, const double* own) {
                                      double series[states * (problems::hand_order + 1)];
                                      const int code = One{own}.taylor(t[s], at, orders[s], series);
                                      put(series, states * (static_cast<std::size_t>(orders[s]) + 1), s, stride, c);
                                      return code;
                                    });
  }
  int taylor_order() const { return One{}.taylor_order(); }
  One member_rhs(std::size_t, const double* p) const { return {p}; }
};

/// Ellipses of many shapes, circles of many sizes, some that fail, some with equal start and end, in both directions of
/// time.
inline void start_of(std::size_t member, eom::EnsembleStart& start) {
  const double e = 0.1 + 0.03 * static_cast<double>(member % 23);
  start.x[0] = 1 - e;
  start.x[1] = 0;
  start.x[2] = 0;
  start.x[3] = std::sqrt((1 + e) / (1 - e));
  start.p[0] = 1 + 0.1 * static_cast<double>(member % 7);
  start.p[1] = member % 11 < 6 ? 0 : static_cast<double>(member % 11 - 5);
  start.t0 = 0.25 * static_cast<double>(member % 3);
  start.t1 = member % 13 == 12 ? start.t0 : (member % 5 == 4 ? -1 : 1) * (2 + static_cast<double>(member % 17));
}

/// The start of one member.
struct Member {
  problems::State x, p;
  eom::EnsembleStart start;
  explicit Member(std::size_t member) : x(states), p(parameters), start{0, 0, x, p} { start_of(member, start); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;
};

struct End {
  eom::Outcome outcome = eom::Outcome::interrupted;
  double t = 0;
  problems::State x;
  eom::Statistics statistics;
  int times = 0;

  void take(const eom::EnsembleEnd& end) {
    outcome = end.outcome;
    t = end.t;
    x.assign(end.x.begin(), end.x.end());
    statistics = end.statistics;
    ++times;
  }
};

template <class Rhs>
std::vector<End> ends_of(const char* method, const Rhs& rhs, std::size_t count, const eom::EnsembleOptions& options) {
  std::vector<End> ends(count);
  eom::integrate_ensemble(method, rhs, count, states, parameters, options, start_of,
                          [&](const eom::EnsembleEnd& end) { ends[end.member].take(end); });
  return ends;
}

/// Bitwise comparison.
inline void check_same(const End& end, const eom::Result& alone) {
  CHECK(end.times == 1);
  CHECK(end.outcome == alone.outcome);
  CHECK(end.t == alone.t);
  CHECK(end.x == alone.x);
  CHECK(end.statistics.steps == alone.statistics.steps);
  CHECK(end.statistics.rejected == alone.statistics.rejected);
  CHECK(end.statistics.rhs_evaluations == alone.statistics.rhs_evaluations);
  CHECK(end.statistics.jacobians == alone.statistics.jacobians);
  CHECK(end.statistics.factorisations == alone.statistics.factorisations);
  CHECK(end.statistics.dense_fallbacks == alone.statistics.dense_fallbacks);
}

/// Compares every member with its single run. Returns the number of rejected steps.
template <class Rhs>
std::size_t check_as_alone(const char* method, const Rhs& rhs, const eom::EnsembleOptions& options, std::size_t count) {
  const std::vector<End> ends = ends_of(method, rhs, count, options);
  std::size_t rejected = 0;
  for (std::size_t i = 0; i < count; ++i) {
    CAPTURE(std::string(method));
    CAPTURE(i);
    Member member(i);
    auto one = rhs.member_rhs(i, member.p.data());
    const eom::Result alone =
        eom::integrate(method, one, member.start.t0, member.x, member.start.t1, eom::ensemble::options_of(options));
    check_same(ends[i], alone);
    rejected += alone.statistics.rejected;
  }
  return rejected;
}

}  // namespace members
