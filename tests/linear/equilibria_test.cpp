// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibria and steady motions against closed forms, with their stability.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "analysis/steady_search.hpp"
#include "linearised.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::test;
using linear::Stability;

namespace {

analysis::SteadyMotions found(const std::string& model, const std::map<std::string, symbolic::Rational>& hold = {},
                              const std::string& scene = "default", const std::string& more = "") {
  analysis::SteadyRequest request;
  std::string path = model_path(model);
  request.scene = scene;
  request.hold = hold;
  if (!more.empty()) {
    path = test::build_folder() + "/" + model + "_" + scene + "_steady.toml";
    write_text(path, read_text(model_path(model)) + more);
  }
  request.model = test::model_at(path);
  return analysis::steady_motions(request);
}

double value(const analysis::SteadyMotions& all, std::size_t point, const std::string& name) {
  const auto& names = all.problem.flow->names();
  return linear::to_double(
      all.points.at(point).l.z[static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())]);
}

const double pi = std::acos(-1.0);

}  // namespace

TEST_CASE("double pendulum: four equilibria; the hanging one is stable by its energy") {
  const analysis::SteadyMotions all = found("S5_double_pendulum");
  REQUIRE(all.points.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const double a = value(all, i, "theta1"), b = value(all, i, "theta2");
    same(a, a > 1 ? pi : 0);
    same(b, b > 1 ? pi : 0);
    CHECK(all.points[i].verdict.stability == (a + b > 1 ? Stability::unstable : Stability::stable));
    CHECK(all.points[i].family_dimension == 0);
    CHECK(all.points[i].l.kind == linear::MotionKind::equilibrium);
  }
}

TEST_CASE("cart and pendulum: with friction on the track the hanging one attracts") {
  const analysis::SteadyMotions all = found("cart_pendulum");
  REQUIRE(all.points.size() == 2);
  CHECK(all.held.empty());  // friction conserves no momentum
  CHECK(all.points[0].verdict.stability == Stability::stable);
  CHECK(all.points[1].verdict.stability == Stability::unstable);
  same(value(all, 1, "theta"), pi);
}

TEST_CASE("rotating hoop: two equilibria below the critical rate, four above, a pitchfork") {
  const analysis::SteadyMotions fast = found("rotating_hoop");
  REQUIRE(fast.points.size() == 4);
  const double beta = std::acos(9.81 / (0.5 * 36));
  const double expected[] = {-beta, 0, beta, pi};
  for (std::size_t i = 0; i < 4; ++i) {
    same(value(fast, i, "beta"), expected[i]);
    CHECK(fast.points[i].verdict.stability == (i % 2 == 0 ? Stability::stable : Stability::unstable));
  }
  same(fast.points[2].l.spectrum.values[0].im, 6 * std::sin(beta));
  const analysis::SteadyMotions slow =
      found("rotating_hoop", {}, "slow", "\n[scene.slow]\nfrom = \"default\"\nparameters = { w = 3 }\n");
  REQUIRE(slow.points.size() == 2);
  CHECK(slow.points[0].verdict.stability == Stability::stable);
}

// I cos(theta) p^2 - Ja s p + m g L = 0
TEST_CASE(
    "Lagrange top: at a tilt and spin the slow and the fast precession; at the momenta of a start the tilt that they "
    "have") {
  const analysis::SteadyMotions all =
      found("R10_lagrange_top", {{"theta", symbolic::Rational(3) / 5}, {"top.omega3", 150}});
  REQUIRE(all.points.size() == 2);
  const double I = 0.004 + 0.01, a = 0.002 * 150, weight = 9.81 * 0.1, c = std::cos(0.6),
               root = std::sqrt(a * a - 4 * I * c * weight);
  same(value(all, 0, "psi_dot"), (a - root) / (2 * I * c));
  same(value(all, 1, "psi_dot"), (a + root) / (2 * I * c));
  for (const analysis::SteadyMotion& point : all.points) {
    CHECK(point.l.kind == linear::MotionKind::steady);
    CHECK(point.verdict.stability == Stability::stable);
    CHECK(point.l.structural_zeros == 4);
  }
  const analysis::SteadyMotions kept = found("R10_lagrange_top");
  REQUIRE(kept.points.size() == 1);
  REQUIRE(kept.held.size() == 2);
  const double t = value(kept, 0, "theta"), p = value(kept, 0, "psi_dot"),
               w = value(kept, 0, "phi_dot") + p * std::cos(t);
  same(w, 150);
  same(I * p * std::pow(std::sin(t), 2) + a * std::cos(t), a * c);  // the start does not precess
}

TEST_CASE("rolling disk: a circle at the start's tilt and rate of turning, one of a family of two dimensions") {
  const analysis::SteadyMotions all = found("R6_rolling_disk");
  REQUIRE(all.points.size() == 1);
  CHECK(all.points[0].family_dimension == 2);
  const double m = 0.5, R = 0.2, g = 9.81, A = m * R * R / 4, K = 3 * m * R * R / 2, s = std::sin(1.2),
               c = std::cos(1.2), p = 0.5;
  same(value(all, 0, "psi_dot"), (A * p * p * s * c - m * g * R * c) / (K * p * s) - p * c);
  CHECK(all.points[0].verdict.stability == Stability::unknown);  // its two further integrals are not found
}

TEST_CASE("sleigh: straight ahead is stable, astern is not") {
  const char* const scenes =
      "\n[scene.ahead]\nfrom = \"default\"\ninitial = { x1_dot = 5, phi_dot = 0 }\n"
      "[scene.astern]\nfrom = \"default\"\ninitial = { x1_dot = -5, phi_dot = 0 }\n";
  for (const char* scene : {"ahead", "astern"}) {
    const analysis::SteadyMotions all = found("R13_sleigh", {}, scene, scenes);
    REQUIRE(all.points.size() == 1);
    CHECK(all.points[0].family_dimension == 2);  // direction, speed
    CHECK(all.points[0].verdict.stability == (scene == std::string("ahead") ? Stability::stable : Stability::unstable));
  }
}

TEST_CASE("a degenerate equilibrium is not called stable by its linear terms") {
  const std::string path = test::build_folder() + "/degenerate.toml";
  // x' = v, v' = -v + x^3: the zero eigenvalue is no family, and x = 0 is unstable.
  write_text(path,
             "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"-x^4/4\"\n"
             "[[force]]\ngeneralized = { x = \"-x_dot\" }\n[scene.default]\ninitial = { x = 0 }\n");
  analysis::SteadyRequest request;
  request.model = test::model_at(path);
  const analysis::SteadyMotions all = analysis::steady_motions(request);
  REQUIRE(!all.points.empty());
  for (const analysis::SteadyMotion& point : all.points) CHECK(point.verdict.stability == Stability::unknown);
}

namespace {

analysis::SteadyMotions found_in(const std::string& name, const std::string& text, std::uint64_t seed = 1) {
  const std::string path = test::build_folder() + "/" + name + "_steady.toml";
  write_text(path, text);
  analysis::SteadyRequest request;
  request.model = test::model_at(path);
  request.seed = seed;
  return analysis::steady_motions(request);
}

/// n particles of 1 kg on massless rods of 1 m, with the angles of the rods from the vertical.
std::string chain_pendulum(int n) {
  std::string coordinates = "[coordinates]\n", particles, x = "0", y = "0";
  for (int k = 1; k <= n; ++k) {
    coordinates += fmt::format("th{} = \"rad\"\n", k);
    x += fmt::format(" + sin(th{})", k);
    y += fmt::format(" - cos(th{})", k);
    particles += fmt::format("[[particle]]\nname = \"p{}\"\nmass = 1\nposition = [\"{}\", \"{}\", 0]\n", k, x, y);
  }
  return "format = 1\n" + coordinates + particles + "[[force]]\ngravity = \"-9.81*E2\"\n";
}

}  // namespace

TEST_CASE("a pendulum of six links has an equilibrium for each choice of up and down, and one of them is stable") {
  const analysis::SteadyMotions all = found_in("six_links", chain_pendulum(6));
  REQUIRE(all.points.size() == 64);
  CHECK(all.search.converged == 300);
  int stable = 0;
  for (const analysis::SteadyMotion& point : all.points) stable += point.verdict.stability == Stability::stable ? 1 : 0;
  CHECK(stable == 1);
}

TEST_CASE("the minimum of a well of a width of 1e-6 is found, and is stable") {
  for (const char* well : {"sqrt(x^2 + 1e-12)", "sqrt((x - 2)^2 + 1e-12) + x/2"}) {
    CAPTURE(std::string(well));
    const analysis::SteadyMotions all = found_in(
        "well", std::string("format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = "
                            "\"") +
                    well + "\"\n[scene.default]\ninitial = { x = 0.3 }\n");
    REQUIRE(all.points.size() == 1);
    CHECK(all.points[0].verdict.stability == Stability::stable);
    CHECK(all.search.converged > 270);
  }
}

TEST_CASE("a pendulum above three magnets has seven equilibria, whatever the seed") {
  // U'(x) on the axis of symmetry y = 0 has three zeros: the centre, a saddle beside it and a well. Turned by 120
  // degrees, the last two give three each.
  const std::string text = R"toml(format = 1
[coordinates]
x = {}
y = {}
[energy]
kinetic = "(x_dot^2 + y_dot^2)/2"
potential = "(x^2 + y^2)/2 - 1/sqrt((x - 1)^2 + y^2 + 0.0625) - 1/sqrt((x + 0.5)^2 + (y - sqrt(3)/2)^2 + 0.0625) - 1/sqrt((x + 0.5)^2 + (y + sqrt(3)/2)^2 + 0.0625)"
)toml";
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const analysis::SteadyMotions all = found_in("magnets", text, seed);
    CHECK(all.points.size() == 7);
    CHECK(all.search.new_point_probability().value() < 0.02);
  }
}

TEST_CASE("Sarrus' linkage: the plate rests where the spring carries it and half of the arms, z = l - (M + 2 m) g/k") {
  analysis::SteadyRequest request;
  request.model = test::model_at(model_path("six_bar_spatial"));
  request.starts = 6;
  const analysis::SteadyMotions all = analysis::steady_motions(request);
  bool is_found = false;
  for (std::size_t k = 0; k < all.points.size(); ++k) {
    const bool folded = std::abs(value(all, k, "psi")) < 1e-9 && std::abs(value(all, k, "phi")) < 1e-9 &&
                        std::abs(value(all, k, "x")) < 1e-9 && std::abs(value(all, k, "y")) < 1e-9;
    is_found = is_found || (folded && std::abs(value(all, k, "z") - (0.8 - 2.3 * 9.81 / 150)) < 1e-12);
  }
  CHECK(is_found);
}

TEST_CASE("bicycle: a steady motion and its turn by half a turn, in the other triple of Euler angles, are one") {
  analysis::SteadyRequest request;
  request.model = test::model_at(source_folder() + "/tests/linear/models/bicycle.toml");
  request.starts = 40;
  const analysis::SteadyMotions all = analysis::steady_motions(request);
  REQUIRE(all.points.size() >= 4);
  // A turn about the vertical changes none of these: how upright the frame is, and speeds.
  const auto upright = [&](std::size_t k) {
    return std::cos(value(all, k, "roll")) * std::cos(value(all, k, "pitch"));
  };
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      double distance = std::abs(upright(i) - upright(k));
      for (const char* name : {"steer", "z", "yaw_dot", "p_rear_dot"})
        distance = std::max(distance, std::abs(value(all, i, name) - value(all, k, name)));
      CAPTURE(i);
      CAPTURE(k);
      CHECK(distance > 1e-6);
    }
  }
}
