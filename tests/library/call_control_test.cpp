// SPDX-License-Identifier: GPL-3.0-or-later
// Callbacks and stop requests of calls, and calls from several threads.
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "library/example_definitions.hpp"

using namespace eomgen;

TEST_CASE("library: stages are reported, and a stop request ends a derivation soon without effect on the next call") {
  const Model model = Model::from(test::chain(40), "chain");
  std::stop_source source;
  std::vector<std::string> stages;
  std::chrono::steady_clock::time_point asked;
  std::jthread asking;
  CallControl control;
  control.stop = source.get_token();
  control.on_stage = [&](const std::string& stage) {
    stages.push_back(stage);
    if (stages.size() > 1) return;
    asking = std::jthread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      asked = std::chrono::steady_clock::now();
      source.request_stop();
    });
  };
  CHECK_THROWS_AS(model.verify({.points = 1000, .compile = false}, control), Interrupted);
  // The contract is 0.2 s; machines under load are slower.
  CHECK(std::chrono::steady_clock::now() - asked < std::chrono::seconds(2));
  REQUIRE_FALSE(stages.empty());
  CHECK(stages.front() == "deriving the equations");
  CHECK(Model::from(test::pendulum()).derivation().coordinates.size() == 2);
}

TEST_CASE("library: an earlier stop request ends a call immediately; during a run it gives a partial result") {
  const Model model = Model::from(test::pendulum(), "pendulum");
  std::stop_source before;
  before.request_stop();
  CHECK_THROWS_AS(model.equations({}, {.stop = before.get_token()}), Interrupted);

  std::stop_source during;
  const Motion motion = model.run({.t_end = 1e7,
                                   .every = 1e-2,
                                   .row =
                                       [&](double t, std::span<const double>) {
                                         if (t > 1) during.request_stop();
                                       }},
                                  {.stop = during.get_token()});
  CHECK(motion.outcome == "interrupted");
  CHECK(motion.t > 1);
  CHECK(motion.t < 1e7);
}

TEST_CASE("library: calls from two threads give the same results as sequential calls") {
  Definition other = test::pendulum();
  other.add("force", {{"on", "P"}, {"force", "-0.1*P.e_theta"}});
  const Model models[] = {Model::from(test::pendulum(), "pendulum"), Model::from(other, "pushed")};
  const auto answers = [](const Model& model) {
    return model.equations().text() + model.emit({.target = "c"}).files.front().text +
           model.examine().constraints[0].treatment;
  };
  const std::string alone[] = {answers(models[0]), answers(models[1])};
  std::string together[2];
  {
    std::jthread a([&] { together[0] = answers(models[0]); }), b([&] { together[1] = answers(models[1]); });
  }
  CHECK(together[0] == alone[0]);
  CHECK(together[1] == alone[1]);
  CHECK(alone[0] != alone[1]);
}
