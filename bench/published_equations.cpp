// SPDX-License-Identifier: GPL-3.0-or-later
#include "published_equations.hpp"

#include <quadmath.h>

#include "published_parts.hpp"

namespace published {
namespace {

// Kepler: by Kepler's equation, from the perihelion.
Problem kepler(const std::string& scene, const std::string& eccentricity, const std::string& t1,
               const std::string& literature) {
  Problem problem{
      "kepler_eccentric", scene, literature, {{"GM", "1"}, {"a", "1"}, {"e", eccentricity}}, {}, {}, {}, {}, t1, {}};
  if (t1 == "20")
    problem.values = {{"x", "-1.295266250987574"},
                      {"y", "0.4003938963792321"},
                      {"x_dot", "-0.6775390924707566"},
                      {"y_dot", "-0.1270838154278686"}};
  problem.start = [](const Values& p) {
    const Quad e = at(p, "e");
    return Values{{"x", 1 - e}, {"y", 0}, {"x_dot", 0}, {"y_dot", sqrtq((1 + e) / (1 - e))}};
  };
  problem.closed_form = [](const Values& p, const Values& start, Quad t) {
    const Quad GM = at(p, "GM"), r = at(start, "x"), v = at(start, "y_dot");
    const Quad a = 1 / (2 / r - v * v / GM), e = 1 - r / a, n = sqrtq(GM / (a * a * a));
    const Quad turns = roundq(n * t / (2 * M_PIq)), mean = n * t - 2 * M_PIq * turns;
    Quad low = mean - e, high = mean + e, E = mean;  // Newton's method with bounds
    for (int i = 0; i < 300; ++i) {
      const Quad f = E - e * sinq(E) - mean;
      (f > 0 ? high : low) = E;
      Quad next = E - f / (1 - e * cosq(E));
      if (!(next > low && next < high)) next = (low + high) / 2;
      if (next == E) break;
      E = next;
    }
    const Quad rate = n / (1 - e * cosq(E)), minor = a * sqrtq(1 - e * e);
    return Values{{"x", a * (cosq(E) - e)},
                  {"y", minor * sinq(E)},
                  {"x_dot", -a * sinq(E) * rate},
                  {"y_dot", minor * cosq(E) * rate}};
  };
  return problem;
}

// Heavy top: Euler's equations about the fixed point, in body axes, and the attitude as a quaternion.
void top_rhs(const Values& p, Quad, const State& x, State& dx) {
  const Quad w1 = x[4], w2 = x[5], w3 = x[6], X = at(p, "X"), mgX = at(p, "m") * at(p, "g") * X;
  const Quad A = at(p, "J1") + at(p, "m") * X * X, B = at(p, "J2");
  dx[0] = (-x[1] * w1 - x[2] * w2 - x[3] * w3) / 2;
  dx[1] = (x[0] * w1 + x[2] * w3 - x[3] * w2) / 2;
  dx[2] = (x[0] * w2 + x[3] * w1 - x[1] * w3) / 2;
  dx[3] = (x[0] * w3 + x[1] * w2 - x[2] * w1) / 2;
  // E3 along the body's axes; the moment of gravity is X e2 x (-m g E3).
  const Quad up1 = 2 * (x[1] * x[3] - x[0] * x[2]), up3 = x[0] * x[0] - x[1] * x[1] - x[2] * x[2] + x[3] * x[3];
  dx[4] = ((B - A) * w2 * w3 - mgX * up3) / A;
  dx[5] = 0;
  dx[6] = ((A - B) * w1 * w2 + mgX * up1) / A;
}
Problem heavy_top() {
  Problem problem{"heavy_top",
                  "default",
                  "nothing; no digits are published",
                  {{"m", "15"}, {"g", "9.81"}, {"X", "1"}, {"J1", "0.234375"}, {"J2", "0.46875"}},
                  {},
                  {},
                  top_rhs,
                  {},
                  "2",
                  {}};
  problem.start = [](const Values&) {
    return Values{{"e0", 1},     {"e1", 0},     {"e2", 0},      {"e3", 0},
                  {"e0_dot", 0}, {"e1_dot", 0}, {"e2_dot", 75}, {"e3_dot", number("-2.30769")}};
  };
  problem.begin = [](const Values&, const Values& s) {  // e = (1, 0, 0, 0)
    return State{at(s, "e0"),         at(s, "e1"),         at(s, "e2"),        at(s, "e3"),
                 2 * at(s, "e1_dot"), 2 * at(s, "e2_dot"), 2 * at(s, "e3_dot")};
  };
  problem.end = [](const Values& p, const State& x) {
    State dx(7);
    top_rhs(p, 0, x, dx);
    Values result;
    for (std::size_t i = 0; i < 4; ++i) {
      result["e" + std::to_string(i)] = x[i];
      result["e" + std::to_string(i) + "_dot"] = dx[i];
    }
    return result;
  };
  return problem;
}

// Elastic pendulum: Cartesian, by Newton; x is along gravity.
Problem elastic(const std::string& scene, const std::string& k) {
  Problem problem{"elastic_pendulum_smooth",
                  scene,
                  "nothing; no digits are published",
                  {{"m", "1"}, {"g", "9.81"}, {"L", "1"}, {"k", k}},
                  {},
                  {},
                  {},
                  {},
                  "2",
                  {}};
  problem.start = [](const Values& p) {
    const Quad g = at(p, "g"), c = 1 / at(p, "k"), C = cosq(1), S2 = sinq(1) * sinq(1);
    const Quad s = c * g * C - 3 * c * c * g * g * S2 - 9 * c * c * c * g * g * g * S2 * C -
                   27 * c * c * c * c * g * g * g * g * S2 * (2 - C * C) -
                   81 * c * c * c * c * c * g * g * g * g * g * S2 * C * (16 - 15 * C * C);
    return Values{{"s", s}, {"theta", 1}, {"s_dot", 0}, {"theta_dot", 0}};
  };
  problem.begin = [](const Values& p, const Values& s) {
    const Quad r = at(p, "L") + at(s, "s"), r1 = at(s, "s_dot"), a = at(s, "theta"), a1 = at(s, "theta_dot");
    return State{r * cosq(a), r * sinq(a), r1 * cosq(a) - r * a1 * sinq(a), r1 * sinq(a) + r * a1 * cosq(a)};
  };
  problem.rhs = [](const Values& p, Quad, const State& x, State& dx) {
    const Quad r = sqrtq(x[0] * x[0] + x[1] * x[1]), pull = at(p, "k") / at(p, "m") * (r - at(p, "L")) / r;
    dx = {x[2], x[3], at(p, "g") - pull * x[0], -pull * x[1]};
  };
  problem.end = [](const Values& p, const State& x) {
    const Quad r = sqrtq(x[0] * x[0] + x[1] * x[1]);
    return Values{{"s", r - at(p, "L")},
                  {"theta", atan2q(x[1], x[0])},
                  {"s_dot", (x[0] * x[2] + x[1] * x[3]) / r},
                  {"theta_dot", (x[0] * x[3] - x[1] * x[2]) / (r * r)}};
  };
  return problem;
}

// The pendulum and the N-four-bar mechanism: one angle each.
Problem pendulum() {
  Problem problem{"iftomm_pendulum",
                  "default",
                  "nothing; the closed form is in the test",
                  {{"g", "9.81"}, {"L", "1"}},
                  {},
                  {},
                  {},
                  {},
                  "10",
                  {}};
  problem.start = [](const Values&) { return Values{{"x", -1}, {"y", 0}, {"x_dot", 0}, {"y_dot", 0}}; };
  problem.begin = [](const Values&, const Values& s) {
    return State{atan2q(at(s, "x"), -at(s, "y")), 0};
  };  // from rest
  problem.rhs = [](const Values& p, Quad, const State& x, State& dx) {
    dx = {x[1], -at(p, "g") / at(p, "L") * sinq(x[0])};
  };
  problem.end = [](const Values& p, const State& x) {
    const Quad L = at(p, "L");
    return Values{{"x", L * sinq(x[0])},
                  {"y", -L * cosq(x[0])},
                  {"x_dot", L * x[1] * cosq(x[0])},
                  {"y_dot", L * x[1] * sinq(x[0])}};
  };
  return problem;
}

/// All cranks move alike and couplers remain level: (N/3 + 1/3 + N) L a'' = (N/2 + 1/2 + N) g sin(a).
Problem four_bars(int windows, const std::string& t1, bool beyond) {
  Problem problem{"n_four_bar_" + std::to_string(windows),
                  "default",
                  "nothing",
                  {{"g", "9.81"}, {"L", "1"}},
                  {},
                  {},
                  {},
                  {},
                  t1,
                  {}};
  problem.start_is_binary64 = true;
  problem.by_hand_alone = beyond;
  const auto all = [windows](Quad a, Quad a1) {
    Values values;
    for (int i = 0; i <= windows; ++i) {
      values["a" + std::to_string(i)] = a;
      values["a" + std::to_string(i) + "_dot"] = a1;
      if (i > 0) values["b" + std::to_string(i)] = values["b" + std::to_string(i) + "_dot"] = 0;
    }
    return values;
  };
  problem.start = [all](const Values&) { return all(0, -1); };
  problem.begin = [](const Values&, const Values& s) { return State{at(s, "a0"), at(s, "a0_dot")}; };
  problem.rhs = [N = static_cast<Quad>(windows)](const Values& p, Quad, const State& x, State& dx) {
    dx = {x[1], (3 * N + 1) / 2 / ((4 * N + 1) / 3) * at(p, "g") / at(p, "L") * sinq(x[0])};
  };
  problem.end = [all](const Values&, const State& x) { return all(x[0], x[1]); };
  return problem;
}

}  // namespace

const std::vector<Problem>& problems() {
  static const std::vector<Problem> list{
      kepler("default", "0.9", "2 pi", "the start, after one period"),
      kepler("e99", "0.99", "2 pi", "the start, after one period"),
      kepler("detest_d5", "0.9", "20", "Kepler's equation; published in DETEST, problem D5"),
      heavy_top(),
      andrews(),
      car_axis(),
      pendulum(),
      four_bars(2, "1", false),
      four_bars(2, "10", true),
      four_bars(40, "10", true),
      elastic("k4", "1e4"),
      elastic("k6", "1e6"),
      elastic("k8", "1e8"),
      elastic("default", "1e10"),
      elastic("k12", "1e12")};
  return list;
}

}  // namespace published
