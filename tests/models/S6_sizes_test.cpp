// SPDX-License-Identifier: GPL-3.0-or-later
// Chains of 1 to 20 links in absolute and relative angles with different masses and lengths: every applicable
// formulation against the oracle, conservation of energy, and the same motion with both kinds of angles.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "derive/formulations.hpp"
#include "support/folders.hpp"
#include "support/simulation.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;

namespace {

constexpr int longest = 20;

/// Initial state: rod k at 0.3 + 0.05 k from the vertical with rate 0.1 k. `relative`: the same in relative angles.
std::string chain_text(int n, bool relative) {
  std::string mass, length, start;
  for (int k = 1; k <= n; ++k) {
    mass += fmt::format("{}\"m*{}/10\"", k > 1 ? ", " : "", 10 + 3 * (k % 4));
    length += fmt::format("{}\"L*{}/10\"", k > 1 ? ", " : "", 8 + (5 * k) % 7);
    const bool difference = relative && k > 1;
    start += fmt::format("theta{0} = {1}\ntheta{0}_dot = {2}\n", k,
                         difference ? "0.05" : fmt::format("\"0.3 + 0.05*{}\"", k),
                         difference ? "0.1" : fmt::format("\"0.1*{}\"", k));
  }
  return fmt::format(
      "format = 1\n[parameters]\nm = \"1.3 kg\"\nL = \"0.7 m\"\ng = \"9.81 m/s^2\"\n[[chain]]\nname = \"link\"\nn = "
      "{}\n"
      "mass = [{}]\nlength = [{}]\nangles = \"{}\"\n[[force]]\ngravity = \"-g*E2\"\n[scene.default]\nt = [0, 1]\n"
      "outputs = [\"link{}.position1\", \"link{}.position2\"]\n[scene.default.initial]\n{}",
      n, mass, length, relative ? "relative" : "absolute", n, n, start);
}

test::FinishedRun run_chain(int n, bool relative) {
  const std::string folder = test::build_folder() + "/chains";
  std::filesystem::create_directories(folder);
  const std::string path = fmt::format("{}/chain_{}_{}.toml", folder, n, relative ? "relative" : "absolute");
  test::write_text(path, chain_text(n, relative));
  return test::run_model(path, [](pipeline::SimulationRequest& request) {
    request.overrides.rtol = 1e-11;
    request.overrides.atol = 1e-12;
    request.estimate = false;
  });
}

}  // namespace

TEST_CASE("S6: chains of 1 to 20 links in absolute and relative angles agree with the oracle in every formulation") {
  for (const bool relative : {false, true}) {
    for (int n = 1; n <= longest; ++n) {
      CAPTURE(n);
      CAPTURE(relative);
      const model::Model model = model::read_model_text(chain_text(n, relative), "chain.toml");
      mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
      verify::Subjects subjects;
      // Nothing is eliminated, so the approaches are identical.
      for (const derive::FormulationEntry& formulation : derive::formulations()) {
        if (auto system = formulation.derive(mechanics, system::Approach::two))
          subjects.systems.push_back(std::move(*system));
      }
      for (const char* formulation : {"lagrange", "recursive", "articulated"}) {
        const auto of_formulation = [&](const system::EquationSystem& s) { return s.formulation == formulation; };
        CHECK(std::any_of(subjects.systems.begin(), subjects.systems.end(), of_formulation));
      }
      const bool large = n > 8;  // the cost of the oracle grows with n^3 or more
      const verify::Certificate c = verify::certify(mechanics, subjects, {large ? 15 : 25, large ? 1u : 2u, 1});
      CHECK_MESSAGE(c.pass, c.summary());
    }
  }
}

TEST_CASE("S6: chains of different links conserve energy") {
  for (const auto& [n, relative] : {std::pair{3, true}, std::pair{4, false}, std::pair{12, false}}) {
    const auto& shown = n;
    CAPTURE(shown);
    CHECK(run_chain(n, relative).drift("energy") < 1e-10);
  }
}

TEST_CASE("S6: absolute and relative angles give the same motion") {
  const test::FinishedRun absolute = run_chain(5, false), relative = run_chain(5, true);
  double sum = 0;
  for (int k = 1; k <= 5; ++k) {
    const std::string name = "theta" + std::to_string(k);
    sum += relative.final(name);
    CHECK(absolute.final(name) == doctest::Approx(sum).epsilon(1e-8));
  }
  for (const char* name : {"link5.position1", "link5.position2"}) {
    CHECK(absolute.final(name) == doctest::Approx(relative.final(name)).epsilon(1e-8));
  }
}
