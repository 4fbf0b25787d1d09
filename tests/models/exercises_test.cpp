// SPDX-License-Identifier: GPL-3.0-or-later
// Motions of the models of exercises, against closed forms and conserved quantities.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "models/rough.hpp"
#include "support/folders.hpp"
#include "support/run_text.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

/// The run of a shipped model with further definitions, which are its outputs, at tight tolerances.
FinishedRun run_with_definitions(const std::string& name,
                                 const std::vector<std::pair<std::string, std::string>>& more) {
  std::string text = read_text(model_path(name)), outputs;
  std::string definitions = text.find("[definitions]") == std::string::npos ? "[definitions]\n" : "";
  for (const auto& [defined, expression] : more) definitions += defined + " = \"" + expression + "\"\n";
  const std::size_t scene = text.find("[scene.default]");
  REQUIRE(scene != std::string::npos);
  text.insert(scene, definitions + "\n");
  for (const auto& [defined, expression] : more) outputs += "\"" + defined + "\", ";
  if (const std::size_t shipped_outputs = text.find("\noutputs = "); shipped_outputs != std::string::npos)
    text.erase(shipped_outputs);
  text += "\noutputs = [" + outputs + "\"energy\"]\n";
  const std::string path = build_folder() + "/" + name + "_defined.toml";
  write_text(path, text);
  return run_model(path, [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
}

constexpr double motion_error = 1e-9;  // relative, of runs at rtol = 1e-12

}  // namespace

TEST_CASE("E5_8: two quarter turns carry e1, e2, e3 to E2, E3, E1, by a third of a turn about the diagonal") {
  const FinishedRun run =
      run_with_definitions("E5_8_crystal", {{"e12", "dot(cube.e1, E2)"},
                                            {"e23", "dot(cube.e2, E3)"},
                                            {"e31", "dot(cube.e3, E1)"},
                                            {"trace", "dot(cube.e1, E1) + dot(cube.e2, E2) + dot(cube.e3, E3)"}});
  for (const char* entry : {"e12", "e23", "e31"}) CHECK(std::abs(run.final(entry) - 1) < motion_error);
  // The trace is 1 + 2 cos of the angle of rotation.
  CHECK(std::abs(run.final("trace") - (1 + 2 * std::cos(2 * std::numbers::pi / 3))) < motion_error);
  CHECK(std::abs(run.final("x") - 1) < motion_error);
}

TEST_CASE("E6_6: the kinetic energy is that of the Euler tensors, sum E_k |d e_k/dt|^2 / 2") {
  const auto rate = [](const std::string& axis) { return "dot(ddt(" + axis + "), ddt(" + axis + "))"; };
  const FinishedRun run = run_with_definitions(
      "E6_6_euler_tensors",
      {{"T_ball", "m*R^2/5*(" + rate("ball.e1") + " + " + rate("ball.e2") + " + " + rate("ball.e3") + ")/2"},
       {"T_drum",
        "(m*R^2/4*(" + rate("drum.e1") + " + " + rate("drum.e2") + ") + m*L^2/12*" + rate("drum.e3") + ")/2"}});
  // omega . J omega / 2 of the sphere with 2 m R^2/5, and of the cylinder at the start.
  const double m = 1, R = 0.1, L = 0.4;
  const double ball = 0.4 * m * R * R * (1 + 0.04) / 2;
  const double drum = ((m * R * R / 4 + m * L * L / 12) * 0.25 + m * R * R / 2 * 4) / 2;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(std::abs(run.rows.at(i, "T_ball") - ball) < motion_error * ball);
    CHECK(std::abs(run.rows.at(i, "T_drum") - drum) < motion_error * drum);
    CHECK(std::abs(run.rows.at(i, "energy") - ball - drum) < motion_error);
  }
}

TEST_CASE("E6_8: energy and moment of momentum about the fixed point are those of the shifted inertia tensor") {
  const FinishedRun run = run_with_definitions("E6_8_parallel_axes", {{"HA1", "H_A1"}, {"HA3", "H_A3"}});
  const double m = 2, R = 0.1, L = 0.5, x = 0.08, z = 0.25, theta = 0.9;
  const double across = m * R * R / 4 + m * L * L / 12, along = m * R * R / 2;
  Eigen::Matrix3d J = Eigen::Vector3d(across, across, along).asDiagonal();
  const Eigen::Vector3d r(x, 0, z), omega(0.5, -0.2, 2);
  J += m * (r.dot(r) * Eigen::Matrix3d::Identity() - r * r.transpose());
  const Eigen::Vector3d H = J * omega;
  for (std::size_t i = 0; i < run.rows.size(); ++i) {
    CHECK(std::abs(run.rows.at(i, "HA1") - H(0)) < motion_error);
    CHECK(std::abs(run.rows.at(i, "HA3") - (H(1) * std::sin(theta) + H(2) * std::cos(theta))) < motion_error);
    CHECK(std::abs(run.rows.at(i, "energy") - omega.dot(H) / 2) < motion_error);
  }
}

TEST_CASE("E8_6: energy with the potential of second order, the total moment of momentum and omega3 are conserved") {
  const std::string H = "cross(S, m*velocity(S)) + Jt*S.omega + (Ja - Jt)*dot(S.omega, S.e3)*S.e3";
  const FinishedRun run = run_with_definitions(
      "E8_6_satellite_potential",
      {{"H1", "dot(" + H + ", E1)"},
       {"H2", "dot(" + H + ", E2)"},
       {"H3", "dot(" + H + ", E3)"},
       {"w3", "dot(S.omega, S.e3)"},
       {"T", "m*dot(velocity(S), velocity(S))/2 + Jt*dot(S.omega, S.omega)/2 + (Ja - Jt)*dot(S.omega, S.e3)^2/2"},
       // -GM m/r - GM (tr J - 3 u . J u)/(2 r^3) with the direction u of the centre
       {"U", "-GM*m/norm(S) - GM*(2*Jt + Ja - 3*(Jt + (Ja - Jt)*dot(unit(S), S.e3)^2))/(2*norm(S)^3)"}});
  const std::size_t last = run.rows.size() - 1;
  for (const char* name : {"H1", "H2", "H3", "w3"})
    CHECK(std::abs(run.rows.at(last, name) - run.rows.at(0, name)) < motion_error);
  const auto total = [&](std::size_t i) { return run.rows.at(i, "T") + run.rows.at(i, "U"); };
  CHECK(std::abs(total(last) - total(0)) < motion_error);
  CHECK(std::abs(run.rows.at(last, "T") - run.rows.at(0, "T")) > 1e-5);
  // The attitude turns by the moment of the field: without it the moment of momentum of rotation alone is conserved.
  CHECK(std::abs(run.rows.at(0, "w3") - 1.1) < motion_error);
}
