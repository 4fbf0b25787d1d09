// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with the output of the targets cuda and c and with -DNAME=.. Checks that the functions agree with those of
// C, and that members of an ensemble end with the bits of eom::integrate. Returns the line of the first failure.
// Without NAME: eom::integrate, which all programs link, because its solvers take most of the time of compiling.
#include <eom/run_types.hpp>
#include <functional>
#include <vector>

using Rhs = std::function<int(double, const double*, double*)>;
eom::Result integrate_alone(int order, const Rhs& rhs, double t0, const std::vector<double>& x, double t1,
                            const eom::Options& options);

#ifndef NAME
#include <eom/ode.hpp>

eom::Result integrate_alone(int order, const Rhs& rhs, double t0, const std::vector<double>& x, double t1,
                            const eom::Options& options) {
  return eom::integrate(order == 5 ? "tsit5" : "dop853", rhs, t0, x, t1, options);
}
#else
#include <cmath>
#include <cstdio>
#include <cstring>

#define JOIN2(a, b) a##b
#define JOIN(a, b) JOIN2(a, b)
#define TEXT2(a) #a
#define TEXT(a) TEXT2(a)
#define OF(what) JOIN(NAME, what)

#include TEXT(NAME.cuh)
#include TEXT(NAME.h)
#include TEXT(OF(_ensemble.h))

namespace {

using Model = eom::NAME::device::Model;
constexpr std::size_t n = Model::states, m = Model::parameters, members = 37;  // not a multiple of any block size
constexpr double t0 = 0.25, t1 = 1.5, rtol = 1e-8, within = 1e-10;

double varied(double value, std::size_t member, std::size_t entry) {
  return value * (1 + 0.003 * static_cast<double>((7 * member + 3 * entry) % 11)) +
         0.001 * static_cast<double>(member % 5);
}

bool near(double a, double b) {
  return std::abs(a - b) <= 1e-12 * (1 + std::abs(a)) || (std::isnan(a) && std::isnan(b));
}

int rhs_agrees(const double* x, const double* p) {
  double a[n], b[n];
  const int code = Model::rhs(0.3, x, p, a), of_c = OF(_rhs)(0.3, x, p, nullptr, 0, b);
  if (code != of_c) return __LINE__;
  for (std::size_t i = 0; i < n && code == 0; ++i) {
    if (!near(a[i], b[i])) return __LINE__;
  }
  return 0;
}

}  // namespace

int main() {
  double x[n], p[m > 0 ? m : 1], of_target[n];
  OF(_defaults)(x, p);
  eom::NAME::device::defaults(of_target, p);
  if (std::memcmp(x, of_target, sizeof x) != 0) return __LINE__;
  if (const int line = rhs_agrees(x, p)) return line;
  std::vector<double> starts(n * members), sets(m * members + 1), ends, at(members);
  for (std::size_t k = 0; k < members; ++k) {
    for (std::size_t i = 0; i < n; ++i) starts[i * members + k] = varied(x[i], k, i);
    for (std::size_t i = 0; i < m; ++i) sets[i * members + k] = varied(p[i], k, i);
  }
  std::vector<int> codes(members);
  std::vector<unsigned long long> counts(3 * members);
  for (const int order : {5, 8}) {
    ends = starts;
    if (OF(_ensemble)(order, members, t0, t1, ends.data(), sets.data(), 1, rtol, within, 0, codes.data(), at.data(),
                      counts.data()) != 0)
      return __LINE__;
    for (std::size_t k = 0; k < members; ++k) {
      std::vector<double> own(n), own_p(m + 1);
      for (std::size_t i = 0; i < n; ++i) own[i] = starts[i * members + k];
      for (std::size_t i = 0; i < m; ++i) own_p[i] = sets[i * members + k];
      eom::Options options;
      options.rtol = rtol;
      options.atol = within;
      const auto rhs = [&](double t, const double* state, double* dx) {
        return Model::rhs(t, state, own_p.data(), dx);
      };
      const eom::Result alone = integrate_alone(order, rhs, t0, own, t1, options);
      if ((codes[k] == 0) != (alone.outcome == eom::Outcome::done)) return __LINE__;
      if (codes[k] != 0) continue;
      if (at[k] != t1 || counts[k] != alone.statistics.steps || counts[members + k] != alone.statistics.rejected)
        return __LINE__;
      if (counts[2 * members + k] != alone.statistics.rhs_evaluations) return __LINE__;
      for (std::size_t i = 0; i < n; ++i) {
        if (std::memcmp(&ends[i * members + k], &alone.x[i], sizeof(double)) != 0) {
          std::printf("order %d, member %zu, entry %zu: %.17g in the ensemble, %.17g alone\n", order, k, i,
                      ends[i * members + k], alone.x[i]);
          return __LINE__;
        }
      }
    }
    // Single precision, and one set of parameters for all.
    std::vector<float> xs(starts.begin(), starts.end()), ps(p, p + m);
    ps.push_back(0);
    std::vector<double> same = starts;
    std::vector<int> single(members);
    if (OF(_ensemble_float)(order, members, static_cast<float>(t0), static_cast<float>(t1), xs.data(), ps.data(), 0,
                            1e-5, 1e-6, 0, single.data(), nullptr, nullptr) != 0)
      return __LINE__;
    if (OF(_ensemble)(order, members, t0, t1, same.data(), p, 0, rtol, within, 0, codes.data(), nullptr, nullptr) != 0)
      return __LINE__;
    for (std::size_t k = 0; k < members; ++k) {
      if (codes[k] != 0 || single[k] != 0) continue;
      for (std::size_t i = 0; i < n; ++i) {
        const double error = std::abs(static_cast<double>(xs[i * members + k]) - same[i * members + k]);
        if (!(error <= 3e-3 * (1 + std::abs(same[i * members + k])))) {
          std::printf("order %d, member %zu, entry %zu: %.9g in single precision, %.17g\n", order, k, i,
                      static_cast<double>(xs[i * members + k]), same[i * members + k]);
          return __LINE__;
        }
      }
    }
  }
  ends = starts;
  if (OF(_ensemble)(5, members, t0, t1, ends.data(), sets.data(), 1, rtol, within, 3, codes.data(), nullptr,
                    counts.data()) != 0 ||
      codes[0] != 6 || counts[0] + counts[members] != 3)
    return __LINE__;
  if (OF(_ensemble)(4, members, t0, t1, ends.data(), sets.data(), 1, rtol, within, 0, codes.data(), nullptr, nullptr) !=
      -1)
    return __LINE__;
  if (OF(_ensemble)(5, members, t0, t1, ends.data(), sets.data(), 1, 0, 0, 0, codes.data(), nullptr, nullptr) != -1)
    return __LINE__;
  if (OF(_ensemble)(5, 0, t0, t1, ends.data(), sets.data(), 1, rtol, within, 0, codes.data(), nullptr, nullptr) != 0)
    return __LINE__;
  return 0;
}
#endif
