// SPDX-License-Identifier: GPL-3.0-or-later
// A million double pendulums over 10 s at 1e-9: as an ensemble, and a sample of them one after the other by integrate()
// and by Boost's Odeint, if it is installed, alternating in one process, in processor time. Errors of randomly drawn
// members are measured against the reference solution.
//   bench_million [MEMBERS [REFERENCES]]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "S5_double_pendulum_batch.h"
#include "eom/ensemble/compiled.hpp"
#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "measure.hpp"
#include "model/model.hpp"
#include "pipeline/simulate.hpp"
#include "reference/reference.hpp"
#ifdef EOM_BENCH_ODEINT
#include <boost/numeric/odeint.hpp>
#endif

namespace {

using namespace eomgen::bench;

constexpr std::size_t states = S5_double_pendulum_states, parameters = S5_double_pendulum_parameters;
constexpr double t_end = 10, tolerance = 1e-9;
constexpr std::size_t rounds = 50, in_sample = 4000;  // largest number of members in the sample

using State = std::array<double, states>;
using Parameters = std::array<double, parameters>;

struct Member {
  State x;
  Parameters p;
};

/// Individual angles and masses, from sequences that fill their ranges evenly.
Member member(std::size_t i) {
  Member m;
  S5_double_pendulum_defaults(m.x.data(), m.p.data());
  const auto place = [i](double irrational) { return std::fmod(static_cast<double>(i + 1) * irrational, 1.0); };
  m.x[0] += 0.4 * (place(0.7548776662466927) - 0.5);
  m.x[1] -= 0.3 * (place(0.5698402909980532) - 0.25);
  m.p[0] *= 1 + 0.1 * place(0.6180339887498949);
  return m;
}

State alone(const char* method, const Member& m) {
  eom::Options options;
  options.rtol = options.atol = tolerance;
  const auto rhs = [&m](double t, const double* x, double* dx) {
    return S5_double_pendulum_rhs(t, x, m.p.data(), nullptr, 0, dx);
  };
  const eom::Result result = eom::integrate(method, rhs, 0, m.x, t_end, options);
  require(result.outcome == eom::Outcome::done, "a run alone does not end");
  State x;
  std::copy(result.x.begin(), result.x.end(), x.begin());
  return x;
}

#ifdef EOM_BENCH_ODEINT
template <class Stepper>
State by_odeint(const Member& m) {
  State x = m.x;
  const auto rhs = [&m](const State& state, State& dx, double t) {
    S5_double_pendulum_rhs(t, state.data(), m.p.data(), nullptr, 0, dx.data());
  };
  boost::numeric::odeint::integrate_adaptive(boost::numeric::odeint::make_controlled<Stepper>(tolerance, tolerance),
                                             rhs, x, 0.0, t_end, 1e-2);
  return x;
}
#endif

/// Members first .. first + count - 1.
void together(const char* method, std::size_t first, std::size_t count, std::size_t threads, std::vector<State>& ends) {
  eom::EnsembleOptions options;
  options.rtol = options.atol = tolerance;
  options.threads = threads;
  const auto start = [first](std::size_t i, eom::EnsembleStart& s) {
    const Member m = member(first + i);
    std::copy(m.x.begin(), m.x.end(), s.x.begin());
    std::copy(m.p.begin(), m.p.end(), s.p.begin());
    s.t1 = t_end;
  };
  const auto done = [&](const eom::EnsembleEnd& end) {
    require(end.outcome == eom::Outcome::done, "a member does not end");
    std::copy(end.x.begin(), end.x.end(), ends[first + end.member].begin());
  };
  eom::integrate_ensemble(method, eom::CompiledBatch{S5_double_pendulum_rhs_batch}, count, states, parameters, options,
                          start, done);
}

struct Contender {
  std::string name;
  State (*run)(const Member&);
  double seconds = 0;
  std::vector<State> ends = {};
};

double difference(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < states; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// The member's end to at least 13 digits.
State exact(const eomgen::pipeline::Simulation& model, const Member& m) {
  eomgen::reference::Problem problem{
      model.program.functions.front(), {m.x.begin(), m.x.end()}, {m.p.begin(), m.p.end()}, 0, {{t_end, {}}}, {t_end}};
  // Fewer digits than in bench: a thousand members take a few minutes.
  const eomgen::reference::Solution solution = eomgen::reference::solve(problem, {26, 30}, {32, 36});
  require(solution.digits_at_end >= 13, "the reference has less than 13 digits");
  State x;
  std::copy(solution.x.back().begin(), solution.x.back().end(), x.begin());
  return x;
}

double quantile(std::vector<double> values, double part) {
  const auto place = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

void measure(const char* method, std::vector<Contender>& contenders, std::size_t members, std::vector<State>& ends) {
  const std::size_t sample = std::min(in_sample, members);
  double seconds = 0, seconds_alone = 0;
  std::size_t made = 0;
  std::vector<State> ends_alone(sample);
  for (Contender& c : contenders) c.seconds = 0, c.ends.assign(sample, {});
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::size_t first = members * round / rounds, next = members * (round + 1) / rounds;
    const std::size_t from = sample * round / rounds, until = sample * (round + 1) / rounds;
    const double begin = processor_seconds();
    together(method, first, next - first, 1, ends);
    const double then = processor_seconds();
    for (std::size_t k = from; k < until; ++k) ends_alone[k] = alone(method, member(k * (members / sample)));
    seconds += then - begin;
    seconds_alone += processor_seconds() - then;
    for (Contender& c : contenders) {
      const double before = processor_seconds();
      for (std::size_t k = from; k < until; ++k) c.ends[k] = c.run(member(k * (members / sample)));
      c.seconds += processor_seconds() - before;
    }
    made += next - first;
  }
  const double us = 1e6 * seconds / static_cast<double>(made),
               us_alone = 1e6 * seconds_alone / static_cast<double>(sample);
  double largest = 0;
  for (std::size_t k = 0; k < sample; ++k)
    largest = std::max(largest, difference(ends_alone[k], ends[k * (members / sample)]));
  fmt::print("| {} ensemble, {} members | {:.1f} | 1 | |\n", method, made, us);
  fmt::print("| {} alone | {:.1f} | {:.2f} | {:.1e} |\n", method, us_alone, us_alone / us, largest);
  for (const Contender& c : contenders) {
    const double each = 1e6 * c.seconds / static_cast<double>(sample);
    double largest_difference = 0;
    for (std::size_t k = 0; k < sample; ++k)
      largest_difference = std::max(largest_difference, difference(c.ends[k], ends[k * (members / sample)]));
    fmt::print("| {} | {:.1f} | {:.2f} | {:.1e} |\n", c.name, each, each / us, largest_difference);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t members = argc > 1 ? std::stoul(argv[1]) : 1'000'000;
  const std::size_t references = argc > 2 ? std::stoul(argv[2]) : 1000;
  fmt::print("{}; g++ {}; {}; double pendulums, t = {}, rtol = atol = {:g}; time of one core\n\n", processor(),
             __VERSION__, EOM_BENCH_FLAGS, t_end, tolerance);
  fmt::print("| | us per run | of the ensemble's | largest difference from it |\n|---|---|---|---|\n");
  std::vector<Contender> contenders;
#ifdef EOM_BENCH_ODEINT
  using namespace boost::numeric::odeint;
  contenders.push_back({"Odeint rkf78", by_odeint<runge_kutta_fehlberg78<State>>});
  contenders.push_back({"Odeint dopri5", by_odeint<runge_kutta_dopri5<State>>});
#endif
  std::vector<State> ends(members), by_tsit5(members);
  measure("dop853", contenders, members, ends);
  std::vector<Contender> none;
  measure("tsit5", none, members / 10, by_tsit5);
  std::fflush(stdout);

  eomgen::pipeline::SimulationRequest request;
  request.model = std::make_shared<const eomgen::model::Model>(eomgen::model::read_model(EOM_BENCH_MODEL));
  request.integrate = false;
  request.tier = eomgen::pipeline::Tier::compiled;  // as the batches of the ensemble
  const eomgen::pipeline::Simulation model = eomgen::pipeline::simulate(request);
  std::mt19937_64 random(17);
  std::vector<double> errors, errors_alone;
  std::array<std::vector<double>, 4> others;
  for (std::size_t k = 0; k < references; ++k) {
    const std::size_t i = random() % members;
    const Member m = member(i);
    const State x = exact(model, m);
    errors.push_back(difference(ends[i], x));
    errors_alone.push_back(difference(alone("dop853", m), x));
    for (std::size_t c = 0; c < contenders.size(); ++c) others[c].push_back(difference(contenders[c].run(m), x));
  }
  if (references == 0) return 0;
  fmt::print(
      "\nErrors of {} members drawn at random, against the reference solution:\n\n| | median | 95 % | largest "
      "|\n|---|---|---|---|\n",
      references);
  const auto row = [](const std::string& name, const std::vector<double>& of) {
    fmt::print("| {} | {:.1e} | {:.1e} | {:.1e} |\n", name, quantile(of, 0.5), quantile(of, 0.95), quantile(of, 1));
  };
  row("dop853 ensemble", errors);
  row("dop853 alone", errors_alone);
  for (std::size_t c = 0; c < contenders.size(); ++c) row(contenders[c].name, others[c]);

  fmt::print("\n| threads | members per second |\n|---|---|\n");
  for (std::size_t threads = 1; threads <= std::max(1u, std::thread::hardware_concurrency()); threads *= 2) {
    const auto begin = std::chrono::steady_clock::now();
    together("dop853", 0, members / 10, threads, ends);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    fmt::print("| {} | {:.0f} |\n", threads, static_cast<double>(members / 10) / elapsed.count());
  }
}
