// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of a [[contact]]: the times at which falling bodies and particles touch, by the height of their shape; energy.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

namespace {

constexpr double g = 9.81, tilt = 0.6, start = 2;

/// A body that falls from rest at the height 2, with its axis e3 at the angle 0.6 to the vertical.
std::string falling(const std::string& shape, const std::string& on = "\"ground\"") {
  return "format = 1\n[parameters]\nm = 1\ng = 9.81\nR = 0.3\nL = 0.8\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = "
         "{ "
         "principal = [0.1, 0.1, 0.05] }\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\nrotation = { axis = "
         "\"E2\", "
         "angle = \"q\" }\n[[force]]\ngravity = \"-g*E3\"\n[[contact]]\nname = \"c\"\nbody = \"B\"\nshape = { " +
         shape + " }\non = " + on +
         "\nrestitution = 1\n[scene.default]\nt = [0, 0.8]\ninitial = { z = 2, q = 0.6 }\nrtol = 1e-11\natol = 1e-12\n";
}

struct Touch {
  std::string name;
  double t;
};

Touch first_touch(const Folder& folder, const std::string& text) {
  folder.write("model.toml", text);
  const Json run = document(folder, {"run", "model.toml"});
  CHECK(std::abs(run["power_balance"].get<double>()) < 1e-8);
  for (const Json& event : run["events"]) {
    if (event["kind"] == "contact") return {event["name"], event["t"]};
  }
  return {"", -1};
}

void falls_to(const Folder& folder, const std::string& text, const std::string& name, double height) {
  CAPTURE(text);
  const Touch touch = first_touch(folder, text);
  CHECK(touch.name == name);
  CHECK(touch.t == doctest::Approx(std::sqrt(2 * (start - height) / g)).epsilon(1e-9));
}

/// `check` refuses the model, with a message that contains this.
void refused(const std::string& text, const char* what) {
  const Folder folder;
  folder.write("model.toml", text);
  const ChildResult result = expect(2, folder, {"check", "model.toml"});
  CHECK(contains(result.err, what));
  CHECK(contains(result.err, "remedy: "));
}

}  // namespace

TEST_CASE("shapes: a falling body touches the ground where its shape has its lowest point, and keeps its energy") {
  const Folder folder;
  const double s = std::sin(tilt), c = std::cos(tilt), R = 0.3, L = 0.8;
  falls_to(folder, falling("sphere = \"R\""), "c_1", R);
  falls_to(folder, falling("disk = \"R\""), "c_1", R * s);
  falls_to(folder, falling("capsule = [\"R\", \"L\"]"), "c_2", R + L / 2 * c);
  falls_to(folder, falling("cylinder = [\"R\", \"L\"]"), "c_2", R * s + L / 2 * c);
  falls_to(folder, falling("cone = [\"R\", \"L\"]"), "c_2", R * s + L / 4 * c);
  falls_to(folder, falling("ellipsoid = [\"R\", 0.1, \"L/2\"]"), "c_1", std::hypot(R * s, L / 2 * c));
  // A plane at the height 0.5 that is written with a normal of length 3.
  falls_to(folder, falling("capsule = [\"R\", \"L\"]", "{ point = \"0.5*E3\", normal = \"3*E3\" }"), "c_2",
           0.5 + R + L / 2 * c);
}

TEST_CASE("shapes: a capsule on a slope touches at the distance along the normal of the slope") {
  const Folder folder;
  const double a = 0.2, R = 0.3, L = 0.8;  // slope; the axis has the angle 0.6 to E3
  const double along = std::sin(tilt) * -std::sin(a) + std::cos(tilt) * std::cos(a);  // e3 . n
  falls_to(folder,
           falling("capsule = [\"R\", \"L\"]", "{ point = \"origin\", normal = \"-sin(0.2)*E1 + cos(0.2)*E3\" }"),
           "c_2", (R + L / 2 * along) / std::cos(a));
}

TEST_CASE("shapes: particles meet planes, spheres, shells, cylinders, cones and surfaces where these are") {
  const Folder folder;
  const auto particle = [](const std::string& on, const std::string& more) {
    return "format = 1\n[parameters]\nm = 1\ng = 9.81\nS = 0.7\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { "
           "cartesian = [\"x\", \"y\", \"z\"] }\n[[force]]\ngravity = \"-g*E3\"\n[[contact]]\nname = \"c\"\nparticles "
           "= "
           "[\"P\"]\non = " +
           on + "\nrestitution = 0.5\n" + more +
           "[scene.default]\nt = [0, 0.8]\ninitial = { x = 0.2, y = 0.1, z = 2 }\nrtol = 1e-11\natol = 1e-12\n";
  };
  const double x = 0.2, y = 0.1, S = 0.7, r = 0.05;
  falls_to(folder, particle("{ sphere = \"S\", centre = \"0.3*E3\" }", "radius = 0.05\n"), "c_P",
           0.3 + std::sqrt((S + r) * (S + r) - x * x - y * y));
  falls_to(folder, particle("{ hollow = 3, centre = \"2*E3\" }", "radius = 0.05\n"), "c_P",
           2 - std::sqrt((3 - r) * (3 - r) - x * x - y * y));
  falls_to(folder, particle("{ cylinder = \"S\", point = \"0.1*E2\", axis = \"2*E1\" }", "radius = 0.05\n"), "c_P",
           S + r);
  falls_to(folder, particle("\"ground\"", "radius = 0.05\n"), "c_P", r);
  falls_to(folder,
           particle("{ point = \"0.4*E3\", normal = \"E3 - 0.5*E1\" }",
                    "radius = 0.05\nfriction = { static = 0.3, dynamic = 0.3 }\n"),
           "c_P", 0.4 + 0.5 * x + r * std::hypot(1, 0.5));
  falls_to(folder, particle("{ cone = \"0.5\", apex = \"E3\", axis = \"-E3\" }", ""), "c_P",
           1 - std::hypot(x, y) / std::tan(0.5));
  falls_to(folder, particle("{ surface = \"0.3*sin(2*x) + y^2\" }", "friction = { static = 0.3, dynamic = 0.3 }\n"),
           "c_P", 0.3 * std::sin(2 * x) + y * y);
}

TEST_CASE("shapes: a ball leaves a sphere at two thirds of the height of its centre") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[parameters]\nm = 1\ng = 9.81\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { "
      "cartesian = [\"x\", 0, \"z\"] }\n[[force]]\ngravity = \"-g*E3\"\n[[contact]]\nname = \"c\"\nparticles = "
      "[\"P\"]\nradius = 0.1\non = { sphere = 0.9, centre = \"0*E1\" }\n[[event]]\nname = \"low\"\nwhen = \"z - "
      "2/3\"\n[scene.default]\nt = [0, 5]\ninitial = { x = 0.001 }\nguess = { z = 1 }\nrtol = 1e-11\natol = "
      "1e-12\n");
  const Json run = document(folder, {"run", "model.toml"});
  double left = -1, low = -2;
  for (const Json& event : run["events"]) {
    if (event["kind"] == "lose_contact") left = event["t"];
    if (event["name"] == "low") low = event["t"];
  }
  CHECK(std::abs(left - low) < 1e-6);  // it starts 5e-7 below the top
}

// A valley z = |x| with a rounded edge is narrower than the ball, which rolls down one side until it meets the other.
TEST_CASE("shapes: a ball that touches a surface at a second place ends the run there") {
  const Folder folder;
  const auto valley = [&](double edge) {
    folder.write(
        "model.toml",
        "format = 1\n[parameters]\nm = 1\nR = 0.2\ne = " + std::to_string(edge) +
            "\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = \"0.4*m*R^2\"\nposition = { cartesian = [\"x\", \"0\", "
            "\"z\"] }\nrotation = { axis = \"E2\", angle = \"q\" }\n[[force]]\ngravity = \"-9.81*E3\"\n[[contact]]\n"
            "name = \"c\"\nbody = \"B\"\nshape = { sphere = \"R\" }\non = { surface = \"sqrt(x^2 + e^2)\" }\n"
            "[scene.default]\nt = [0, 1]\ninitial = { x = 0.5, z = 1.1, z_dot = 0, x_dot = 0, q = 0 }\n");
    return expect(0, folder, {"run", "model.toml"}).out;
  };
  const std::string narrow = valley(0.02), wide = valley(0.5);
  CHECK(contains(narrow, "c_1_beside"));
  CHECK_FALSE(contains(wide, "c_1_beside"));
}

// The disk falls from rest, tilted, above a peak, a tip and the end of a capsule, which its face meets. The start of
// the place along the rim, and its rate, follow from the attitude.
TEST_CASE("shapes: what passes through the face of a disk ends the run, after the rim was nearest to a tip or an end") {
  const Folder folder;
  const double through = -0.02 * 0.3, c = std::cos(tilt);
  const auto ends = [&](const std::string& text, double t) {
    CAPTURE(text);
    folder.write("model.toml", text);
    const Json run = document(folder, {"run", "model.toml"});
    CHECK(run["outcome"] == "stopped_by_event");
    REQUIRE(run["events"].size() == 1);
    CHECK(run["events"][0]["name"] == "c_beside");
    CHECK(run["events"][0]["t"].get<double>() == doctest::Approx(t).epsilon(1e-9));
    CHECK(run["final"]["q"].get<double>() == doctest::Approx(tilt));
  };
  ends(falling("disk = \"R\"", "{ surface = \"0.4*exp(-(x^2 + y^2)/0.003)\" }"),
       std::sqrt(2 * (start - 0.4 - through) / g));
  ends(falling("disk = \"R\"", "{ cone = \"0.3\", apex = \"0*E1\", axis = \"-E3\" }"),
       std::sqrt(2 * (start - through / c) / g));
  const double height = 1, length = 0.4, radius = 0.03, speed = 3;
  const std::string with_capsule = replaced(
      replaced(falling("disk = \"R\"", "\"C\"\nshape_b = { capsule = [0.03, 0.4] }"), "[[force]]",
               "[[body]]\nname = \"C\"\nmass = \"m\"\ninertia = { rod = 0.4 }\nposition = { cartesian = [\"0\", \"0\", "
               "\"s\"] }\nrotation = { axis = \"E1\", angle = \"w\" }\n[[force]]"),
      "initial = {", "initial = { s = 1, s_dot = 3,");
  ends(with_capsule, (start - height - length / 2 - (radius + through) / c) / speed);
}

TEST_CASE("shapes: unknown kinds, wrong sizes and missing keys are refused with a remedy") {
  refused(falling("torus = \"R\""), "names no shape");
  refused(falling("capsule = \"R\""), "gives the sizes of the capsule as");
  refused(falling("capsule = [\"R\"]"), "gives 1 sizes of the capsule");
  refused(falling("sphere = -0.1"), "a length of a shape in contact is negative");
  refused(falling("capsule = [\"R\", \"-L\"]"), "a length of a shape in contact is negative");
  refused(falling("sphere = \"R\"", "\"B\""), "has no shape_b");
  refused(falling("sphere = \"R\"", "\"B\"\nshape_b = { sphere = 1 }"), "cannot touch itself");
  refused(falling("cylinder = [\"R\", \"L\"]", "{ sphere = 1, centre = \"-E3\" }"), "touches planes only");
  refused(falling("disk = \"R\"", "\"B\"\nshape_b = { disk = 1 }"), "no closed form");
  refused(falling("sphere = \"R\"", "{ sphere = 1, centre = \"t*E3\" }\nfriction = { static = 1, dynamic = 1 }"),
          "an obstacle with friction");
}

namespace {

/// A rod that falls without turning on its lower tip, which slips with 0.3 m/s. Its slip reverses in compression.
std::string falling_rod(const std::string& impacts, double mu, double e) {
  return "format = 1\n[parameters]\nm = 1\nL = 0.8\nmu = " + std::to_string(mu) + "\ne = " + std::to_string(e) +
         "\n[[body]]\nname = \"rod\"\nmass = \"m\"\ninertia = { principal = [\"m*L^2/12\", \"m*L^2/12\", \"m*L^2/12\"] "
         "}\nposition = { cartesian = [\"x\", \"y\"] }\nrotation = { axis = \"E3\", angle = \"q\" "
         "}\n[[force]]\ngravity "
         "= \"-9.81*E2\"\n[[contact]]\nname = \"tip\"\nbody = \"rod\"\npoints = { a = \"L/2*rod.e1\", b = "
         "\"-L/2*rod.e1\" }\non = { point = \"origin\", normal = \"E2\" }\nrestitution = \"e\"\nfriction = { static = "
         "\"mu\", dynamic = \"mu\" }\n[impacts]\n" +
         impacts +
         "\n[scene.default]\nt = [0, 0.31]\ninitial = { y = 0.7, q = 0.7, x_dot = 0.3 }\nrtol = 1e-11\natol = 1e-12\n";
}

/// Velocities (x, y, turning) after the impact of the rod, by small steps of the normal impulse.
std::array<double, 3> after_impact(double mu, double e) {
  const double q = 0.7, L = 0.8, I = L * L / 12, rx = -L / 2 * std::cos(q), ry = -L / 2 * std::sin(q);
  std::array<double, 3> v{0.3, -std::sqrt(2 * g * (0.7 - L / 2 * std::sin(q))), 0};
  const double step = 2e-6;
  double compression = 0, work = 0;
  for (bool compressing = true;;) {
    const double slip = v[0] - v[2] * ry, normal = v[1] + v[2] * rx;
    if (compressing && normal >= 0) compressing = false, compression = work, work = 0;
    if (!compressing && work >= -e * e * compression) return v;
    work += normal * step;
    const double friction = slip > 0 ? -mu * step : mu * step;
    v[0] += friction;
    v[1] += step;
    v[2] += (rx * step - ry * friction) / I;
  }
}

}  // namespace

TEST_CASE("impacts: Stronge's law follows the slip of a rod's tip through its reversal, and loses energy") {
  const Folder folder;
  for (const double e : {0.3, 0.5, 0.9}) {
    CAPTURE(e);
    folder.write("model.toml", falling_rod("law = \"stronge\"", 0.2, e));
    const Json run = document(folder, {"run", "model.toml"});
    const std::array<double, 3> expected = after_impact(0.2, e);
    CHECK(std::abs(run["final"]["x_dot"].get<double>() - expected[0]) < 1e-4);
    CHECK(std::abs(run["final"]["q_dot"].get<double>() - expected[2]) < 1e-4);
    CHECK(run["impacts"] == Json({{"law", "stronge"}, {"order", "sequence"}}));
    REQUIRE(run["events"].size() >= 1);
    CHECK(run["events"][0]["kind"] == "contact");
    CHECK(run["events"][0]["work"].get<double>() < 0);
    CHECK(std::abs(run["power_balance"].get<double>()) < 1e-9);
  }
}

TEST_CASE("impacts: without friction Stronge's, Poisson's and Newton's laws agree") {
  const Folder folder;
  const auto final = [&](const char* law) {
    folder.write("model.toml", falling_rod("law = \"" + std::string(law) + "\"", 0, 0.6));
    return document(folder, {"run", "model.toml"})["final"];
  };
  const Json stronge = final("stronge");
  for (const char* law : {"newton", "poisson"}) {
    const Json other = final(law);
    for (const char* state : {"x_dot", "y_dot", "q_dot"})
      CHECK(std::abs(stronge[state].get<double>() - other[state].get<double>()) < 1e-9);
  }
}

TEST_CASE("impacts: friction of a point that slides acts during restitution too, by every law with friction") {
  const Folder folder;
  // It falls by 1.25: the tangential impulse is mu (1 + e) times that of v = sqrt(2 g 1.25).
  const double mu = 0.2, e = 0.5, v = std::sqrt(2 * 9.81 * 1.25);
  for (const std::string law : {"moreau", "poisson", "stronge"}) {
    CAPTURE(law);
    folder.write("model.toml",
                 "format = 1\n[[particle]]\nname = \"P\"\nmass = 2\nposition = { cartesian = [\"x\", \"y\"] }\n"
                 "[[force]]\ngravity = \"-9.81*E2\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"y\"\nholds = "
                 "\"unilateral\"\nrestitution = 0.5\nfriction = { static = 0.2, dynamic = 0.2 }\n[impacts]\nlaw = \"" +
                     law + "\"\n[scene.default]\nt = [0, 0.7]\ninitial = { x_dot = 3, y = 1.25 }\n");
    const double x_dot = document(folder, {"run", "model.toml"})["final"]["x_dot"].get<double>();
    CHECK(x_dot == doctest::Approx(3 - mu * (1 + e) * v).epsilon(1e-10));  // exact but for the time of the impact
  }
}

TEST_CASE("contacts: gap.NAME is the value of a unilateral constraint, whatever the number of contacts") {
  const Folder folder;
  // One particle above a floor, or beside four walls; it falls from 1.25 and rests from 0.5 s on.
  const auto lines = [&](const std::string& walls, const std::string& outputs) {
    folder.write("model.toml",
                 "format = 1\n[[particle]]\nname = \"P\"\nmass = 2\nposition = { cartesian = [\"x\", \"y\"] }\n"
                 "[[force]]\ngravity = \"-9.81*E2\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"y - 0.1\"\nholds "
                 "= \"unilateral\"\nfriction = { static = 0.2, dynamic = 0.2 }\n" +
                     walls + "[scene.default]\nt = [0, 1]\ninitial = { x_dot = 0.1, y = 1.35 }\n");
    expect(0, folder, {"run", "model.toml", "--output", outputs, "--out", "a.csv"});
    return read_table(folder.read("a.csv"));
  };
  std::string walls;
  for (const char* wall : {"x + 3", "5 - x", "8 - y"}) {
    walls += "[[constraint]]\nname = \"wall" + std::to_string(walls.size()) + "\"\nholonomic = \"" + wall +
             "\"\nholds = \"unilateral\"\n";
  }
  for (const std::string& beside : {std::string(), walls}) {
    const Table table = lines(beside, "gap.floor,y");
    for (std::size_t k = 0; k < table.rows.size(); ++k)
      CHECK(table.at(k, "gap.floor") == doctest::Approx(table.at(k, "y") - 0.1).epsilon(1e-12));
    CHECK(table.at(0, "gap.floor") == doctest::Approx(1.25));
    CHECK(std::abs(table.at(table.rows.size() - 1, "gap.floor")) < 1e-12);
  }
  CHECK(contains(expect(2, folder, {"run", "model.toml", "--output", "gap.nothing"}).err, "gap.floor"));
}

TEST_CASE("contacts: end stops take what presses on them, and dry friction of the same coordinates the rest") {
  const Folder folder;
  const auto run = [&](const std::string& force, const std::string& scene) {
    folder.write(
        "model.toml",
        "format = 1\n[coordinates]\na = {}\nb = {}\n[energy]\nkinetic = \"a_dot^2/2 + b_dot^2/2 + "
        "0.3*a_dot*b_dot\"\n[[force]]\ngeneralized = { a = \"" +
            force +
            "\", b = \"-3\" }\n[[force]]\nname = \"fa\"\ndry = { coordinate = \"a\", normal = \"1.5\", static = "
            "0.4, dynamic = 0.35 }\n[[force]]\nname = \"fb\"\ndry = { coordinate = \"b\", normal = \"2\", "
            "static = 0.4, dynamic = 0.3 }\n[[contact]]\nname = \"s\"\nlimits = { a = [\"-1\", \"1\"], b = "
            "[\"-0.5\", \"0.9\"] }\nrestitution = 0.3\n[scene.default]\n" +
            scene + "\n");
    return document(folder, {"run", "model.toml", "--output", "reaction.s_a_upper,friction.fa", "--out", "a.csv"});
  };
  // Both are pressed on their stops for ever, after bounces that accumulate.
  const Json pressed = run("5", "t = [0, 4]\ninitial = { a_dot = 0.2 }");
  CHECK(pressed["outcome"] == "done");
  CHECK(pressed["final"]["a"].get<double>() == doctest::Approx(1).epsilon(1e-12));
  CHECK(pressed["final"]["b"].get<double>() == doctest::Approx(-0.5).epsilon(1e-12));
  // The push becomes a pull: the stop lets go at 0, and friction holds up to 0.4*1.5 = 0.6.
  const Json pulled = run("5*cos(t)", "t = [0, 2]\ninitial = { a = 1, b = -0.5 }");
  const Table table = read_table(folder.read("a.csv"));
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const double t = table.at(k, "t"), push = 5 * std::cos(t);
    CAPTURE(t);
    if (push < -0.6) continue;
    CHECK(std::abs(table.at(k, "reaction.s_a_upper")) == doctest::Approx(std::max(push, 0.0)).epsilon(1e-12));
    CHECK(table.at(k, "friction.fa") == doctest::Approx(std::max(-push, 0.0)).epsilon(1e-12));
  }
  REQUIRE(pulled["events"].size() == 2);
  for (const Json& event : pulled["events"])
    CHECK(event["t"].get<double>() == doctest::Approx(std::acos(-0.12)).epsilon(1e-8));  // far below a step
}

TEST_CASE("contacts: walls with normals along E1 and against it have friction, and mirrored throws are mirrored") {
  const Folder folder;
  const auto end = [&](const std::string& side, const std::string& sign) {
    folder.write(
        "box.toml",
        "format = 1\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { box = [0.4, 0.1, 0.2] }\nposition = { "
        "cartesian = [\"x\", 0, \"z\"] }\nrotation = { axis = \"E2\", angle = \"th\" }\n[[force]]\ngravity = "
        "\"-9.81*E3\"\n[[contact]]\nname = \"f\"\nbody = \"B\"\npoints = { l = \"-0.2*B.e1 - 0.1*B.e3\", r = "
        "\"0.2*B.e1 - 0.1*B.e3\" }\non = \"ground\"\nrestitution = 0.4\nfriction = { static = 0.5, dynamic = 0.3 "
        "}\n[[contact]]\nname = \"w\"\nbody = \"B\"\npoints = { r = \"" +
            side + "0.2*B.e1 - 0.1*B.e3\", ru = \"" + side + "0.2*B.e1 + 0.1*B.e3\" }\non = { point = \"" + side +
            "1*E1\", normal = \"" + (side.empty() ? "-E1" : "E1") +
            "\" }\nrestitution = 0.4\nfriction = { static = 0.5, dynamic = 0.3 }\n[impacts]\nlaw = "
            "\"moreau\"\n[scene.default]\nt = [0, 0.6]\ninitial = { z = 0.5, th = " +
            sign + "0.3, x_dot = " + sign + "2.5, th_dot = " + sign + "1 }\n");
    return document(folder, {"run", "box.toml"})["final"];
  };
  const Json right = end("", ""), left = end("-", "-");
  CHECK(right["x"].get<double>() < 0.9);  // it has bounced off the wall
  for (const char* mirrored : {"x", "th", "x_dot", "th_dot"})
    CHECK(left[mirrored].get<double>() == doctest::Approx(-right[mirrored].get<double>()).epsilon(1e-8));
  CHECK(left["z"].get<double>() == doctest::Approx(right["z"].get<double>()).epsilon(1e-8));
}

TEST_CASE("impacts: Stronge's law is refused for slip in two directions, and for simultaneous impacts") {
  refused(falling_rod("law = \"stronge\"\norder = \"simultaneous\"", 0.2, 0.5), "one contact at a time");
  std::string ball = falling("sphere = \"R\"");
  ball.replace(ball.find("restitution = 1"), 15,
               "restitution = 1\nfriction = { static = 0.2, dynamic = 0.2 }\n[impacts]\nlaw = \"stronge\"");
  refused(ball, "'c_1' can slip in two directions");
}

// More contacts than degrees of freedom, which cannot all be closed.
TEST_CASE("contacts: a mass between two stops with dry friction") {
  const Folder folder;
  folder.write(
      "model.toml",
      "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = { cartesian = [\"x\", \"0\"] }\n[[force]]\n"
      "name = \"rub\"\ndry = { coordinate = \"x\", normal = 9.81, static = 0.1, dynamic = 0.1 }\n[[contact]]\n"
      "name = \"stop\"\nlimits = { x = [-0.3, 0.35] }\nrestitution = 0.5\n"
      "[scene.default]\nt = [0, 2]\ninitial = { x = 0, x_dot = 1.5 }\n");
  const Json run = document(folder, {"run", "model.toml"});
  // It brakes at f over the ways to the stops, and rests between them.
  constexpr double f = 0.981;
  double v = std::sqrt(1.5 * 1.5 - 2 * f * 0.35), t = (1.5 - v) / f;
  REQUIRE(run["events"].size() == 3);
  CHECK(run["events"][0]["name"] == "stop_x_upper");
  CHECK(run["events"][0]["t"].get<double>() == doctest::Approx(t).epsilon(1e-10));
  v /= 2;
  CHECK(run["events"][1]["kind"] == "reverse");
  CHECK(run["events"][2]["kind"] == "stick");
  CHECK(run["events"][2]["t"].get<double>() == doctest::Approx(t + v / f).epsilon(1e-10));
  CHECK(run["final"]["x"].get<double>() == doctest::Approx(0.35 - v * v / (2 * f)).epsilon(1e-10));
}

// The outer two of three balls on a line never touch.
TEST_CASE("contacts: three balls on a line") {
  const Folder folder;
  std::string balls;
  for (const char* i : {"1", "2", "3"})
    balls += "[[particle]]\nname = \"p" + std::string(i) + "\"\nmass = 1\nposition = { cartesian = [\"x" + i +
             "\", \"0\"] }\n";
  folder.write("model.toml", "format = 1\n" + balls +
                                 "[[contact]]\nname = \"c\"\nspheres = [\"p1\", \"p2\", \"p3\"]\nradius = 0.02\n"
                                 "restitution = 1\n[scene.default]\nt = [0, 1]\ninitial = { x1 = 0.1, x2 = 0.25, x3 = "
                                 "0.45, x1_dot = 1 }\n");
  const Json run = document(folder, {"run", "model.toml"});
  REQUIRE(run["events"].size() == 2);  // equal masses exchange their speeds
  CHECK(run["events"][0]["t"].get<double>() == doctest::Approx(0.11).epsilon(1e-10));
  CHECK(run["events"][1]["t"].get<double>() == doctest::Approx(0.11 + 0.16).epsilon(1e-10));
  CHECK(run["final"]["x1"].get<double>() == doctest::Approx(0.21).epsilon(1e-10));
  CHECK(run["final"]["x3_dot"].get<double>() == doctest::Approx(1).epsilon(1e-10));
}

TEST_CASE("impacts: a smooth law of friction is refused where impacts have friction") {
  const Folder folder;
  const auto ball = [&](const std::string& law) {
    folder.write(
        "model.toml",
        "format = 1\n[[body]]\nname = \"b\"\nmass = 1\ninertia = 0.004\nposition = { cartesian = [\"x\", \"0\", "
        "\"z\"] }\nrotation = { axis = \"E2\", angle = \"th\" }\n[[force]]\ngravity = \"-9.81*E3\"\n[[contact]]\n"
        "name = \"floor\"\nbody = \"b\"\nshape = { sphere = 0.1 }\non = \"ground\"\nfriction = { dynamic = 0.3, "
        "law = \"smooth\", width = 1e-3 }\n[impacts]\nlaw = \"" +
            law + "\"\n[scene.default]\nt = [0, 0.1]\ninitial = { z = 1 }\n");
  };
  for (const char* law : {"poisson", "moreau", "stronge"}) {
    CAPTURE(std::string(law));
    ball(law);
    CHECK(contains(expect(2, folder, {"run", "model.toml"}).err,
                   "friction in impacts needs Coulomb's law, and that of 'floor_1' is smooth"));
  }
  ball("newton");
  expect(0, folder, {"run", "model.toml"});
}
