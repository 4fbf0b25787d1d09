// SPDX-License-Identifier: GPL-3.0-or-later
// Many double pendulums over 10 s: one after the other by integrate(), and as an ensemble, in one process on one core.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "S5_double_pendulum_batch.h"
#include "eom/ensemble/compiled.hpp"
#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "measure.hpp"

namespace {

using namespace eomgen::bench;

constexpr std::size_t states = S5_double_pendulum_states, parameters = S5_double_pendulum_parameters;
constexpr double t_end = 10, tolerance = 1e-9;

void start_of(std::size_t member, double* x, double* p) {
  S5_double_pendulum_defaults(x, p);
  const double place = static_cast<double>(member * 7919 % 10007) / 10007;
  x[0] += 0.4 * (place - 0.5);
  x[1] -= 0.3 * (place * place - 0.25);
  p[0] *= 1 + 0.1 * place;
}

template <class Work>
double seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// One pendulum with the functions that the method needs.
struct One {
  const double* p;
  int operator()(double t, const double* x, double* dx) const {
    return S5_double_pendulum_rhs(t, x, p, nullptr, 0, dx);
  }
  int jacobian(double t, const double* x, double* dfdx, double* dfdt) const {
    return S5_double_pendulum_jac(t, x, p, nullptr, 0, dfdx, dfdt);
  }
  int taylor(double t, const double* x, int order, double* c) const {
    return S5_double_pendulum_taylor(t, x, p, nullptr, 0, order, c);
  }
  int taylor_order() const { return S5_double_pendulum_taylor_order; }
  std::size_t taylor_states() const { return states; }
};

template <class Rhs>
void measure(const Rhs& batch, const char* method, std::size_t members, int repeats, std::size_t lanes) {
  std::vector<double> alone(members * states), together(members * states), alone_times, ensemble_times, ratios;
  for (int r = 0; r < repeats; ++r) {
    alone_times.push_back(seconds([&] {
      eom::Options options;
      options.rtol = options.atol = tolerance;
      for (std::size_t i = 0; i < members; ++i) {
        std::vector<double> x(states), p(parameters);
        start_of(i, x.data(), p.data());
        const eom::Result result = eom::integrate(method, One{p.data()}, 0, x, t_end, options);
        if (result.outcome != eom::Outcome::done) std::exit(1);
        std::copy(result.x.begin(), result.x.end(), alone.begin() + static_cast<std::ptrdiff_t>(i * states));
      }
    }));
    ensemble_times.push_back(seconds([&] {
      eom::EnsembleOptions options;
      options.rtol = options.atol = tolerance;
      options.lanes = lanes;
      const auto start = [](std::size_t i, eom::EnsembleStart& s) {
        start_of(i, s.x.data(), s.p.data());
        s.t1 = t_end;
      };
      const auto done = [&](const eom::EnsembleEnd& end) {
        if (end.outcome != eom::Outcome::done) std::exit(1);
        std::copy(end.x.begin(), end.x.end(), together.begin() + static_cast<std::ptrdiff_t>(end.member * states));
      };
      eom::integrate_ensemble(method, batch, members, states, parameters, options, start, done);
    }));
    ratios.push_back(alone_times.back() / ensemble_times.back());
  }
  double difference = 0;
  for (std::size_t i = 0; i < alone.size(); ++i) difference = std::max(difference, std::abs(alone[i] - together[i]));
  const double per = 1e6 / static_cast<double>(members);
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.1e} |\n", method, lanes, per * median(alone_times),
             per * median(ensemble_times), median(ratios), difference);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t members = argc > 1 ? std::stoul(argv[1]) : 2000;
  fmt::print("{}; g++ {}; {}; {} double pendulums, t = {}, rtol = atol = {:g}, one core\n\n", processor(), __VERSION__,
             EOM_BENCH_FLAGS, members, t_end, tolerance);
  fmt::print(
      "| method | lanes | one after the other, us per run | ensemble, us per run | times as fast | largest difference "
      "|\n|---|---|---|---|---|---|\n");
  const eom::CompiledBatch batch{S5_double_pendulum_rhs_batch};
  for (const std::size_t lanes : {16, 32, 64}) {
    for (const char* method : {"dop853", "tsit5", "dopri5"}) measure(batch, method, members, 9, lanes);
    measure(eom::CompiledBatchSeries{batch, S5_double_pendulum_taylor_batch, S5_double_pendulum_taylor_order}, "taylor",
            members, 9, lanes);
    measure(eom::CompiledBatchJacobian{batch, S5_double_pendulum_jac_batch}, "rodas", members / 8, 9, lanes);
  }
}
