// SPDX-License-Identifier: GPL-3.0-or-later
// Capsules and balls of a [[contact]] that touch one another: gaps against distances that a search finds; energy and
// momenta of impacts.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Two capsules and a ball that move without forces. `rotation` of B: about E1, or E2 as that of A.
std::string capsules(const std::string& about, const std::string& scene) {
  const auto body = [](const std::string& name, const std::string& n, const std::string& axis) {
    return "[[body]]\nname = \"" + name + "\"\nmass = \"m\"\ninertia = \"I\"\nposition = { cartesian = [\"x" + n +
           "\", \"y" + n + "\", \"z" + n + "\"] }\nrotation = { axis = \"" + axis + "\", angle = \"q" + n + "\" }\n";
  };
  return "format = 1\n[parameters]\nm = 2\nI = 0.1\nR = 0.1\nL = 0.8\n" + body("A", "a", "E2") + body("B", "b", about) +
         "[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"xp\", \"0\", \"zp\"] }\n[[contact]]\nname "
         "= \"c\"\n"
         "capsules = { A = [\"R\", \"L\"], B = [0.05, 1.2], P = 0.02 }\nrestitution = 1\n[scene.default]\n" +
         scene + "rtol = 1e-12\natol = 1e-13\n";
}

using Point = std::array<double, 3>;

/// The least distance of two segments, by a search along the first and the nearest point of the second.
double distance(const Point& a, const Point& u, double la, const Point& b, const Point& v, double lb) {
  const auto from = [&](double s) {
    double along = 0, square = 0;
    for (std::size_t k = 0; k < 3; ++k) along += v[k] * (a[k] + s * u[k] - b[k]);
    along = std::min(lb / 2, std::max(-lb / 2, along));
    for (std::size_t k = 0; k < 3; ++k) square += std::pow(a[k] + s * u[k] - b[k] - along * v[k], 2);
    return std::sqrt(square);
  };
  double low = -la / 2, high = la / 2;  // the distance is convex in s
  for (int i = 0; i < 200; ++i) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    (from(left) < from(right) ? high : low) = from(left) < from(right) ? right : left;
  }
  return from((low + high) / 2);
}

}  // namespace

TEST_CASE("capsules: gaps of tumbling capsules and of a ball are distances that a search finds") {
  const Folder folder;
  folder.write("model.toml",
               capsules("E1",
                        "t = [0, 4]\ninitial = { ya = -1, ya_dot = 0.15, za = 0.1, qa = 0, qa_dot = 3, "
                        "xb = 1.05, xb_dot = -0.2, zb = -0.5, zb_dot = 0.1, qb = 0.3, qb_dot = 2, xp = -1, zp = -1.3, "
                        "zp_dot = 0.2 }\noutputs = [\"gap.c_A_B\", \"gap.c_A_P\", \"gap.c_B_P\"]\n"));
  expect(0, folder, {"run", "model.toml", "--every", "0.01", "-o", "out.csv"});
  const Table table = read_table(folder.read("out.csv"));
  REQUIRE(table.rows.size() == 401);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Point a{table.at(i, "xa"), table.at(i, "ya"), table.at(i, "za")};
    const Point b{table.at(i, "xb"), table.at(i, "yb"), table.at(i, "zb")};
    const Point p{table.at(i, "xp"), 0, table.at(i, "zp")};
    const double qa = table.at(i, "qa"), qb = table.at(i, "qb");
    const Point u{std::sin(qa), 0, std::cos(qa)}, v{0, -std::sin(qb), std::cos(qb)};
    CAPTURE(i);
    CHECK(std::abs(table.at(i, "gap.c_A_B") - (distance(a, u, 0.8, b, v, 1.2) - 0.15)) < 1e-12);
    CHECK(std::abs(table.at(i, "gap.c_A_P") - (distance(p, u, 0, a, u, 0.8) - 0.12)) < 1e-12);
    CHECK(std::abs(table.at(i, "gap.c_B_P") - (distance(p, u, 0, b, v, 1.2) - 0.07)) < 1e-12);
  }
}

// The axes turn in one plane, so that momentum in the plane and angular momentum across it are conserved.
TEST_CASE("capsules: an elastic impact keeps energy and momenta, and happens where the distance is 0") {
  const Folder folder;
  folder.write("model.toml",
               capsules("E2",
                        "t = [0, 1.6]\ninitial = { qa = 0.4, qa_dot = 1, xb = 1.5, xb_dot = -0.8, zb = 0.1, qb = -0.7, "
                        "qb_dot = 0.3, xp = -1, zp = -1.3 }\n"));
  const Json run = document(folder, {"run", "model.toml", "--every", "1.6", "-o", "out.csv"});
  REQUIRE(run["events"].size() >= 1);
  CHECK(std::abs(run["power_balance"].get<double>()) < 1e-11);
  const Json* hit = nullptr;
  for (const Json& event : run["events"])
    if (event["kind"] == "contact" && hit == nullptr) hit = &event;
  REQUIRE(hit != nullptr);
  CHECK((*hit)["name"] == "c_A_B");
  CHECK(std::abs(run["contact_work"].get<double>()) < 1e-12);
  const double t = (*hit)["t"], qa = 0.4 + t, qb = -0.7 + 0.3 * t;
  const double gap = distance({0, 0, 0}, {std::sin(qa), 0, std::cos(qa)}, 0.8, {1.5 - 0.8 * t, 0, 0.1},
                              {std::sin(qb), 0, std::cos(qb)}, 1.2) -
                     0.15;
  CHECK(std::abs(gap) < 1e-10);
  const Table table = read_table(folder.read("out.csv"));
  const auto momenta = [&](std::size_t row) {
    std::array<double, 3> sum{};
    for (const std::string n : {"a", "b"}) {
      const auto at = [&](const std::string& name) { return table.at(row, name); };
      sum[0] += 2 * at("x" + n + "_dot");
      sum[1] += 2 * at("z" + n + "_dot");
      sum[2] +=
          2 * (at("z" + n) * at("x" + n + "_dot") - at("x" + n) * at("z" + n + "_dot")) + 0.1 * at("q" + n + "_dot");
    }
    return sum;
  };
  for (std::size_t k = 0; k < 3; ++k)
    CHECK(std::abs(momenta(table.rows.size() - 1)[k] - momenta(0)[k]) < 1e-11);  // of 1.6
  CHECK(std::abs(table.at(table.rows.size() - 1, "qb_dot") - 0.3) > 0.1);        // it was hit off its centre
}

TEST_CASE("capsules: axes become parallel side by side, where the nearest points jump, while the pair is open") {
  const Folder folder;
  folder.write(
      "model.toml",
      capsules("E2", "t = [0, 0.4]\ninitial = { qa = 0.8, qa_dot = 1, xb = 0.6, zb = -0.4, qb = 1, xp = -3 }\n"));
  const Json run = document(folder, {"run", "model.toml"});
  CHECK(run["outcome"] == "done");
  CHECK(run["events"].empty());
  CHECK(run["final"]["qa"].get<double>() == doctest::Approx(1.2).epsilon(1e-12));
}

TEST_CASE("capsules: one alone, wrong sizes and friction are refused with a remedy") {
  const auto refused = [](const std::string& contact, const char* what) {
    const Folder folder;
    folder.write("model.toml",
                 "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"y\", \"z\"] "
                 "}\n[[particle]]\nname = \"Q\"\nmass = 1\nposition = { cartesian = [\"a\", \"b\", \"c\"] "
                 "}\n[[contact]]\nname = \"c\"\n" +
                     contact);
    const ChildResult result = expect(2, folder, {"check", "model.toml"});
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused("capsules = { P = 1 }\n", "needs two capsules or balls");
  refused("capsules = { P = 1, Q = [1, 2, 3] }\n", "gives 3 sizes of 'Q'");
  refused("capsules = { P = 1, Q = 2 }\nfriction = { static = 1, dynamic = 1 }\n", "'P' is no body");
}
