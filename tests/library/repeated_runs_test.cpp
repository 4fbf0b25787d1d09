// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of a model that was run before: the same bits as the first run of a new model, in any thread.
#include <doctest/doctest.h>

#include <algorithm>
#include <future>
#include <thread>
#include <utility>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

void check_same(const Motion& a, const Motion& b) {
  CHECK(a.outcome == b.outcome);
  CHECK(a.columns == b.columns);
  CHECK(a.times == b.times);
  CHECK(a.rows == b.rows);
  CHECK(a.final == b.final);
  CHECK(a.error_estimate == b.error_estimate);
  CHECK(a.steps == b.steps);
  CHECK(a.solver_reason == b.solver_reason);
  CHECK(a.certificate == b.certificate);
}

/// A body whose attitude passes the singularity of its angles, so that the run exchanges charts.
Definition tumbling() {
  Definition d("Tumbling body");
  d.add("body", {{"name", "B"},
                 {"mass", "1 kg"},
                 {"inertia", Value::table({{"principal", Value::list({"1", "2", "3"})}})},
                 {"position", Value::list({"0", "0", "0"})},
                 {"rotation", Value::table({{"euler", "313"}, {"angles", Value::list({"psi", "theta", "phi"})}})}});
  d.set("scene.default", "t", Value::list({0, 3}));
  d.set("scene.default", "initial", Value::table({{"theta", 0.5}, {"theta_dot", -1}, {"phi_dot", 0.1}}));
  return d;
}

}  // namespace

TEST_CASE("library: another run of a model has the bits of a first run, with the same and with other numbers") {
  for (const Definition& definition : {test::pendulum(), tumbling()}) {
    const Model model = Model::from(definition, "model");
    const RunOptions other{.parameters = {{definition.text().find("L") != std::string::npos ? "L" : "phi_dot", 0.7}},
                           .t_end = 2.5};
    const Motion first = model.run(), changed = model.run(other), again = model.run(), copied = Model(model).run(other);
    const auto is_exchange = [](const MotionEvent& event) { return event.kind == "chart"; };
    CHECK(std::any_of(first.events.begin(), first.events.end(), is_exchange) == (first.columns.size() == 6));
    check_same(first, again);
    check_same(changed, copied);
    check_same(changed, Model::from(definition, "model").run(other));
    CHECK(first.t != changed.t);
  }
}

TEST_CASE("library: both tiers give the same motion, and the motion says which it was") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const Motion compiled = model.run({.tier = "compiled"}), automatic = model.run();
  CHECK(compiled.tier == "compiled");
  CHECK(compiled.tier_reason == "asked for");
  CHECK_FALSE(automatic.tier_reason.empty());
  check_same(compiled, automatic);
  CHECK_THROWS_WITH_AS(model.run({.tier = "fast"}), doctest::Contains("there is no tier 'fast'"), Error);
}

TEST_CASE("library: runs with other outputs, solvers, scenes and steps use code of their own") {
  Definition d = test::pendulum();
  d.set("scene.fast", "t", Value::list({0, 1}));
  d.set("scene.fast", "initial", Value::table({{"phi", 1}, {"theta_dot", 5}}));
  const Model model = Model::from(d, "pendulum");
  CHECK(model.run().columns.back() == "energy");
  CHECK(model.run({.outputs = {"P.velocity1"}}).columns.back() == "P.velocity1");
  CHECK(model.run({.solver = "taylor"}).solver == "taylor");
  CHECK(model.run({.step = 1e-3}).solver == "rk4");
  CHECK(model.run({.scene = "fast"}).columns.size() == 6);
  check_same(model.run({.scene = "fast"}), Model::from(d, "pendulum").run({.scene = "fast"}));
  CHECK(model.run({.t_end = 0.}).t == 0);
  const std::vector<std::string> units = model.run().units;
  CHECK(units == std::vector<std::string>{"m", "m/s", "rad", "rad/s", "rad", "rad/s", "J"});
}

TEST_CASE("library: a run does not wait for another one, and both have the bits of a run alone") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  const Motion alone = model.run();
  Motion inner;
  std::thread second;
  RunOptions options{.every = 0.1};
  bool begun = false;
  options.row = [&](double, std::span<const double>) {
    if (begun) return;
    begun = true;
    second = std::thread([&] { inner = model.run(); });
    second.join();  // for ever, if the first run held the lock
  };
  CHECK(model.run(options).final == alone.final);
  check_same(inner, alone);

  std::vector<std::future<Motion>> many;
  for (int i = 0; i < 4; ++i) {
    many.push_back(std::async(std::launch::async, [&model, i] {
      return model.run({.parameters = {{"L", 1 + 0.1 * (i % 2)}}});
    }));
  }
  std::vector<Motion> ended;
  for (std::future<Motion>& run : many) ended.push_back(run.get());
  check_same(ended[0], ended[2]);
  check_same(ended[1], ended[3]);
  CHECK(ended[0].final != ended[1].final);
}

TEST_CASE("library: a run that another thread stops ends, while the other runs go on") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  std::stop_source source;
  std::promise<void> begins;
  RunOptions endless{.t_end = 1e9, .error_estimate = false};
  endless.row = [&begins, begun = false](double, std::span<const double>) mutable {
    if (!std::exchange(begun, true)) begins.set_value();
  };
  std::future<Motion> stopped =
      std::async(std::launch::async, [&] { return model.run(endless, {.stop = source.get_token()}); });
  begins.get_future().wait();
  CHECK(model.run().outcome == "done");
  source.request_stop();
  CHECK(stopped.get().outcome == "interrupted");
  std::stop_source before;
  before.request_stop();
  CHECK_THROWS_AS(Model::from(test::pendulum()).run({}, {.stop = before.get_token()}), Interrupted);
}
