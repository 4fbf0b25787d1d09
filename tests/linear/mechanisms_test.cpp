// SPDX-License-Identifier: GPL-3.0-or-later
// Mechanisms from the literature, with many coordinates and constraints, against published values and closed forms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "analysis/steady_search.hpp"
#include "linearised.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

std::string kept(const std::string& name) { return source_folder() + "/tests/linear/models/" + name + ".toml"; }

std::string written(const std::string& name, const std::string& text) {
  const std::string path = build_folder() + "/" + name + ".toml";
  write_text(path, text);
  return path;
}

Linearised linearised_at(const std::string& path) {
  analysis::SteadyProblem problem =
      analysis::steady_problem("linearize", test::model_at(path), "default", {}, {}, 1, analysis::Contacts::none);
  linear::Linearisation l = linear::linearise(*problem.flow, problem.z, problem.setting, problem.neighbours, 1);
  return {std::move(problem), std::move(l)};
}

analysis::SteadyMotions found_from(const std::string& path, std::size_t starts) {
  analysis::SteadyRequest request;
  request.model = test::model_at(path);
  request.starts = starts;
  return analysis::steady_motions(request);
}

}  // namespace

// J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer
// of a bicycle: a benchmark and review, Proceedings of the Royal Society A 463 (2007) 1955-1982, table 2, at 5 m/s:
// weave, capsize, castering. The others are zeros: position, heading, wheel angles, its
// speed.
TEST_CASE(
    "the benchmark bicycle at 5 m/s has the published eigenvalues, in nine coordinates and in those of four bodies") {
  for (const char* model : {"bicycle", "bicycle_of_four_bodies"}) {
    CAPTURE(model);
    const Linearised bicycle = linearised_at(kept(model));
    CHECK(bicycle.l.kind == linear::MotionKind::steady);
    REQUIRE(bicycle.l.spectrum.values.size() == 10);
    CHECK(bicycle.zeros() == 6);
    CHECK(bicycle.l.structural_zeros == 6);
    CHECK(bicycle.l.spectrum.is_reliable());
    constexpr double published = 1e-13;  // all published digits
    for (const auto& [n, re, im] : {std::tuple{6U, -0.322866429004087, 0.0},
                                    {7U, -0.775341882195845, 4.46486771378823},
                                    {8U, -0.775341882195845, -4.46486771378823},
                                    {9U, -14.07838969279822, 0.0}}) {
      CHECK(bicycle.value(n).re == doctest::Approx(re).epsilon(published));
      CHECK(bicycle.value(n).im == doctest::Approx(im).epsilon(published));
    }
  }
}

// Small rotations t1, t2 about the horizontal axes turn about the point of contact, H below the centre of mass, with
// J + m H^2, and the radii of curvature there lift the centre: [A + m H^2, D; D, B + m H^2] t'' + m g [b^2/c - H, 0; 0,
// a^2/c - H] t = 0.
TEST_CASE("a rattleback at rest rocks with the two frequencies of its axes of inertia and curvature") {
  const Linearised rest = linearised_at(kept("rattleback"));
  CHECK(rest.l.kind == linear::MotionKind::equilibrium);
  const double a = 0.2, b = 0.03, c = 0.02, H = 0.01, g = 9.81;
  const double M1 = 0.0002 + H * H, M2 = 0.0016 + H * H, D = -0.0002, K1 = g * (b * b / c - H),
               K2 = g * (a * a / c - H);
  const double det = M1 * M2 - D * D, sum = (M1 * K2 + M2 * K1) / det, product = K1 * K2 / det;
  const double root = std::sqrt(sum * sum / 4 - product);
  std::vector<double> frequencies;
  for (const linear::Eigenvalue& value : rest.l.spectrum.values) {
    if (value.im > 0) frequencies.push_back(value.im);
    CHECK(std::abs(value.re) < linear_tolerance);
  }
  std::sort(frequencies.begin(), frequencies.end());
  REQUIRE(frequencies.size() == 2);
  same(frequencies[0], std::sqrt(sum / 2 - root));
  same(frequencies[1], std::sqrt(sum / 2 + root));
}

TEST_CASE("the independent one of many constrained coordinates is found at once") {
  constexpr int n = 40;
  std::string text = "format = 1\n", start;
  for (int k = 1; k <= n; ++k) {
    text += fmt::format("[[particle]]\nname = \"P{0}\"\nmass = 1\nposition = {{ cartesian = [\"x{0}\", 0] }}\n", k);
    if (k > 1)
      text += fmt::format("[[constraint]]\nname = \"rod{0}\"\nholonomic = \"norm(P{0} - P{1}) - 1\"\n", k, k - 1);
    start += fmt::format("{}x{} = {}", k > 1 ? ", " : "", k, k);
  }
  text +=
      "[[force]]\nspring = { between = [\"P1\", \"origin\"], stiffness = 10, length = 1 }\n[scene.default]\ninitial = "
      "{ " +
      start + " }\n";
  const Linearised row = linearised_at(written("row_of_rods", text));
  CHECK(row.l.kind == linear::MotionKind::equilibrium);
  REQUIRE(row.l.spectrum.values.size() == 2);
  same(row.value(0).im, 0.5);  // sqrt(10/n)
}

TEST_CASE("a search that ends where angles are singular reports that place, not the start") {
  const std::string rods = R"toml(format = 1
[[body]]
name = "upper"
mass = 1
inertia = { principal = [0.1, 0.1, 0] }
position = "0.5*upper.e3"
rotation = { euler = "313", angles = ["a", "b", 0] }
[[body]]
name = "lower"
mass = 2
inertia = { principal = [0.2, 0.2, 0] }
position = "upper.e3 + 0.6*lower.e3"
rotation = { euler = "313", angles = ["c", "d", 0] }
[[force]]
gravity = "-9.81*E3"
[scene.default]
initial = { a = 0.1, b = 0.7, c = 0.2, d = 0.9 }
)toml";
  try {
    const analysis::SteadyMotions all = found_from(written("conical_rods", rods), 40);
    CHECK(all.search.failed_starts > 0);
  } catch (const Error& error) {
    CHECK(error.message().find("of the starts end where the equations of motion have no slope") != std::string::npos);
  }
}

// Two bodies are connected by ball joints: each may rotate about its length, whichever coordinate is held.
TEST_CASE("twenty members of an undetermined family are examined, and starts that lead to others are counted") {
  std::string text = "format = 1\n";
  for (const int k : {1, 2}) {
    text += fmt::format(
        "[[body]]\nname = \"B{0}\"\nmass = 1\ninertia = {{ principal = [0.1, 0.12, 0.02] }}\nposition = {{ cartesian = "
        "[\"x{0}\", \"y{0}\", \"z{0}\"] }}\n"
        "rotation = {{ euler_parameters = [\"a{0}\", \"b{0}\", \"c{0}\", \"d{0}\"] }}\n[[joint]]\nname = "
        "\"j{0}\"\ntype = \"ball\"\nbodies = [\"{1}\", \"B{0}\"]\nat = [\"{2}\", \"B{0} + 0.5*B{0}.e3\"]\n",
        k, k == 1 ? "ground" : "B1", k == 1 ? "origin" : "B1 - 0.5*B1.e3");
  }
  const analysis::SteadyMotions all = found_from(written("two_hang", text + "[[force]]\ngravity = \"-9.81*E3\"\n"), 60);
  CHECK(all.search.further_members > 0);
  CHECK(all.points.size() <= 20);
  CHECK(all.search.converged >= all.search.further_members + all.points.size());
}
