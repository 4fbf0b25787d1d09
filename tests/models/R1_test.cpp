// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "support/attitude.hpp"
#include "support/folders.hpp"
#include "support/free_body.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

constexpr std::array<double, 3> J{1, 2, 2.5};
constexpr double turning_tolerance = 1e-9;  // twenty seconds, some four turns, at rtol 1e-12

void tighten_turning(pipeline::SimulationRequest& request) {
  request.overrides.rtol = 1e-12;
  request.overrides.atol = 1e-13;
}

double worst_against_jacobi(const test::FinishedRun& run) {
  double worst = 0;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    const std::array<double, 3> w = test::free_body(J, 0.2, 1, run.rows.t[i]);
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(run.rows.at(i, "B.omega" + std::to_string(k + 1)) - w[k]));
  }
  return worst;
}

/// The free body with these rotation and start, as a model of its own; all nine e_k . E_j are outputs.
std::string model_text(const std::string& rotation, const std::string& start) {
  std::string text =
                  "format = 1\ntitle = \"t\"\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, 2.5] "
                  "}\nrotation = " +
                  rotation + "\n[definitions]\n",
              outputs;
  for (char k = '1'; k <= '3'; ++k) {
    for (char j = '1'; j <= '3'; ++j) {
      text += std::string("c") + k + j + " = \"dot(B.e" + k + ", E" + j + ")\"\n";
      outputs += std::string(outputs.empty() ? "" : ", ") + "\"c" + k + j + "\"";
    }
  }
  return text + "[scene.default]\nt = [0, 1.5]\nrtol = 1e-13\natol = 1e-14\ninitial = { " + start +
         ", \"B.omega\" = [0.3, -0.4, 0.5] }\noutputs = [" + outputs + "]\n";
}

}  // namespace

TEST_CASE("R1: the angular velocity is Jacobi's solution, in angles and Euler parameters, and E and H are conserved") {
  for (const char* name : {"R1_free_body", "R1_free_body_euler_parameters"}) {
    INFO(name);
    const test::FinishedRun run = test::run_model(name, tighten_turning);
    CHECK(worst_against_jacobi(run) < turning_tolerance);
    CHECK(run.drift("energy") < 1e-11);
    for (const char* h : {"angular_momentum.E1", "angular_momentum.E2"}) CHECK(run.drift(h) < 1e-10);
    // On the energy ellipsoid and the momentum sphere.
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      double energy = 0, momentum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = run.rows.at(i, "B.omega" + std::to_string(k + 1));
        energy += J[k] * w * w / 2;
        momentum += J[k] * J[k] * w * w;
      }
      CHECK(energy == doctest::Approx((0.04 + 2.5) / 2).epsilon(turning_tolerance));
      CHECK(momentum == doctest::Approx(0.04 + 6.25).epsilon(turning_tolerance));
    }
  }
}

TEST_CASE("R1: with two equal moments w rotates at a constant rate, with three it is constant") {
  for (const char* scene : {"axisymmetric", "symmetric"}) {
    INFO(scene);
    const test::FinishedRun run = test::run_model("R1_free_body", [&](pipeline::SimulationRequest& request) {
      tighten_turning(request);
      request.scene = scene;
    });
    const double rate = run.parameter("J3") == 2 ? 0 : (2.5 - 2.0) / 2;  // (J3 - J1)/J1 w3
    for (std::size_t i = 0; i < run.rows.size(); ++i) {
      const double t = run.rows.t[i];
      CHECK(std::abs(run.rows.at(i, "B.omega1") - 0.2 * std::cos(rate * t)) < turning_tolerance);
      CHECK(std::abs(run.rows.at(i, "B.omega2") - 0.2 * std::sin(rate * t)) < turning_tolerance);
      CHECK(std::abs(run.rows.at(i, "B.omega3") - 1) < turning_tolerance);
    }
  }
}

TEST_CASE("R1: near the intermediate axis it tumbles: e2 reverses, and E and H are conserved") {
  const test::FinishedRun run =
      test::run_model("R1_free_body_euler_parameters", [](pipeline::SimulationRequest& request) {
        tighten_turning(request);
        request.overrides.rtol = request.overrides.atol = 1e-13;
        request.scene = "tumbling";
      });
  double least = 1, greatest = -1;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    least = std::min(least, run.rows.at(i, "B.omega2"));
    greatest = std::max(greatest, run.rows.at(i, "B.omega2"));
    double length = 0;
    for (const char* e : {"e0", "e1", "e2", "e3"}) length += std::pow(run.rows.at(i, e), 2);
    CHECK(std::abs(length - 1) < 1e-11);  // rows are read off the dense output; the steps themselves are projected
  }
  CHECK(greatest > 1.99);
  CHECK(least < -1.99);
  CHECK(run.drift("energy") < 1e-11);
  for (const char* h : {"angular_momentum.E1", "angular_momentum.E2", "angular_momentum.E3"})
    CHECK(run.drift(h) < 1e-10);
}

TEST_CASE("R1: all twelve sets of Euler angles, Euler parameters and a Rodrigues vector give the same attitude") {
  std::vector<std::array<double, 9>> found;
  const Eigen::Matrix3d start = test::sample_attitude();
  for (const rotations::Rotation& r : rotations::registry()) {
    const std::optional<test::Attitude> written = test::attitude_in(r, start);
    if (!written) continue;
    INFO(r.name);
    const std::string path = test::build_folder() + "/R1_" + r.name + ".toml";
    test::write_text(path, model_text(written->rotation, written->start));
    const test::FinishedRun run = test::run_model(path);
    found.emplace_back();
    for (std::size_t i = 0; i < 9; ++i)
      found.back()[i] = run.final("c" + std::to_string(i / 3 + 1) + std::to_string(i % 3 + 1));
    for (std::size_t i = 0; i < 9; ++i) CHECK(std::abs(found.back()[i] - found.front()[i]) < turning_tolerance);
    CHECK(std::abs(found.back()[0] - start(0, 0)) > 0.01);  // it has moved
  }
  CHECK(found.size() == 14);
}
