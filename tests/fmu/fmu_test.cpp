// SPDX-License-Identifier: GPL-3.0-or-later
// FMUs of shipped models, simulated by an importer of the tests, against `eomgen run`.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../cli/program.hpp"
#include "importer.hpp"

using namespace eomgen::test;

namespace {

/// The importer's method of order 4 with the step h, and the tolerance 1e-9 of the run: the difference of both.
constexpr double integration = 2e-7;
/// A run of co-simulation has the method and the tolerance of `eomgen run`, and other steps.
constexpr double simulation = 2e-7;

struct Case {
  const char* model;
  double t_end, h;                // of the importer's steps
  double exchange = integration;  // allowed difference, relative to the largest value of the quantity
  double co_simulation = simulation;
};

// Contacts, friction, impacts, resets, samples, states of first order, inputs, constraints with multipliers, kinks in
// time. Ends are far from events, whose times differ.
const Case cases[] = {
    {"bouncing_ball", 1.5, 1e-3},        {"stick_slip_belt", 20.03, 1e-3}, {"sampled_cart_pole", 2.005, 1e-3},
    {"clock_escapement", 5.013, 2.5e-4}, {"thermostat", 700, 0.1},         {"dc_motor", 0.9, 1e-3},
    {"P5_rough_sphere", 0.9, 1e-3},      {"rimless_wheel", 3.013, 1e-3},   {"S5_double_pendulum_cartesian", 2, 1e-3},
    {"P3_moving_plane_gust", 4.5, 1e-3}, {"cart_pendulum", 5, 1e-3},       {"dry_friction_oscillator", 7.03, 1e-3},
};

/// The FMU of a model, unpacked in the folder.
std::unique_ptr<Importer> fmu_of(const Folder& folder, const std::string& model, int version, const Words& more = {}) {
  const std::string out = fmt::format("out{}", version);
  const Json emitted =
      document(folder, with({"emit", model, "-o", out, "--target", "fmu", "--fmi", fmt::format("{}", version)}, more));
  const std::string path = emitted["files"][0];
  return std::make_unique<Importer>(folder.read(path), folder.path());
}

std::string name_of(const Case& c, int version) { return fmt::format("{}, FMI {}", c.model, version); }

/// The values of the FMU that `eomgen run` reports too agree with it.
void check_end(Importer& fmu, const Json& final, double allowed) {
  std::size_t compared = 0;
  for (const auto& [name, value] : final.items()) {
    if (!fmu.variables().contains(name) || !value.is_number()) continue;
    CAPTURE(name);
    const double expected = value, found = fmu.get(name);
    CHECK(std::abs(found - expected) <= allowed * std::max(1.0, std::abs(expected)));
    ++compared;
  }
  CHECK(compared >= fmu.states());
}

Json final_of(const Folder& folder, const Case& c) {
  return document(folder, {"run", c.model, "--t-end", fmt::format("{}", c.t_end), "--rtol", "1e-11", "--atol", "1e-13",
                           "--no-error-estimate"})["final"];
}

}  // namespace

TEST_CASE("fmu: model exchange and co-simulation of shipped models give the motion of `eomgen run`") {
  for (const Case& c : cases) {
    for (const int version : {3, 2}) {
      CAPTURE(name_of(c, version));
      const Folder folder;
      const std::unique_ptr<Importer> fmu = fmu_of(folder, c.model, version);
      const Json final = final_of(folder, c);
      const double t0 = fmu->start_time();

      fmu->instantiate(false);
      fmu->enter_initialization(t0, 1e-9);
      fmu->exit_initialization();
      CHECK(fmu->simulate(t0, c.t_end, c.h) == doctest::Approx(c.t_end).epsilon(1e-12));
      check_end(*fmu, final, c.exchange);

      fmu->instantiate(true);
      fmu->enter_initialization(t0, 1e-11);
      fmu->exit_initialization();
      constexpr int steps = 10;
      for (int k = 0; k < steps; ++k) {
        const double from = t0 + (c.t_end - t0) * k / steps, to = t0 + (c.t_end - t0) * (k + 1) / steps;
        CHECK_FALSE(fmu->do_step(from, to - from));
      }
      check_end(*fmu, final, c.co_simulation);
    }
  }
}

TEST_CASE("fmu: an importer's inputs, parameters and start replace those of the scene") {
  const Folder folder;
  const std::unique_ptr<Importer> fmu = fmu_of(folder, "dc_motor", 3);
  const Json final =
      document(folder, {"run", "dc_motor", "--t-end", "0.9", "--set", "R=2,phi_dot=3", "--rtol", "1e-11"})["final"];
  for (const bool co_simulation : {false, true}) {
    fmu->instantiate(co_simulation);
    fmu->set("R", 2);
    fmu->enter_initialization(0, 1e-11);
    fmu->set("phi_dot", 3);
    CHECK(fmu->get("phi_dot") == 3);
    fmu->exit_initialization();
    if (co_simulation)
      fmu->do_step(0, 0.9);
    else
      fmu->simulate(0, 0.9, 1e-3);
    check_end(*fmu, final, integration);
  }
  // An input of the importer: the current decays to u/R while the rotor is heavy.
  fmu->instantiate(false);
  fmu->set("J", 1e6);
  fmu->enter_initialization(0);
  fmu->exit_initialization();
  fmu->simulate(0, 0.2, 1e-4, [&](double t) { fmu->set("u", 5 * std::cos(10 * t)); });
  // L di/dt + R i = 5 cos(10 t), L = 0.01, R = 1: Z = 1 + 0.1 i.
  const double steady = (5 * std::cos(2.0) + 0.5 * std::sin(2.0)) / 1.01, decayed = 5 / 1.01 * std::exp(-20.0);
  CHECK(fmu->get("i") == doctest::Approx(steady - decayed).epsilon(1e-7));
}

TEST_CASE("fmu: the directional and the adjoint derivatives agree with differences of the derivatives") {
  const Folder folder;
  const std::unique_ptr<Importer> fmu = fmu_of(folder, "cart_pendulum", 3);
  fmu->instantiate(false);
  fmu->enter_initialization(0);
  fmu->exit_initialization();
  fmu->update();
  const std::vector<double> x{0.3, 0.7, -0.4, 1.1};
  fmu->set_point(0, x);
  fmu->set("F", 2);
  std::vector<std::string> unknowns, knowns(4);
  for (const auto& [name, v] : fmu->variables()) {
    if (v.derivative_of >= 0) unknowns.push_back(name);
    if (v.reference >= 1 && v.reference <= 4) knowns[v.reference - 1] = name;
  }
  knowns.emplace_back("F");
  const std::vector<double> seed{0.5, -1, 2, 0.25, 1.5};
  const std::vector<double> along = fmu->directional(unknowns, knowns, seed);
  const auto at = [&](double h) {
    std::vector<double> moved = x;
    for (std::size_t i = 0; i < x.size(); ++i) moved[i] += h * seed[i];
    fmu->set_point(0, moved);
    fmu->set("F", 2 + h * seed[4]);
    std::vector<double> values;
    for (const std::string& name : unknowns) values.push_back(fmu->get(name));
    return values;
  };
  constexpr double h = 1e-5;  // error h^2
  const std::vector<double> right = at(h), left = at(-h);
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    CHECK(along[i] == doctest::Approx((right[i] - left[i]) / (2 * h)).epsilon(1e-7));
  // v^T (J s) = (v^T J) s.
  fmu->set_point(0, x);
  fmu->set("F", 2);
  const std::vector<double> v{1, -0.5, 0.75, 2}, back = fmu->adjoint(unknowns, knowns, v);
  double forward = 0, reverse = 0;
  for (std::size_t i = 0; i < v.size(); ++i) forward += v[i] * along[i];
  for (std::size_t j = 0; j < seed.size(); ++j) reverse += back[j] * seed[j];
  CHECK(forward == doctest::Approx(reverse).epsilon(1e-13));
}

TEST_CASE("fmu: a serialised state continues the motion with the same bits, in the modes of its contacts") {
  for (const int version : {3, 2}) {
    const Folder folder;
    const std::unique_ptr<Importer> fmu = fmu_of(folder, "bouncing_ball", version);
    for (const bool co_simulation : {false, true}) {
      const auto advance = [&](double from, double to) {
        if (co_simulation)
          fmu->do_step(from, to - from);
        else
          fmu->simulate(from, to, 1e-3);
      };
      fmu->instantiate(co_simulation);
      fmu->enter_initialization(0);
      fmu->exit_initialization();
      advance(0, 0.75);
      const std::vector<std::uint8_t> bytes = fmu->serialised_state();
      std::vector<double> ends[2];
      for (std::vector<double>& end : ends) {
        fmu->restore(bytes);
        advance(0.75, 1.5);
        for (const auto& [name, variable] : fmu->variables())
          if (variable.causality == "output") end.push_back(fmu->get(name));
      }
      CHECK(ends[0] == ends[1]);
      std::vector<std::uint8_t> cut(bytes.begin(), bytes.end() - 9);
      CHECK_THROWS(fmu->restore(cut));
    }
  }
}

TEST_CASE("fmu: wrong calls are refused with a message") {
  const Folder folder;
  const std::unique_ptr<Importer> fmu = fmu_of(folder, "dc_motor", 3);
  CHECK_THROWS_WITH(fmu->instantiate(false, "another"), doctest::Contains("that of another FMU"));
  fmu->instantiate(false);
  CHECK_THROWS_WITH(fmu->exit_initialization(), doctest::Contains("was not entered"));
  CHECK_THROWS_WITH(fmu->set_point(0, {0, 0, 0}), doctest::Contains("after the initialization"));
  CHECK_THROWS_WITH(fmu->set("R", std::nan("")), doctest::Contains("not finite"));
  CHECK_THROWS_WITH(fmu->set("der(phi)", 1), doctest::Contains("cannot be set"));
}
