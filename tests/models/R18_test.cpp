// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

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
