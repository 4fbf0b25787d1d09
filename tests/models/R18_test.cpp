// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <filesystem>
#include <set>

#include "numeric/numbers.hpp"
#include "support/attitude.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

void substitute(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
}

test::FinishedRun run_exactly(const std::string& model) {
  return test::run_model(model, [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
  });
}

}  // namespace

TEST_CASE("R18: every representation of rotations gives the same motion of a heavy body on a spring and a damper") {
  const std::string shipped = test::read_text(test::model_path("R18_rodrigues"));
  std::vector<std::array<double, 6>> found;
  for (const rotations::Rotation& r : rotations::registry()) {
    const std::optional<test::Attitude> written = test::attitude_in(r, test::sample_attitude());
    if (!written) continue;
    INFO(r.name);
    std::string text = shipped;
    substitute(text, "{ rodrigues = [\"l1\", \"l2\", \"l3\"] }", written->rotation);
    substitute(text, "l1 = 0.3, l2 = 0.2", written->start);
    const std::string path = test::build_folder() + "/R18_" + r.name + ".toml";
    test::write_text(path, text);
    const test::FinishedRun run = test::run_model(path, [](pipeline::SimulationRequest& request) {
      request.overrides.rtol = 1e-13;
      request.overrides.atol = 1e-14;
      request.overrides.t_end = 0.3;
    });
    found.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      found.back()[k] = run.final("B.omega" + std::to_string(k + 1));
      found.back()[3 + k] = run.final("A.position" + std::to_string(k + 1));
    }
    for (std::size_t k = 0; k < 6; ++k) CHECK(std::abs(found.back()[k] - found.front()[k]) < 1e-9);
    CHECK(run.simulation.result.power_balance < 1e-9);
  }
  CHECK(found.size() == 14);
}

TEST_CASE("R18: every shipped representation gives the motion of Rodrigues' parameters from the same attitude") {
  const auto turned = [](char axis, double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis - '1')));
  };
  const test::FinishedRun rodrigues = run_exactly("R18_rodrigues");
  const auto check = [&](const test::FinishedRun& run, const Eigen::Quaterniond& attitude) {
    run::Overrides overrides;
    overrides.rtol = 1e-12;
    overrides.atol = 1e-13;
    for (int k = 0; k < 3; ++k)
      overrides.values["l" + std::to_string(k + 1)] = numeric::exact(attitude.vec()(k) / attitude.w());
    const run::RunResult other = pipeline::rerun(rodrigues.simulation, overrides);
    for (const char* name : {"B.omega1", "B.omega2", "B.omega3", "A.position1", "A.position2", "A.position3"})
      CHECK(std::abs(run.final(name) - test::value_of(other.final, name)) < 1e-9);
  };
  const std::string angles = "R18_euler_";
  std::set<std::string> shipped;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() + "/models")) {
    if (entry.path().stem().string().starts_with("R18_")) shipped.insert(entry.path().stem().string());
  }
  CHECK(shipped == std::set<std::string>{"R18_euler_121", "R18_euler_123", "R18_euler_131", "R18_euler_132",
                                         "R18_euler_212", "R18_euler_213", "R18_euler_231", "R18_euler_232",
                                         "R18_euler_312", "R18_euler_313", "R18_euler_321", "R18_euler_323",
                                         "R18_euler_parameters", "R18_rodrigues"});
  for (const std::string& model : shipped) {
    const std::string axes = model.starts_with(angles) ? model.substr(angles.size()) : "";
    if (axes.size() != 3) continue;
    CAPTURE(model);
    const test::FinishedRun run = run_exactly(model);
    const auto start = [&](const char* name) { return run.rows.at(0, name); };
    check(run, turned(axes[0], start("n1")) * turned(axes[1], start("n2")) * turned(axes[2], start("n3")));
  }
  const test::FinishedRun parameters = run_exactly("R18_euler_parameters");
  const auto start = [&](const char* name) { return parameters.rows.at(0, name); };
  check(parameters, Eigen::Quaterniond(start("e0"), start("e1"), start("e2"), start("e3")));
}
