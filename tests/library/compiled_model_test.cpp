// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled functions of models with known equations.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "library/example_definitions.hpp"

using namespace eomgen;

namespace {

/// q'' = -k sin q + u, with an output and an event.
Definition driven_pendulum() {
  Definition d("Driven pendulum");
  d.parameter("k", "4").parameter("k2", "2*k");
  d.set("coordinates", "q", Value::table({}));
  d.set("inputs", "u", Value::table({{"default", 0.5}}));
  d.set("energy", "kinetic", "1/2*q_dot^2").set("energy", "potential", "-k*cos(q)");
  d.add("force", {{"generalized", Value::table({{"q", "u"}})}});
  d.add("event", {{"name", "below"}, {"when", "q"}});
  d.set("scene.default", "t", Value::list({0, 1}));
  d.set("scene.default", "initial", Value::table({{"q", 0.3}}));
  d.set("scene.default", "outputs", Value::list({"energy"}));
  return d;
}

std::vector<std::string> names(const std::vector<Quantity>& list) {
  std::vector<std::string> result;
  for (const Quantity& q : list) result.push_back(q.name);
  return result;
}

}  // namespace

TEST_CASE("library: compiled functions of a driven pendulum have their values, in both tiers") {
  const Model model = Model::from(driven_pendulum(), "driven");
  for (const char* tier : {"compiled", "auto"}) {
    const CompiledModel f =
        model.compile({.tier = tier,
                       .functions = std::vector<std::string>{
                           "jac",           "jac_p",         "jac_u",         "mass",      "momenta",
                           "momenta_jac",   "momenta_jac_p", "momenta_jac_u", "events",    "energy_gradients",
                           "frames",        "taylor",        "jvp",           "vjp",       "adjoint",
                           "hvp",           "inverse",       "coriolis",      "gravity",   "outputs_jac",
                           "outputs_jac_p", "outputs_jac_u", "reactions_jac", "regressor", "momentum"}});
    CHECK(names(f.states()) == std::vector<std::string>{"q", "q_dot"});
    CHECK(names(f.parameters()) == std::vector<std::string>{"k", "k2"});
    CHECK(names(f.inputs()) == std::vector<std::string>{"u"});
    CHECK(f.coordinate_count() == 1);
    CHECK(f.values().parameters == std::vector<double>{4, 8});
    CHECK(f.values().state == std::vector<double>{0.3, 0});
    CHECK(f.values().t_end == 1);
    CHECK(f.input_values(0.2) == std::vector<double>{0.5});
    CHECK(f.events() == std::vector<std::string>{"below"});
    CHECK_FALSE(f.certificate().empty());

    const double x[] = {0.7, -1.1}, q = x[0];
    double dx[2], J[4], Jt[2], Jp[4], Ju[2], M[1], h[1], p[1], rate[1];
    CompiledModel::Arguments at{.x = x};
    REQUIRE(f.rhs(at, dx) == 0);
    CHECK(dx[0] == x[1]);
    CHECK(dx[1] == doctest::Approx(-4 * std::sin(q) + 0.5).epsilon(1e-15));
    REQUIRE(f.jac(at, J, Jt) == 0);
    CHECK(J[0] == 0);
    CHECK(J[2] == 1);
    CHECK(J[1] == doctest::Approx(-4 * std::cos(q)).epsilon(1e-15));
    CHECK(Jt[1] == 0);
    CHECK(f.jac(at, J, nullptr) == 0);
    REQUIRE(f.jac_p(at, Jp) == 0);
    CHECK(Jp[1] == doctest::Approx(-std::sin(q)).epsilon(1e-15));
    REQUIRE(f.jac_u(at, Ju) == 0);
    CHECK(Ju[0] == 0);
    CHECK(Ju[1] == 1);
    const double v[] = {0.3, 2, 1.5, -0.5};
    double Jv[2], vJ[2], vP[2], vU[1], Hd[2], tau[1], C[1], slope[1];
    at.v = v;
    REQUIRE(f.jvp(at, Jv) == 0);
    CHECK(Jv[0] == 2);
    CHECK(Jv[1] == doctest::Approx(-4 * std::cos(q) * 0.3).epsilon(1e-15));
    REQUIRE(f.adjoint(at, vJ, vP, vU) == 0);
    CHECK(vJ[0] == doctest::Approx(-4 * std::cos(q) * 2).epsilon(1e-15));
    CHECK(vJ[1] == 0.3);
    CHECK(vP[0] == doctest::Approx(-std::sin(q) * 2).epsilon(1e-15));
    CHECK(vU[0] == 2);
    REQUIRE(f.vjp(at, Jv) == 0);
    CHECK(Jv[0] == vJ[0]);
    REQUIRE(f.hvp(at, Hd) == 0);
    CHECK(Hd[0] == doctest::Approx(4 * std::sin(q) * 2 * 1.5).epsilon(1e-15));
    REQUIRE(f.inverse(at, tau) == 0);
    CHECK(tau[0] == doctest::Approx(0.3 + 4 * std::sin(q) - 0.5).epsilon(1e-15));
    REQUIRE(f.coriolis(at, C) == 0);
    CHECK(C[0] == 0);
    REQUIRE(f.gravity(at, slope) == 0);
    CHECK(slope[0] == doctest::Approx(4 * std::sin(q)).epsilon(1e-15));
    REQUIRE(f.mass(at, M, h) == 0);
    CHECK(M[0] == 1);
    CHECK(h[0] == doctest::Approx(4 * std::sin(q) - 0.5).epsilon(1e-15));
    REQUIRE(f.momenta(at, p, rate) == 0);
    CHECK(p[0] == x[1]);
    double mx[4], mt[2], mp[4], mu[2];
    REQUIRE(f.momenta_jac(at, mx, mt) == 0);
    CHECK(mx[0] == 0);
    CHECK(mx[1] == doctest::Approx(-4 * std::cos(q)).epsilon(1e-15));
    CHECK(mx[2] == 1);
    CHECK(mt[1] == 0);
    REQUIRE(f.momenta_jac_p(at, mp) == 0);
    CHECK(mp[1] == doctest::Approx(-std::sin(q)).epsilon(1e-15));
    REQUIRE(f.momenta_jac_u(at, mu) == 0);
    CHECK(mu[0] == 0);
    CHECK(mu[1] == 1);
    std::vector<double> y(f.outputs().size()), g(f.event_count()), c(2 * 3);
    REQUIRE(f.outputs(at, y.data()) == 0);
    const auto energy = std::find_if(f.outputs().begin(), f.outputs().end(),
                                     [](const Quantity& output) { return output.name == "energy"; });
    CHECK(y[static_cast<std::size_t>(energy - f.outputs().begin())] ==
          doctest::Approx(0.5 * x[1] * x[1] - 4 * std::cos(q)).epsilon(1e-14));
    REQUIRE(f.events(at, g.data()) == 0);
    CHECK(g == std::vector<double>{q});
    double energies[2], dT[2], dU[1];
    REQUIRE(f.energy_gradients(at, energies, dT, dU) == 0);
    CHECK(energies[0] == doctest::Approx(x[1] * x[1] / 2).epsilon(1e-15));
    CHECK(dT[0] == 0);
    CHECK(dT[1] == x[1]);
    CHECK(dU[0] == doctest::Approx(4 * std::sin(q)).epsilon(1e-15));
    const auto row = static_cast<std::size_t>(energy - f.outputs().begin());
    std::vector<double> yx(2 * y.size()), yp(2 * y.size()), yu(y.size()), yt(y.size());
    REQUIRE(f.outputs_jac(at, yx.data(), yt.data()) == 0);
    REQUIRE(f.outputs_jac(at, yx.data(), nullptr) == 0);
    CHECK(yx[row] == doctest::Approx(4 * std::sin(q)).epsilon(1e-15));
    CHECK(yx[y.size() + row] == x[1]);
    CHECK(yt[row] == 0);
    REQUIRE(f.outputs_jac_p(at, yp.data()) == 0);
    CHECK(yp[row] == doctest::Approx(-std::cos(q)).epsilon(1e-15));
    REQUIRE(f.outputs_jac_u(at, yu.data()) == 0);
    CHECK(yu[row] == 0);
    CHECK(f.frames().empty());  // its energies have no positions
    CHECK(f.frames(at, nullptr, nullptr, nullptr) == 0);
    CHECK(f.inertial_parameters().empty());
    CHECK_FALSE(f.has_masses());
    CHECK(f.regressor(at, nullptr, nullptr) == 0);
    CHECK(f.momentum(at, nullptr, nullptr, nullptr) == 0);
    CHECK(f.reactions_jac(at, nullptr, nullptr) == 0);
    REQUIRE(f.taylor(at, 2, c.data()) == 0);
    CHECK(c[4] == doctest::Approx(dx[1] / 2).epsilon(1e-15));

    // Arguments replace the numbers of the scene.
    const double parameters[] = {9, 18}, inputs[] = {-2};
    at.parameters = parameters;
    at.inputs = inputs;
    REQUIRE(f.rhs(at, dx) == 0);
    CHECK(dx[1] == doctest::Approx(-9 * std::sin(q) - 2).epsilon(1e-15));
    CHECK_FALSE(f.has("constraints"));
    CHECK(f.constraints(at, dx, dx, dx) == CompiledModel::not_compiled);
    CHECK(f.scene_values({{"k", 5}, {"q_dot", 2}}).parameters == std::vector<double>{5, 10});
    CHECK(f.scene_values({{"k", 5}, {"q_dot", 2}}).state == std::vector<double>{0.3, 2});
  }
  CHECK_THROWS_AS(model.compile({.functions = std::vector<std::string>{"no_such"}}), Error);
  CHECK_THROWS_AS(model.compile({.scene = "other"}), Error);
}

TEST_CASE("library: compiled functions of a constrained model give multipliers and constraint rows") {
  Definition d("Pendulum in Cartesian coordinates");
  d.parameter("m", "2 kg").parameter("L", "1.5 m").parameter("g", "9.81 m/s^2");
  d.set("coordinates", "x", Value::table({{"unit", "m"}})).set("coordinates", "z", Value::table({{"unit", "m"}}));
  d.add("particle", {{"name", "P"}, {"mass", "m"}, {"position", Value::list({"x", "0", "z"})}});
  d.add("force", {{"gravity", "-g*E3"}});
  d.add("constraint", {{"name", "rod"}, {"holonomic", "x^2 + z^2 - L^2"}});
  d.set("scene.default", "t", Value::list({0, 1}));
  d.set("scene.default", "initial", Value::table({{"x", 0}, {"z", -1.5}, {"x_dot", 2}}));
  const CompiledModel f = Model::from(d, "rod").compile({.approach = Approach::one, .form = "multipliers"});
  CHECK(f.constraints() == std::vector<std::string>{"rod"});
  CHECK(f.reactions() == std::vector<std::string>{"rod"});
  CHECK(f.states()[2].unit == "m/s");
  double psi[1], A[2], b[1], lambda[1];
  const CompiledModel::Arguments at{.x = f.values().state.data()};
  REQUIRE(f.constraints(at, psi, A, b) == 0);
  CHECK(psi[0] == 0);
  CHECK(A[1] == doctest::Approx(-3).epsilon(1e-15));
  REQUIRE(f.reactions(at, lambda) == 0);
  // 2 lambda z = m (g + v^2/L)
  CHECK(2 * lambda[0] * -1.5 == doctest::Approx(2 * (9.81 + 4 / 1.5)).epsilon(1e-14));
}

TEST_CASE("library: eight threads call compiled functions at once and get the values of one thread") {
  Definition d = driven_pendulum();
  d.set("scene.default", "inputs", Value::table({{"u", "sin(3*t)"}}));
  const CompiledModel f = Model::from(d, "driven").compile();
  CHECK(f.input_values(0.5)[0] == doctest::Approx(std::sin(1.5)).epsilon(1e-15));
  constexpr std::size_t count = 2000;
  std::vector<double> t(count), x(2 * count), alone(2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    t[k] = 0.01 * static_cast<double>(k);
    x[2 * k] = std::sin(static_cast<double>(k));
    x[2 * k + 1] = std::cos(static_cast<double>(k));
  }
  REQUIRE(f.rhs_batch(count, t.data(), x.data(), nullptr, nullptr, alone.data()) == 0);
  CHECK(alone[2 * 7 + 1] == doctest::Approx(-4 * std::sin(x[14]) + std::sin(0.21)).epsilon(1e-14));
  std::vector<std::vector<double>> found(8, std::vector<double>(2 * count));
  {
    std::vector<std::jthread> threads;
    for (std::vector<double>& dx : found) {
      threads.emplace_back([&] {
        double J[4], Jt[2];
        for (std::size_t k = 0; k < count; ++k) {
          const CompiledModel::Arguments at{.t = t[k], .x = &x[2 * k]};
          if (f.rhs(at, &dx[2 * k]) != 0 || f.jac(at, J, Jt) != 0 || J[2] != 1) dx[2 * k] = -1e9;
        }
      });
    }
  }
  for (const std::vector<double>& dx : found) CHECK(dx == alone);
}

TEST_CASE("library: a singular state in a batch has its code, and the other states have their values") {
  const CompiledModel f = Model::from(test::pendulum(), "pendulum").compile();
  const double t[] = {0, 0, 0}, x[] = {1, 0, 0, 2, 0, 0, 0, 1, 2, 0, 0, 2};
  double dx[12];
  int codes[3];
  CHECK(f.rhs_batch(3, t, x, nullptr, nullptr, dx, codes) != 0);
  CHECK(codes[0] == 0);
  CHECK(codes[1] != 0);
  CHECK(codes[2] == 0);
  CHECK(std::isnan(dx[6]));
  // L^2 phi'' = L^2 sin cos theta'^2 + g L sin, L = 2
  CHECK(dx[10] == doctest::Approx(4 * std::sin(2.0) * std::cos(2.0) + 9.81 / 2 * std::sin(2.0)).epsilon(1e-14));
}

TEST_CASE("library: many states have the bits of each alone, also beside a singular one") {
  const CompiledModel f = Model::from(test::pendulum(), "pendulum").compile();
  constexpr std::size_t count = 23;  // no multiple of the lanes
  std::vector<double> t(count), x(4 * count), dx(4 * count), alone(4), p(f.parameters().size(), 1.5);
  std::vector<int> codes(count);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = k / 4 == 9 ? 0 : std::sin(1 + static_cast<double>(k * k));
  for (const double* parameters : {static_cast<const double*>(nullptr), static_cast<const double*>(p.data())}) {
    CHECK(f.rhs_batch(count, t.data(), x.data(), parameters, nullptr, dx.data(), codes.data()) == codes[9]);
    for (std::size_t k = 0; k < count; ++k) {
      CAPTURE(k);
      CHECK(codes[k] == f.rhs({.t = t[k], .x = &x[4 * k], .parameters = parameters}, alone.data()));
      CHECK((codes[k] != 0) == (k == 9));
      for (std::size_t i = 0; i < 4; ++i) CHECK((k == 9 ? std::isnan(dx[4 * k + i]) : dx[4 * k + i] == alone[i]));
    }
  }
}

TEST_CASE("library: a compiled model lives on without its model") {
  std::optional<CompiledModel> f;
  {
    const Model model = Model::from(driven_pendulum(), "driven");
    f = model.compile();
  }
  double dx[2];
  CHECK(f->rhs({.x = f->values().state.data()}, dx) == 0);
  CHECK(f->scene_values({{"q", 1}}).state[0] == 1);
}
