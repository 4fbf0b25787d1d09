// SPDX-License-Identifier: GPL-3.0-or-later
// The published problems to many digits by two formulations: the reference solution of the shipped model, and
// handwritten equations in quadruple precision. Both are compared with the digits of the literature. Prints the tables
// of docs/benchmark-problems.md.
//   bench_published_problems [MODEL [SCENE]]
#include <cln/dfloat.h>
#include <cln/float_io.h>
#include <cln/output.h>
#include <fmt/format.h>
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "bench/bench.hpp"
#include "pipeline/simulate.hpp"
#include "published_equations.hpp"
#include "reference/reference.hpp"
#include "run/integration.hpp"

namespace {

using namespace eomgen;
using published::Problem;
using published::Quad;
using published::Values;

constexpr int looks = 100;                      // relative to the size of each component along the run
constexpr int columns = 9, other_columns = 11;  // of the two extrapolations, whose agreement is claimed

Quad quad(const cln::cl_F& x) {
  std::ostringstream out;
  cln::cl_print_flags flags;
  flags.default_float_format = cln::float_format(x);
  cln::print_float(out, flags, x);
  return published::number(out.str());
}

/// Number of digits in which a and b agree, relative to b, or to `scale` if that is larger.
int digits(Quad a, Quad b, Quad scale = 0) {
  const Quad size = fmaxq(fabsq(b), scale);
  if (a == b) return 33;
  return size == 0 ? 0 : std::max(0, static_cast<int>(floorq(-log10q(fabsq(a - b) / size))));
}

struct ByHand {
  Values end;
  Values other;  // with more columns and a tighter tolerance
};

ByHand by_hand(const Problem& problem, const Values& p, const Values& start, Quad t1) {
  if (problem.closed_form) {
    const Values end = problem.closed_form(p, start, t1);
    return {end, end};
  }
  const auto rhs = [&](Quad t, const published::State& x, published::State& dx) { problem.rhs(p, t, x, dx); };
  const published::State x = problem.begin(p, start);
  return {problem.end(p, published::integrate(rhs, x, t1, columns, published::number("1e-26"))),
          problem.end(p, published::integrate(rhs, x, t1, other_columns, published::number("1e-27")))};
}

pipeline::Simulation prepare(const Problem& problem) {
  pipeline::SimulationRequest request;
  request.tier = pipeline::Tier::compiled;  // as the libraries that it is compared with
  request.model = std::make_shared<const model::Model>(model::read_model(problem.model));
  request.scene = problem.scene;
  request.overrides.solver = "dop853";
  request.overrides.t_end = static_cast<double>(published::number(problem.t1));
  request.integrate = false;
  return pipeline::simulate(request);
}

/// For models that the reference solution does not support.
void by_hand_alone(const Problem& problem) {
  Values exact;
  for (const auto& [name, value] : problem.parameters) exact[name] = published::number(value);
  const ByHand truth = by_hand(problem, exact, problem.start(exact), published::number(problem.t1));
  fmt::print("\n### {}, scene {}, to t = {}\n\nCompared with: {}. By hand only.\n\n| | at t = {} |\n|---|---|\n",
             problem.model, problem.scene, problem.t1, problem.literature, problem.t1);
  std::set<Quad> seen{0};  // all bars move alike
  for (const auto& [name, value] : truth.other) {
    if (seen.insert(value).second)
      fmt::print("| {} | {} |\n", name, published::text(value, std::min(30, digits(truth.end.at(name), value))));
  }
}

void compare(const Problem& problem) {
  const pipeline::Simulation simulation = prepare(problem);
  const run::Code code = simulation.code.code_for_run();
  run::RunRequest request = pipeline::make_run_request(*simulation.derived, simulation.scene, code, false);
  request.watch_power = false;
  const run::Scene& scene = simulation.scene;
  reference::Problem posed{simulation.program.functions.front(),
                           run::Integration(request, "dop853").initial_state(),
                           scene.parameters,
                           scene.t0,
                           {{scene.t1, {}}},
                           {}};
  for (int k = 1; k < looks; ++k) posed.times.push_back(scene.t0 + (scene.t1 - scene.t0) * k / looks);
  posed.times.push_back(scene.t1);
  Values rounded, exact, start;
  for (const auto& [name, value] : problem.parameters) exact[name] = published::number(value);
  if (problem.start_is_binary64) {
    const Values given = problem.start(exact);
    for (std::size_t i = 0; i < posed.x.size(); ++i) posed.x[i] = static_cast<double>(given.at(request.state_names[i]));
  }
  const reference::Solution reference = reference::solve(posed);
  const auto& parameters = simulation.derived->model.parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) rounded[parameters[i].name] = scene.parameters[i];
  for (std::size_t i = 0; i < posed.x.size(); ++i) start[request.state_names[i]] = posed.x[i];
  const ByHand same = by_hand(problem, rounded, start, scene.t1);
  const ByHand truth = by_hand(problem, exact, problem.start(exact), published::number(problem.t1));

  const std::vector<double> sizes = bench::component_scales(reference);
  int both = 33, hand = 33;
  for (std::size_t i = 0; i < posed.x.size(); ++i) {
    const std::string& name = request.state_names[i];
    both = std::min(both, digits(quad(reference.end[i]), same.other.at(name), sizes[i]));
    hand = std::min({hand, digits(truth.end.at(name), truth.other.at(name), sizes[i]),
                     digits(same.end.at(name), same.other.at(name), sizes[i])});
  }
  const bool literature = !problem.values.empty();
  fmt::print(
      "\n### {}, scene {}\n\nCompared with: {}. Digits: {} of the reference solution, {} of the equations by hand, {} "
      "in "
      "which these two agree on "
      "the same binary64 numbers.\n\n",
      problem.model, problem.scene, problem.literature, reference.digits_at_end, hand, both);
  fmt::print("| | at t = {} | binary64 moves it by |{}\n|---|---|---|{}\n", problem.t1,
             literature ? " published | correct digits |" : "", literature ? "---|---|" : "");
  for (std::size_t i = 0; i < posed.x.size(); ++i) {
    const std::string& name = request.state_names[i];
    const Quad value = truth.other.at(name);
    std::string printed, agreed;
    for (const auto& [of, decimal] : problem.values) {
      if (of != name) continue;
      printed = decimal;
      agreed = std::to_string(digits(published::number(decimal), value));
    }
    const bool vanishes = fabsq(value) < 1e-25Q * sizes[i];
    fmt::print("| {} | {} | {:.0e} |{}\n", name,
               vanishes ? "0" : published::text(value, std::clamp(digits(truth.end.at(name), value, sizes[i]), 1, 30)),
               static_cast<double>(fabsq(quad(reference.end[i]) - value)),
               literature ? fmt::format(" {} | {} |", printed, agreed) : "");
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) try {
  for (const Problem& problem : published::problems()) {
    if (argc > 1 && problem.model != argv[1]) continue;
    if (argc > 2 && problem.scene != argv[2]) continue;
    if (problem.by_hand_alone)
      by_hand_alone(problem);
    else
      compare(problem);
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
