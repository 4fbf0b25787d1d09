// SPDX-License-Identifier: GPL-3.0-or-later
// A step as a function of compiled models: runs with fixed steps, differences, no allocation.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <eomgen/eomgen.hpp>
#include <new>

using namespace eomgen;

namespace {
std::size_t allocations_so_far = 0;

/// A cart with a pendulum, a force, damping and a fixed step.
Definition damped_cart() {
  Definition d("Cart and pendulum");
  d.parameter("m", "0.5").parameter("c", "0.1").parameter("g", "9.81");
  d.set("coordinates", "s", Value::table({})).set("coordinates", "q", Value::table({}));
  d.set("inputs", "F", Value::table({{"default", 1.5}}));
  d.set("energy", "kinetic", "(2 + m)/2*s_dot^2 + m*s_dot*q_dot*cos(q) + m/2*q_dot^2");
  d.set("energy", "potential", "-m*g*cos(q)");
  d.add("force", {{"generalized", Value::table({{"s", "F - c*s_dot"}})}});
  d.set("scene.default", "t", Value::list({0, 1}));
  d.set("scene.default", "initial", Value::table({{"q", 0.7}, {"q_dot", -1}}));
  return d;
}

const std::vector<std::string> all_derivatives{"jac",         "jac_p",         "jac_u",        "momenta",
                                               "momenta_jac", "momenta_jac_p", "momenta_jac_u"};

}  // namespace

// Not inlined: gcc would take the pair of an inlined and another one for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations_so_far;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE("library: steps as functions follow a run with fixed steps") {
  const Model model = Model::from(damped_cart(), "cart");
  const CompiledModel f = model.compile({.functions = all_derivatives});
  for (const char* method : {"rk4", "midpoint", "variational2"}) {
    RunOptions options;
    options.solver = method;
    options.step = 0.125;
    options.every = 0.125;
    options.error_estimate = false;
    const Motion motion = model.run(options);
    REQUIRE(motion.rows.size() == 9);
    FixedStep step(f, method);
    std::vector<double> x = f.values().state;
    for (std::size_t k = 0; k < 8; ++k) {
      REQUIRE(step({.t = 0.125 * static_cast<double>(k), .x = x.data()}, 0.125, x.data()) == 0);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto column = std::find(motion.columns.begin(), motion.columns.end(), f.states()[i].name);
        REQUIRE(column != motion.columns.end());
        CHECK(std::abs(x[i] - motion.rows[k + 1][static_cast<std::size_t>(column - motion.columns.begin())]) < 1e-14);
      }
    }
  }
}

TEST_CASE("library: derivatives of steps are those of differences, and no call allocates") {
  const CompiledModel f = Model::from(damped_cart(), "cart").compile({.functions = all_derivatives});
  for (const std::string& method : FixedStep::methods()) {
    CAPTURE(method);
    const std::size_t at_first = allocations_so_far;
    FixedStep step(f, method);
    CHECK(allocations_so_far > at_first);  // those of the library are counted
    // x, p, u, t, h
    const std::vector<double> at{0.1, 0.7, -0.4, 1.2, 0.5, 0.1, 9.81, 1.5, 0, 0.1};
    const auto arguments = [](const std::vector<double>& a) {
      return CompiledModel::Arguments{.t = a[8], .x = a.data(), .parameters = &a[4], .inputs = &a[7]};
    };
    std::vector<double> x1(4), up(4), down(4), all(4 * 10);
    const std::size_t before = allocations_so_far;
    int code = step(arguments(at), at[9], x1.data());
    code += step.derivatives(arguments(at), at[9], x1.data(),
                             {.x = &all[0], .parameters = &all[16], .inputs = &all[28], .t = &all[32], .h = &all[36]});
    const std::size_t after = allocations_so_far;
    CHECK(before == after);
    REQUIRE(code == 0);
    for (std::size_t k = 0; k < at.size(); ++k) {
      CAPTURE(k);
      std::vector<double> a = at, b = at;
      a[k] += 1e-5;
      b[k] -= 1e-5;
      REQUIRE(step(arguments(a), a[9], up.data()) == 0);
      REQUIRE(step(arguments(b), b[9], down.data()) == 0);
      for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(all[4 * k + i] - (up[i] - down[i]) / (a[k] - b[k])) < 1e-8);
    }
  }
}

TEST_CASE("library: steps hold inputs that vary in the scene, and refuse what was not compiled") {
  Definition d = damped_cart();
  d.set("scene.default", "inputs", Value::table({{"F", "10*t"}}));
  const Model model = Model::from(d, "cart");
  const CompiledModel f = model.compile({.functions = std::vector<std::string>{"mass"}});
  FixedStep step(f);
  const double held = 4;
  std::vector<double> varying(4), constant(4), J(16);
  const double* const x = f.values().state.data();
  REQUIRE(step({.t = 0.4, .x = x}, 0.1, varying.data()) == 0);
  REQUIRE(step({.t = 0.4, .x = x, .inputs = &held}, 0.1, constant.data()) == 0);
  CHECK(varying == constant);
  CHECK(step.derivatives({.t = 0.4, .x = x}, 0.1, varying.data(), {.x = J.data()}) == CompiledModel::not_compiled);
  CHECK_THROWS_WITH_AS(FixedStep(f, "euler"), doctest::Contains("choose one of rk4, dopri5"), Error);
  CHECK_THROWS_WITH_AS(FixedStep(f, "midpoint"), doctest::Contains("needs the function 'jac'"), Error);
  CHECK_THROWS_WITH_AS(FixedStep(f, "variational2"), doctest::Contains("needs the function 'momenta'"), Error);
}

TEST_CASE("library: a variational step refuses what its momenta do not describe") {
  const auto refused = [](Definition d) {
    return FixedStep(Model::from(d, "cart").compile({.functions = all_derivatives}), "variational2");
  };
  CHECK_NOTHROW(refused(damped_cart()));
  Definition with_state = damped_cart();
  with_state.add("state", {{"name", "z"}, {"rate", "s_dot"}});
  CHECK_THROWS_WITH_AS(refused(with_state), doctest::Contains("states beside coordinates and rates"), Error);
  Definition pendulum("Pendulum");
  pendulum.parameter("g", "9.81").set("coordinates", "x", Value::table({})).set("coordinates", "y", Value::table({}));
  pendulum.set("energy", "kinetic", "(x_dot^2 + y_dot^2)/2").set("energy", "potential", "g*y");
  pendulum.add("constraint", {{"name", "rod"}, {"holonomic", "x^2 + y^2 - 1"}});
  pendulum.set("scene.default", "t", Value::list({0, 1}));
  pendulum.set("scene.default", "initial", Value::table({{"x", 1}, {"y", 0}}));
  CHECK_THROWS_WITH_AS(
      FixedStep(Model::from(pendulum, "pendulum").compile({.form = "multipliers", .functions = all_derivatives}),
                "variational2"),
      doctest::Contains("constraints with multipliers"), Error);
}
