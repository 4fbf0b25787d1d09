// SPDX-License-Identifier: GPL-3.0-or-later
// The problems of the Test Set for IVP Solvers: equations with constraints, solved for accelerations and multipliers.
#include <quadmath.h>

#include <array>
#include <initializer_list>
#include <utility>

#include "published_parts.hpp"

namespace published {
namespace {

/// The solution of A x = b, n rows, A by rows; b is overwritten. Gaussian elimination with the largest pivot of each
/// column.
void solve(std::vector<Quad>& A, std::vector<Quad>& b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (fabsq(A[i * n + k]) > fabsq(A[pivot * n + k])) pivot = i;
    }
    for (std::size_t j = 0; j < n; ++j) std::swap(A[k * n + j], A[pivot * n + j]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Quad factor = A[i * n + k] / A[k * n + k];
      for (std::size_t j = k; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= A[k * n + j] * b[j];
    b[k] /= A[k * n + k];
  }
}

/// States whose first half are coordinates and whose second half are their rates, by name.
struct Named {
  std::vector<std::string> coordinates;
  State state(const Values& values) const {
    State x;
    for (const std::string& name : coordinates) x.push_back(at(values, name));
    for (const std::string& name : coordinates) x.push_back(at(values, name + "_dot"));
    return x;
  }
  Values values(const State& x) const {
    Values result;
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      result[coordinates[i]] = x[i];
      result[coordinates[i] + "_dot"] = x[coordinates.size() + i];
    }
    return result;
  }
};

// Andrews' mechanism: mass matrix, forces and constraints of the test set.
const Named andrews_names{{"beta", "theta", "gamma", "phi", "delta", "Omega", "epsilon"}};

void andrews_rhs(const Values& v, Quad, const State& x, State& dx) {
  const auto p = [&v](const char* name) { return at(v, name); };
  const Quad be = x[0], th = x[1], ga = x[2], ph = x[3], de = x[4], om = x[5], ep = x[6];
  const Quad bep = x[7], thp = x[8], gap = x[9], php = x[10], dep = x[11], omp = x[12], epp = x[13];
  const Quad rr = p("rr"), d = p("d"), da = p("da"), ss = p("ss"), e = p("e"), ea = p("ea"), zt = p("zt"), zf = p("zf"),
             fa = p("fa"), u = p("u");
  const Quad m2 = p("m2"), m4 = p("m4"), m6 = p("m6"), e4 = e - ea, f6 = zf - fa;
  constexpr std::size_t n = 13;
  std::vector<Quad> A(n * n, 0), b(n, 0);
  const auto set = [&A](std::size_t i, std::size_t j, Quad value) { A[i * n + j] = A[j * n + i] = value; };
  set(0, 0, p("m1") * p("ra") * p("ra") + m2 * (rr * rr - 2 * da * rr * cosq(th) + da * da) + p("I1") + p("I2"));
  set(0, 1, m2 * (da * da - da * rr * cosq(th)) + p("I2"));
  set(1, 1, m2 * da * da + p("I2"));
  set(2, 2, p("m3") * (p("sa") * p("sa") + p("sb") * p("sb")) + p("I3"));
  set(3, 3, m4 * e4 * e4 + p("I4"));
  set(3, 4, m4 * (e4 * e4 + zt * e4 * sinq(ph)) + p("I4"));
  set(4, 4,
      m4 * (zt * zt + 2 * zt * e4 * sinq(ph) + e4 * e4) + p("m5") * (p("ta") * p("ta") + p("tb") * p("tb")) + p("I4") +
          p("I5"));
  set(5, 5, m6 * f6 * f6 + p("I6"));
  set(5, 6, m6 * (f6 * f6 - u * f6 * sinq(om)) + p("I6"));
  set(6, 6,
      m6 * (f6 * f6 - 2 * u * f6 * sinq(om) + u * u) + p("m7") * (p("ua") * p("ua") + p("ub") * p("ub")) + p("I6") +
          p("I7"));
  const Quad X = p("sd") * cosq(ga) + p("sc") * sinq(ga) + p("xb") - p("xc"),
             Y = p("sd") * sinq(ga) - p("sc") * cosq(ga) + p("yb") - p("yc");
  const Quad length = sqrtq(X * X + Y * Y), pull = -p("c0") * (length - p("l0")) / length;
  b[0] = p("mom") - m2 * da * rr * thp * (thp + 2 * bep) * sinq(th);
  b[1] = m2 * da * rr * bep * bep * sinq(th);
  b[2] = pull * (X * (p("sc") * cosq(ga) - p("sd") * sinq(ga)) + Y * (p("sd") * cosq(ga) + p("sc") * sinq(ga)));
  b[3] = m4 * zt * e4 * dep * dep * cosq(ph);
  b[4] = -m4 * zt * e4 * php * (php + 2 * dep) * cosq(ph);
  b[5] = -m6 * u * f6 * epp * epp * cosq(om);
  b[6] = m6 * u * f6 * omp * (omp + 2 * epp) * cosq(om);
  // Each loop is a sum of terms r cos(angle) along x and r sin(angle) along y; an angle is a sum of coordinates.
  const auto add = [&](std::size_t loop, Quad r, Quad angle, Quad rate, std::initializer_list<std::size_t> of) {
    for (const std::size_t i : of) {
      set(7 + 2 * loop, i, A[(7 + 2 * loop) * n + i] - r * sinq(angle));
      set(8 + 2 * loop, i, A[(8 + 2 * loop) * n + i] + r * cosq(angle));
    }
    b[7 + 2 * loop] += r * cosq(angle) * rate * rate;
    b[8 + 2 * loop] += r * sinq(angle) * rate * rate;
  };
  for (const std::size_t loop : {0, 1, 2}) {
    add(loop, rr, be, bep, {0});
    add(loop, -d, be + th, bep + thp, {0, 1});
  }
  const Quad right = M_PI_2q;  // sin(a) is cos(a - pi/2), -cos(a) is sin(a - pi/2)
  add(0, -ss, ga - right, gap, {2});
  add(1, -e, ph + de - right, php + dep, {3, 4});
  add(1, -zt, de, dep, {4});
  add(2, -zf, om + ep, omp + epp, {5, 6});
  add(2, -u, ep - right, epp, {6});
  solve(A, b);
  for (std::size_t i = 0; i < 7; ++i) {
    dx[i] = x[7 + i];
    dx[7 + i] = b[i];
  }
}

// Car axis: the test set's equations with the constraints differentiated twice.
const Named car_names{{"xl", "yl", "xr", "yr"}};

void car_rhs(const Values& p, Quad t, const State& x, State& dx) {
  const Quad L = at(p, "L"), L0 = at(p, "L0"), r = at(p, "r"), w = at(p, "w"), stiffness = at(p, "k"),
             mass = at(p, "M") / 2;
  const Quad yb = r * sinq(w * t), yb1 = r * w * cosq(w * t), yb2 = -w * w * yb;
  const Quad xb = sqrtq(L * L - yb * yb), xb1 = -yb * yb1 / xb, xb2 = -(xb1 * xb1 + yb1 * yb1 + yb * yb2) / xb;
  const Quad xl = x[0], yl = x[1], xr = x[2], yr = x[3], a = xl - xr, c = yl - yr, a1 = x[4] - x[6], c1 = x[5] - x[7];
  const Quad left = sqrtq(xl * xl + yl * yl), right = sqrtq((xr - xb) * (xr - xb) + (yr - yb) * (yr - yb));
  std::vector<Quad> A(36, 0);
  std::vector<Quad> b{stiffness * (L0 - left) * xl / left,
                      stiffness * (L0 - left) * yl / left - mass * at(p, "g"),
                      stiffness * (L0 - right) * (xr - xb) / right,
                      stiffness * (L0 - right) * (yr - yb) / right - mass * at(p, "g"),
                      -(xb2 * xl + yb2 * yl + 2 * (xb1 * x[4] + yb1 * x[5])),
                      -2 * (a1 * a1 + c1 * c1)};
  for (std::size_t i = 0; i < 4; ++i) A[i * 6 + i] = mass;
  const std::array<std::array<Quad, 4>, 2> G{{{xb, yb, 0, 0}, {2 * a, 2 * c, -2 * a, -2 * c}}};
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < 4; ++i) A[i * 6 + 4 + k] = A[(4 + k) * 6 + i] = G[k][i];
  }
  solve(A, b);
  for (std::size_t i = 0; i < 4; ++i) {
    dx[i] = x[4 + i];
    dx[4 + i] = b[i];
  }
}

}  // namespace

Problem andrews() {
  Problem problem{"andrews_squeezer",
                  "default",
                  "Test Set for IVP Solvers, problem andrews",
                  {{"m1", "0.04325"},  {"m2", "0.00365"},  {"m3", "0.02373"},  {"m4", "0.00706"},  {"m5", "0.07050"},
                   {"m6", "0.00706"},  {"m7", "0.05498"},  {"xb", "-0.03635"}, {"yb", "0.03273"},  {"xc", "0.014"},
                   {"yc", "0.072"},    {"c0", "4530"},     {"I1", "2.194e-6"}, {"I2", "4.410e-7"}, {"I3", "5.255e-6"},
                   {"I4", "5.667e-7"}, {"I5", "1.169e-5"}, {"I6", "5.667e-7"}, {"I7", "1.912e-5"}, {"d", "28e-3"},
                   {"da", "115e-4"},   {"e", "2e-2"},      {"ea", "1421e-5"},  {"rr", "7e-3"},     {"ra", "92e-5"},
                   {"l0", "7785e-5"},  {"ss", "35e-3"},    {"sa", "1874e-5"},  {"sb", "1043e-5"},  {"sc", "18e-3"},
                   {"sd", "2e-2"},     {"ta", "2308e-5"},  {"tb", "916e-5"},   {"u", "4e-2"},      {"ua", "1228e-5"},
                   {"ub", "449e-5"},   {"zf", "2e-2"},     {"zt", "4e-2"},     {"fa", "1421e-5"},  {"mom", "33e-3"}},
                  {},
                  {},
                  andrews_rhs,
                  {},
                  "0.03",
                  {{"beta", "15.81077119629904"},
                   {"theta", "-15.75637105984298"},
                   {"gamma", "0.04082224013073101"},
                   {"phi", "-0.5347301163226948"},
                   {"delta", "0.5244099658805304"},
                   {"Omega", "0.5347301163226948"},
                   {"epsilon", "1.048080741042263"},
                   {"beta_dot", "1139.920302151208"},
                   {"theta_dot", "-1424.379294994111"},
                   {"gamma_dot", "11.03291221937134"},
                   {"phi_dot", "19.29337464421385"},
                   {"delta_dot", "0.5735699284790808"},
                   {"Omega_dot", "-19.29337464421385"},
                   {"epsilon_dot", "0.3231791658026955"}}};
  problem.start = [](const Values&) {
    State x(14, 0);
    const std::array<const char*, 7> q{"-0.0617138900142764496358948458001", "0",
                                       "0.455279819163070380255912382449",   "0.222668390165885884674473185609",
                                       "0.487364979543842550225598953530",   "-0.222668390165885884674473185609",
                                       "1.23054744454982119249735015568"};
    for (std::size_t i = 0; i < 7; ++i) x[i] = number(q[i]);
    return andrews_names.values(x);
  };
  problem.begin = [](const Values&, const Values& s) { return andrews_names.state(s); };
  problem.end = [](const Values&, const State& x) { return andrews_names.values(x); };
  return problem;
}

Problem car_axis() {
  Problem problem{"car_axis",
                  "default",
                  "Test Set for IVP Solvers, problem caraxis",
                  {{"M", "10"}, {"L", "1"}, {"L0", "0.5"}, {"k", "1e4"}, {"r", "0.1"}, {"w", "10"}, {"g", "1"}},
                  {},
                  {},
                  car_rhs,
                  {},
                  "3",
                  {{"xl", "0.04934557842755629"},
                   {"yl", "0.4969894602303324"},
                   {"xr", "1.041742524885400"},
                   {"yr", "0.3739110272652214"},
                   {"xl_dot", "-0.07705836840321485"},
                   {"yl_dot", "0.007446866596327776"},
                   {"xr_dot", "0.01755681574942899"},
                   {"yr_dot", "0.7703410437794031"}}};
  problem.start = [](const Values&) { return car_names.values({0, 0.5, 1, 0.5, -0.5, 0, -0.5, 0}); };
  problem.begin = [](const Values&, const Values& s) { return car_names.state(s); };
  problem.end = [](const Values&, const State& x) { return car_names.values(x); };
  return problem;
}

}  // namespace published
