// SPDX-License-Identifier: GPL-3.0-or-later
// Spatial chains of bodies on ball joints: runs keep their invariants, and the operations stay below those of the
// recursive scheme in relative angles.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "pipeline/pipeline.hpp"
#include "program/build.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

/// A chain like that of the shipped model, each body with parameters of its own.
std::string chain_text(int n) {
  std::string numbers, bodies;
  for (int k = 1; k <= n; ++k) {
    numbers += fmt::format(
        "m{0} = \"{1} kg\"\nL{0} = \"0.{2} m\"\nc{0} = \"0.{3} m\"\nA{0} = \"0.0{2} kg*m^2\"\nB{0} = \"0.0{4} "
        "kg*m^2\"\n"
        "C{0} = \"0.0{3} kg*m^2\"\n",
        k, 1 + k % 3, 4 + k % 4, 1 + k % 3, 5 + k % 4);
    const std::string base = k == 1 ? "" : fmt::format("P{} ", k - 1),
                      parent = k == 1 ? "" : fmt::format("relative_to = \"link{}\"\n", k - 1);
    bodies += fmt::format(
        "[[body]]\nname = \"link{0}\"\nmass = \"m{0}\"\ninertia = {{ principal = [\"A{0}\", \"B{0}\", \"C{0}\"] }}\n"
        "position = \"{1}-c{0}*link{0}.e3\"\n{2}rotation = {{ euler = \"321\", angles = [\"yaw{0}\", \"pitch{0}\", "
        "\"roll{0}\"] }}\n"
        "[[point]]\nname = \"P{0}\"\nposition = \"{1}-L{0}*link{0}.e3\"\n",
        k, base, parent);
  }
  return "format = 1\n[parameters]\ng = \"9.81 m/s^2\"\n" + numbers + bodies + "[[force]]\ngravity = \"-g*E3\"\n";
}

std::size_t operations(const std::string& text, int n) {
  const std::string path = fmt::format("{}/spatial_chain_of_{}.toml", test::build_folder(), n);
  test::write_text(path, text);
  const auto derived = pipeline::derive_model(test::model_at(path), pipeline::ApproachChoice::automatic, std::nullopt);
  const program::Program program = pipeline::make_program(*derived, {});
  return program.functions.front().operations.flops();
}

}  // namespace

TEST_CASE("spatial_chain: energy and the angular momentum about the vertical are kept") {
  const test::FinishedRun run = test::run_model("spatial_chain_3", [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-12;
    request.overrides.atol = 1e-13;
    request.estimate = false;
  });
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.drift("energy") < 1e-10);
  CHECK(run.drift("momentum.yaw1") < 1e-10);
}

// The recursive scheme in relative angles takes 5602 operations for six such bodies, the articulated one 2692.
TEST_CASE("spatial_chain: fewer operations than the recursive and the articulated scheme in relative angles") {
  CHECK(operations(chain_text(3), 3) < 560);
  CHECK(operations(chain_text(6), 6) < 1700);
}
