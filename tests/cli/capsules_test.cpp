// SPDX-License-Identifier: GPL-3.0-or-later
// Capsules and balls of a [[contact]] that touch one another: gaps against distances that a search finds; energy and
// momenta of impacts; friction of two capsules beside a motion that the test integrates itself.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

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

namespace {

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
Point operator-(const Point& a, const Point& b) { return a + -1.0 * b; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double norm(const Point& a) { return std::sqrt(dot(a, a)); }

/// Two rods whose lines cross: places, directions of their axes, velocities and angular velocities.
struct Rods {
  std::array<Point, 2> x, u, v, w;
};
Rods shifted(const Rods& a, double h, const Rods& rate) {
  Rods r = a;
  for (std::size_t k = 0; k < 2; ++k) {
    r.x[k] = a.x[k] + h * rate.x[k], r.u[k] = a.u[k] + h * rate.u[k];
    r.v[k] = a.v[k] + h * rate.v[k], r.w[k] = a.w[k] + h * rate.w[k];
  }
  return r;
}

constexpr double m_rod = 2, I_rod = 0.1, push = 5, mu = 0.3, radii = 0.15, r_first = 0.1;

/// Rates of the rods, which slide on one another: the normal force keeps the distance of the lines, d . n with the unit
/// normal n across both, and friction is against the slip of the points that touch.
Rods sliding(const Rods& a) {
  const Point across = cross(a.u[0], a.u[1]), d = a.x[0] - a.x[1];
  const double side = dot(d, across) > 0 ? 1 : -1, sine = norm(across);
  const Point n = side / sine * across;
  // d + s u - t v is along n.
  const double s = -dot(cross(d, a.u[1]), across) / (sine * sine), t = -dot(cross(d, a.u[0]), across) / (sine * sine);
  const std::array<Point, 2> arm{s * a.u[0] - r_first * n, t * a.u[1] + (radii - r_first) * n};
  const Point slip = a.v[0] + cross(a.w[0], arm[0]) - a.v[1] - cross(a.w[1], arm[1]);  // along n only by rounding
  const Point F = n - mu / norm(slip) * slip;
  const auto rates = [&](double N) {
    Rods r;
    for (std::size_t k = 0; k < 2; ++k) {
      const double sign = k == 0 ? 1 : -1;
      r.x[k] = a.v[k], r.u[k] = cross(a.w[k], a.u[k]);
      r.v[k] = sign / m_rod * (N * F - Point{0, 0, push});
      r.w[k] = sign * N / I_rod * cross(arm[k], F);
    }
    return r;
  };
  // The second derivative of the distance along a motion with these accelerations, by differences; affine in N.
  const auto curvature = [&](double N) {
    const Rods r = rates(N);
    const auto distance = [&](double h) {
      std::array<Point, 2> x, u;
      for (std::size_t k = 0; k < 2; ++k) {
        x[k] = a.x[k] + h * a.v[k] + h * h / 2 * r.v[k];
        const Point turn = cross(r.w[k], a.u[k]) + cross(a.w[k], cross(a.w[k], a.u[k]));
        u[k] = a.u[k] + h * r.u[k] + h * h / 2 * turn;
      }
      const Point c = cross(u[0], u[1]);
      return side * dot(x[0] - x[1], c) / norm(c);
    };
    const auto second = [&](double h) { return (distance(h) - 2 * distance(0) + distance(-h)) / (h * h); };
    return (4 * second(1e-3) - second(2e-3)) / 3;
  };
  const double at_0 = curvature(0), at_1 = curvature(1);
  return rates(at_0 / (at_0 - at_1));
}

}  // namespace

TEST_CASE("capsules: one slides over another with friction as Newton's and Euler's equations state") {
  const Folder folder;
  const auto body = [](const std::string& n, const std::string& force) {
    return "[[body]]\nname = \"" + n +
           "\"\nmass = 2\ninertia = { principal = [0.1, 0.1, 0.1] }\nposition = { "
           "cartesian = [\"x" +
           n + "\", \"y" + n + "\", \"z" + n + "\"] }\nrotation = { euler_parameters = [\"p" + n + "\", \"q" + n +
           "\", \"r" + n + "\", \"s" + n + "\"] }\n[[force]]\non = \"" + n + "\"\nforce = \"" + force + "*E3\"\n";
  };
  // A lies along E1 upon B, which lies along E2. A moves and turns about E3.
  folder.write(
      "model.toml",
      "format = 1\n" + body("A", "-5") + body("B", "5") +
          "[[contact]]\nname = \"c\"\ncapsules = { A = [0.1, 0.8], B = [0.05, 1.2] }\nfriction = { static = 0.3, "
          "dynamic = 0.3 }\n[scene.default]\nt = [0, 0.25]\ninitial = { zA = 0.15, xA_dot = 0.5, yA_dot = 0.3, pA "
          "= \"sqrt(1/2)\", qA = 0, rA = \"sqrt(1/2)\", sA = 0, qA_dot = \"-0.4*sqrt(1/2)\", sA_dot = "
          "\"0.4*sqrt(1/2)\", xB = 0.1, yB = -0.2, zB = 0, pB = \"sqrt(1/2)\", qB = \"-sqrt(1/2)\", rB = 0, sB = 0 "
          "}\nrtol = 1e-11\natol = 1e-12\noutputs = [\"gap.c_A_B\", \"mode.c_A_B\", \"slip.c_A_B.1\", "
          "\"slip.c_A_B.2\"]\n");
  const Json run = document(folder, {"run", "model.toml", "--every", "0.25", "-o", "out.csv"});
  CHECK(run["outcome"] == "done");
  CHECK(run["events"].empty());  // it slides all the time
  CHECK(std::abs(run["power_balance"].get<double>()) < 1e-8);

  Rods rods{{{{0, 0, 0.15}, {0.1, -0.2, 0}}}, {{{1, 0, 0}, {0, 1, 0}}}, {{{0.5, 0.3, 0}, {}}}, {{{0, 0, 0.8}, {}}}};
  const int steps = 500;
  for (int i = 0; i < steps; ++i) {
    const double h = 0.25 / steps;
    const Rods k1 = sliding(rods), k2 = sliding(shifted(rods, h / 2, k1)), k3 = sliding(shifted(rods, h / 2, k2)),
               k4 = sliding(shifted(rods, h, k3));
    rods = shifted(shifted(shifted(shifted(rods, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
  }
  const Table table = read_table(folder.read("out.csv"));
  const std::size_t last = table.rows.size() - 1;
  CHECK(std::abs(table.at(last, "gap.c_A_B")) < 1e-10);
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string n = k == 0 ? "A" : "B";
    const auto at = [&](const std::string& name) { return table.at(last, name + n); };
    const double p = at("p"), q = at("q"), r = at("r"), s = at("s");
    const Point x{at("x"), at("y"), at("z")},
        e3{2 * (q * s + p * r), 2 * (r * s - p * q), p * p - q * q - r * r + s * s};
    CHECK(norm(x - rods.x[k]) < 1e-8);  // differences of differences are good to 1e-9 of the force
    CHECK(norm(e3 - rods.u[k]) < 1e-8);
  }
  CHECK(norm(rods.v[0] - Point{0.5, 0.3, 0}) > 0.1);  // friction had an effect
}
