// SPDX-License-Identifier: GPL-3.0-or-later
// Simulations that a program advances, compared with runs and with closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

/// q'' = -4 sin q + u.
Definition pushed_pendulum() {
  Definition d("Driven pendulum");
  d.parameter("k", "4");
  d.set("coordinates", "q", Value::table({}));
  d.set("inputs", "u", Value::table({{"default", 0}}));
  d.set("energy", "kinetic", "1/2*q_dot^2").set("energy", "potential", "-k*cos(q)");
  d.add("force", {{"generalized", Value::table({{"q", "u"}})}});
  d.add("event", {{"name", "below"}, {"when", "q"}});
  d.set("scene.default", "t", Value::list({0, 2}));
  d.set("scene.default", "initial", Value::table({{"q", 0.3}}));
  d.set("scene.default", "outputs", Value::list({"energy"}));
  return d;
}

/// A pendulum below a support that turns back at t = 1, where an impulse acts.
Definition supported_pendulum() {
  Definition d("Pendulum on a support");
  d.set("coordinates", "th", Value::table({}));
  d.set("functions", "s", "0.3*abs(t - 1)");
  d.add("particle", {{"name", "P"}, {"mass", 1}, {"position", Value::list({"s + sin(th)", "-cos(th)", 0})}});
  d.add("force", {{"gravity", "-9.81*E2"}});
  d.set("scene.default", "t", Value::list({0, 3}));
  d.set("scene.default", "initial", Value::table({{"th", 0.4}}));
  return d;
}

Definition ball() {
  Definition d("Ball");
  d.parameter("g", "10 m/s^2");
  d.set("coordinates", "z", "m");
  d.add("particle", {{"name", "P"}, {"mass", "1 kg"}, {"position", Value::list({0, 0, "z"})}});
  d.add("force", {{"gravity", "-g*E3"}});
  d.add("constraint", {{"name", "floor"}, {"holonomic", "z"}, {"holds", "unilateral"}, {"restitution", 0.5}});
  d.set("scene.default", "t", Value::list({0, 3}));
  d.set("scene.default", "initial", Value::table({{"z", 1}, {"z_dot", 0}}));
  return d;
}

}  // namespace

TEST_CASE("library: a simulation in pieces reaches the end of a run, with its events and rows") {
  const Model model = Model::from(pushed_pendulum(), "driven");
  const Motion whole = model.run({.rtol = 1e-12, .atol = 1e-14});
  const CompiledModel f = model.compile();
  Simulation s(f, {.rtol = 1e-11, .atol = 1e-13, .every = 0.5});
  CHECK(s.t() == 0);
  CHECK(s.state() == std::vector<double>{0.3, 0});
  std::size_t events = 0, rows = 0;
  for (int k = 1; k <= 20; ++k) {
    const Advance end = s.advance(0.1 * k);
    REQUIRE(end.outcome == "done");
    CHECK(end.t == 0.1 * k);
    events += end.events.size();
    rows += end.times.size();
    for (const std::vector<double>& row : end.rows) CHECK(row.size() == f.outputs().size());
  }
  CHECK(events == whole.events.size());
  CHECK(rows == 5);
  CHECK(s.state()[0] == doctest::Approx(whole.final_value("q")).epsilon(1e-9));
  CHECK(s.outputs()[0] == s.state()[0]);
  CHECK(s.advance(2).steps == 0);
  CHECK_THROWS_WITH_AS(s.advance(1), doctest::Contains("would end before t = 2"), Error);
  CHECK_THROWS_AS(s.advance(NAN), Error);
  REQUIRE(s.step().is_complete());
  CHECK(s.t() > 2);
}

TEST_CASE("library: a controller at 1 kHz holds its inputs, and simulations of one model are independent") {
  const CompiledModel f = Model::from(pushed_pendulum(), "driven").compile();
  Simulation s(f), other(f, {.parameters = {{"k", 9}, {"q", 0.5}}});
  CHECK(other.state() == std::vector<double>{0.5, 0});
  CHECK(other.parameters() == std::vector<double>{9});
  for (int k = 1; k <= 5000; ++k) {
    const std::vector<double> x = s.state();
    s.set_input("u", 4 * std::sin(x[0]) - 4 * x[0] - 4 * x[1]);  // q'' = -4 q - 4 q', but for the delay
    REQUIRE(s.advance(1e-3 * k).outcome == "done");
  }
  // q = 0.3 (1 + 2 t) exp(-2 t)
  CHECK(s.state()[0] == doctest::Approx(0.3 * 11 * std::exp(-10.0)).epsilon(0.05));
  CHECK(other.t() == 0);
  s.set_input("u", [](double t) { return std::sin(t); });
  CHECK(s.inputs()[0] == doctest::Approx(std::sin(5.0)).epsilon(1e-15));
  CHECK(s.advance(5.5).outcome == "done");
  CHECK_THROWS_WITH_AS(s.set_input("v", 1), doctest::Contains("there is no input 'v'"), Error);
  const double two[] = {1, 2};
  CHECK_THROWS_AS(s.set_inputs(two), Error);
  CHECK_THROWS_AS(s.set_state(0, {two, 1}), Error);
  CHECK_THROWS_AS(s.set_input("u", NAN), Error);
  CHECK_THROWS_AS(Simulation(f, {.solver = "euler1768"}), Error);
  CHECK_THROWS_AS(Simulation(f, {.solver = "taylor"}), Error);  // compiled without its series
  s.set_state(1, two);
  CHECK(s.t() == 1);
  CHECK(s.state() == std::vector<double>{1, 2});
}

TEST_CASE("library: a restored simulation continues with the same bits, with contacts, and not in another model") {
  const CompiledModel f = Model::from(ball(), "ball").compile();
  for (const double t : {0.3, 1.2, 2.0}) {
    CAPTURE(t);
    Simulation s(f), other(f);
    REQUIRE(s.advance(t).outcome == "done");
    const SimulationState saved = s.save();
    CHECK(saved.t() == t);
    REQUIRE(s.advance(t + 0.5).outcome == "done");
    other.restore(saved);
    REQUIRE(other.advance(t + 0.5).outcome == "done");
    CHECK(s.state() == other.state());
  }
  Simulation rest(f);
  const double on_floor[] = {0, 0}, below[] = {-1, 0};
  rest.set_state(0, on_floor);
  REQUIRE(rest.advance(1).outcome == "done");
  CHECK(rest.state() == std::vector<double>{0, 0});
  CHECK_THROWS_WITH_AS(rest.set_state(0, below), doctest::Contains("the gap of 'floor' is negative"), Error);
  const CompiledModel pendulum = Model::from(pushed_pendulum(), "driven").compile();
  Simulation elsewhere(pendulum);
  CHECK_THROWS_AS(elsewhere.restore(rest.save()), Error);
}

TEST_CASE("library: a stop request ends an advance, and the simulation goes on afterwards") {
  const CompiledModel f = Model::from(pushed_pendulum(), "driven").compile();
  std::stop_source source;
  Simulation s(f, {.every = 1, .row = [&](double t, std::span<const double>) {
                     if (t >= 5) source.request_stop();
                   }});
  const Advance end = s.advance(1e6, {.stop = source.get_token()});
  CHECK(end.outcome == "interrupted");
  CHECK(s.t() >= 5);
  CHECK(s.t() < 1e6);
  CHECK(s.advance(s.t() + 1).outcome == "done");
}

TEST_CASE("library: pieces cross the impulse of a support once, wherever they end") {
  const Model model = Model::from(supported_pendulum(), "supported");
  const Motion whole = model.run({.rtol = 1e-12, .atol = 1e-14});
  for (const double piece : {0.05, 0.5, 0.7}) {  // two of them end at the kink
    CAPTURE(piece);
    Simulation s(model.compile(), {.rtol = 1e-11, .atol = 1e-13});
    std::size_t impulses = 0;
    for (int k = 1; s.t() < 3; ++k) {
      const Advance end = s.advance(std::min(3.0, piece * k));
      REQUIRE(end.outcome == "done");
      for (const MotionEvent& event : end.events) impulses += event.kind == "impulse" ? 1 : 0;
    }
    CHECK(impulses == 1);
    CHECK(s.state()[0] == doctest::Approx(whole.final_value("th")).epsilon(1e-9));
    CHECK(s.state()[1] == doctest::Approx(whole.final_value("th_dot")).epsilon(1e-9));
  }
}

TEST_CASE("library: pieces take each sample and each reset once, wherever they end, and a restored run continues") {
  // A ball that a reset reflects, under a force that a sample sets every 0.1 s.
  const Model model = Model::from_text(
      "format = 1\n[coordinates]\nz = {}\n[[particle]]\nname = \"P\"\nmass = 1\nposition = \"z*E3\"\n[[force]]\n"
      "generalized = { z = \"u\" }\n[discrete]\nu = -10\ncount = 0\nbounces = 0\n[[sample]]\nevery = 0.1\nset = { u = "
      "\"-10 + 0.5*z\", count = \"count + 1\" }\n[[event]]\nname = \"floor\"\nwhen = \"z\"\ndirection = \"down\"\nset "
      "= "
      "{ z_dot = \"-0.9*z_dot\", bounces = \"bounces + 1\" }\n[scene.default]\nt = [0, 2]\ninitial = { z = 1, z_dot = "
      "0 }\n",
      "sampled");
  const Motion whole = model.run({.rtol = 1e-12, .atol = 1e-14});
  CHECK(whole.final_value("count") == 20);
  CHECK(whole.final_value("bounces") == 3);
  for (const double piece : {0.05, 0.1, 0.73}) {  // two of them end at samples
    CAPTURE(piece);
    Simulation s(model.compile(), {.rtol = 1e-11, .atol = 1e-13});
    std::size_t resets = 0;
    for (int k = 1; s.t() < 2; ++k) {
      const SimulationState saved = s.save();
      s.advance(std::min(2.0, piece * k));
      s.restore(saved);
      const Advance end = s.advance(std::min(2.0, piece * k));
      REQUIRE(end.outcome == "done");
      for (const MotionEvent& event : end.events) resets += event.kind == "reset" ? 1 : 0;
    }
    CHECK(resets == 3);
    CHECK(s.state()[3] == 20);
    CHECK(s.state()[0] == doctest::Approx(whole.final_value("z")).epsilon(1e-9));
  }
}
