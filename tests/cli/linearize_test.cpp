// SPDX-License-Identifier: GPL-3.0-or-later
// Command linearize: document, text and refusals. Its numbers are tested in tests/linear.
#include <doctest/doctest.h>

#include <cmath>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("linearize: states, A, B, eigenvalues and structural zeros") {
  const Folder folder;
  const Json found = document(folder, {"linearize", "cart_pendulum"});
  CHECK(found["states"] == Json({"x", "theta", "x_dot", "theta_dot"}));
  CHECK(found["inputs"] == Json({"F"}));
  CHECK(found["kind"] == "motion");
  CHECK(found["structural_zeros"] == 1);
  CHECK(found["ignorable"] == Json({"x"}));
  REQUIRE(found["A"].size() == 4);
  REQUIRE(found["B"].size() == 4);
  CHECK(found["A"][0] == Json({0.0, 0.0, 1.0, 0.0}));
  CHECK(found["eigenvalues"].size() == 4);
  const std::string text = expect(0, folder, {"linearize", "cart_pendulum"}).out;
  CHECK(contains(text, "neither an equilibrium nor a steady motion"));
  CHECK(contains(text, "1 structural"));
  CHECK(document(folder, {"linearize", "R13_sleigh", "--scene", "straight"})["dependent"] == Json({"x2_dot"}));
}

TEST_CASE("linearize: another parameter, another time") {
  const Folder folder;
  folder.write("drop.toml",
               "format = 1\n[parameters]\nk = 4\nc = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = "
               "\"x_dot^2/2\"\npotential = \"k*x^2/2 + x^4/12\"\n"
               "[[force]]\ngeneralized = { x = \"-c*x_dot\" }\n[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n");
  CHECK(document(folder, {"linearize", "drop.toml"})["A"][1][0] == -5.0);
  CHECK(document(folder, {"linearize", "drop.toml", "--set", "k=9"})["A"][1][0] == -10.0);
  const Json later = document(folder, {"linearize", "drop.toml", "--at", "0.5"});
  CHECK(later["t"] == 0.5);
  CHECK(later["A"][1][0].get<double>() ==
        doctest::Approx(-4 - std::pow(later["point"]["x"].get<double>(), 2)).epsilon(1e-14));
  CHECK(later["kind"] == "motion");
  // The motion comes to rest: within the tolerance of the run, the state is the equilibrium.
  const Json rest = document(folder, {"linearize", "drop.toml", "--at", "60"});
  CHECK(rest["kind"] == "equilibrium");
  CHECK(rest["A"][1][0] == -4.0);
  // A state of subnormal numbers: 1e-300 exp(-25).
  folder.write(
      "faint.toml",
      "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[force]]\ngeneralized = { x = "
      "\"-x_dot\" }\n[scene.default]\nt = [0, 1]\ninitial = { x_dot = 1e-300 }\nsolver = \"rk4\"\nstep = 0.1\n");
  const Json faint = document(folder, {"linearize", "faint.toml", "--at", "25"});
  CHECK(faint["A"].back().back() == -1.0);
}

TEST_CASE("linearize: C and D of outputs, with what they depend on through accelerations and constraint forces") {
  const Folder folder;
  folder.write("driven.toml",
               "format = 1\n[parameters]\nk = 4\nc = 1\n[inputs]\nF = {}\n[coordinates]\nx = {}\n[energy]\nkinetic = "
               "\"x_dot^2/2\"\npotential = \"k*x^2/2 + x^4/12\"\n"
               "[[force]]\ngeneralized = { x = \"F - c*x_dot\" }\n[definitions]\nlift = \"F*x_dot\"\n"
               "[scene.default]\nt = [0, 1]\ninitial = { x = 1, x_dot = 2 }\ninputs = { F = 3 }\n"
               "outputs = [\"lift\", \"x_ddot\", \"energy\"]\n");
  const Json found = document(folder, {"linearize", "driven.toml"});
  CHECK(found["outputs"] == Json({{"lift", 6.0}, {"x_ddot", 3 - 2 - 4 - 1.0 / 3}, {"energy", 2 + 2 + 1.0 / 12}}));
  CHECK(found["C"][0] == Json({0.0, 3.0}));
  CHECK(found["D"][0] == Json({2.0}));
  CHECK(found["C"][1] == found["A"][1]);  // the acceleration
  CHECK(found["D"][1] == found["B"][1]);
  CHECK(found["C"][2][0].get<double>() == doctest::Approx(4 + 1.0 / 3).epsilon(1e-15));
  CHECK(found["C"][2][1] == 2.0);
  const std::string text = expect(0, folder, {"linearize", "driven.toml", "--output", "energy,x"}).out;
  CHECK(contains(text, "\nC "));
  CHECK(contains(text, "\nD "));
  CHECK(document(folder, {"linearize", "driven.toml", "--output", "x"})["C"] == Json({{1.0, 0.0}}));

  // A pendulum in cartesian coordinates at the lowest point: the rod pulls with m g + m x_dot^2/L.
  folder.write(
      "rod.toml",
      "format = 1\n[parameters]\nm = \"2 kg\"\nL = \"0.5 m\"\ng = \"9.81 m/s^2\"\n[[particle]]\nname = \"P\"\n"
      "mass = \"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n[[force]]\ngravity = \"-g*E3\"\n"
      "[[constraint]]\nname = \"plane\"\nholonomic = \"y\"\n"
      "[[constraint]]\nname = \"rod\"\nholonomic = \"sqrt(x^2 + z^2) - L\"\n"
      "[scene.default]\nt = [0, 1]\ninitial = { x = 0, z = -0.5, x_dot = 0.75 }\noutputs = [\"reaction.rod\"]\n");
  const Json rod = document(folder, {"linearize", "rod.toml"});
  REQUIRE(rod["states"] == Json({"x", "x_dot"}));
  CHECK(rod["outputs"]["reaction.rod"].get<double>() == doctest::Approx(-(2 * 9.81 + 2 * 0.5625 / 0.5)).epsilon(1e-14));
  CHECK(rod["C"][0][0] == 0.0);
  CHECK(rod["C"][0][1].get<double>() == doctest::Approx(-2 * 2 * 0.75 / 0.5).epsilon(1e-14));
  CHECK(contains(expect(2, folder, {"linearize", "rod.toml", "--output", "nothing"}).err, "nothing"));
}

TEST_CASE(
    "linearize: an output without a slope at the state is left out of those of the scene, and refused where it is "
    "requested") {
  const Folder folder;
  folder.write(
      "kink.toml",
      "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\npotential = \"x^2/2\"\n"
      "[definitions]\nsize = \"abs(x)\"\n[scene.default]\ninitial = { x = 0, x_dot = 1 }\noutputs = [\"size\"]\n");
  const std::string text = expect(0, folder, {"linearize", "kink.toml"}).out;
  CHECK(contains(text, "left out          the output 'size' has no slope at this state: it lies on the edge of abs"));
  const Json kink = document(folder, {"linearize", "kink.toml"});
  CHECK(kink["outputs"].empty());
  CHECK(kink["C"].empty());
  CHECK(kink["outputs_left_out"][0]["name"] == "size");
  CHECK(contains(expect(2, folder, {"linearize", "kink.toml", "--output", "size"}).err,
                 "the output 'size' has no slope at this state"));
  expect(0, folder, {"linearize", "kink.toml", "--output", "x"});
}

TEST_CASE("linearize: a state that is moved to the equilibrium beside it is reported") {
  const Folder folder;
  const auto start_at = [&](const char* x) {
    folder.write("near.toml",
                 std::string("format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[force]]\n"
                             "generalized = { x = \"-(x + 1.8)*(4 + x^2)\" }\n[scene.default]\ninitial = { x = ") +
                     x + " }\n");
    return document(folder, {"linearize", "near.toml"});
  };
  const Json exact = start_at("-1.8");
  CHECK(exact["kind"] == "equilibrium");
  CHECK(exact["point"]["x"] == -1.8);
  CHECK(exact["moved"].empty());
  const Json near = start_at("-1.8000000000000007");
  CHECK(near["kind"] == "equilibrium");
  CHECK(near["point"]["x"] == -1.8);
  // The number nearest to the decimal one is 7.1e-16 away from -1.8.
  CHECK(std::abs(near["moved"]["x"].get<double>() - 7.105e-16) < 1e-18);
  CHECK(contains(expect(0, folder, {"linearize", "near.toml"}).out, "moved             x by 7.1e-16"));
}

TEST_CASE("linearize: nondifferentiable terms, unknown names and invalid times are refused with a remedy") {
  const Folder folder;
  folder.write("edge.toml",
               "format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n[[force]]\ngeneralized = { x = "
               "\"-x - abs(x_dot)\" }\n"
               "[scene.default]\ninitial = { x = 1 }\n");
  const std::string edge = expect(2, folder, {"linearize", "edge.toml"}).err;
  CHECK(contains(edge, "edge.toml:6:"));
  CHECK(contains(edge, "the edge of abs"));
  CHECK(
      contains(expect(2, folder, {"linearize", "cart_pendulum", "--scene", "defualt"}).err, "did you mean 'default'?"));
  CHECK(contains(expect(2, folder, {"linearize", "cart_pendulum", "--set", "mm=1"}).err, "there is no parameter 'mm'"));
  CHECK(contains(expect(2, folder, {"linearize", "cart_pendulum", "--at", "-1"}).err, "before the scene's start"));
  CHECK(contains(expect(2, folder, {"linearize", "cart_pendulum", "--at", "soon"}).err, "soon"));
}

TEST_CASE("linearize: end stops that are open have no part in the equations") {
  const Folder folder;
  const auto stopped = [&](const std::string& start, const std::string& stops) {
    folder.write("stopped.toml",
                 "format = 1\n[parameters]\nw = 1.5\n[functions]\nwall = \"1 + t/10\"\n[inputs]\nF = {}\n"
                 "[coordinates]\nx = {}\ny = {}\n[energy]\nkinetic = \"x_dot^2/2 + y_dot^2/2\"\npotential = "
                 "\"w^2*x^2/2 + x*y/4 + y^2\"\n[[force]]\ngeneralized = { x = \"F\" }\n" +
                     stops + "[scene.default]\nt = [0, 1]\ninitial = { " + start + " }\noutputs = [\"energy\"]\n");
  };
  const std::string stops =
      "[[constraint]]\nname = \"right\"\nholonomic = \"wall - x\"\nholds = \"unilateral\"\nrestitution = "
      "0.5\n[[constraint]]\nname = "
      "\"left\"\nholonomic = \"x + 1\"\nholds = \"unilateral\"\n[[constraint]]\nname = \"floor\"\nholonomic = \"y + "
      "2\"\nholds = \"unilateral\"\n[[constraint]]\n"
      "name = \"ceiling\"\nholonomic = \"2 - y\"\nholds = \"unilateral\"\n[[event]]\nname = \"pressed\"\nwhen = "
      "\"reaction.left - 1\"\n";
  stopped("x = 0.25, y = 0.5, x_dot = 0.5", "");
  const Json free = document(folder, {"linearize", "stopped.toml"});
  CHECK(free["open_contacts"].empty());
  stopped("x = 0.25, y = 0.5, x_dot = 0.5", stops);
  const Json open = document(folder, {"linearize", "stopped.toml"});
  for (const char* key : {"states", "A", "B", "C", "D", "eigenvalues"}) CHECK(open[key] == free[key]);
  CHECK(open["open_contacts"] == Json({"right", "left", "floor", "ceiling"}));
  CHECK(
      contains(expect(0, folder, {"linearize", "stopped.toml"}).out, "open contacts     right, left, floor, ceiling"));
  CHECK(document(folder, {"linearize", "stopped.toml", "--at", "0.25"})["open_contacts"].size() == 4);
  CHECK(document(folder, {"equilibria", "stopped.toml", "--trim", "F", "--set", "y=-0.03125", "--set",
                          "x_dot=0"})["trim"]["inputs"]["F"]
            .get<double>() == doctest::Approx(2.25 * 0.25 - 0.03125 / 4));
  // equilibria does not search across modes.
  stopped("x = -1, y = 0.5", stops);
  CHECK(contains(expect(2, folder, {"equilibria", "stopped.toml"}).err, "'left' sticks, slides or opens"));
  // The force of an open contact is no output.
  stopped("x = 0.25, y = 0.5, x_dot = 0.5", stops);
  const std::string text = folder.read("stopped.toml");
  folder.write("stopped.toml", text.substr(0, text.rfind("[\"energy\"]")) + "[\"energy\", \"reaction.left\"]\n");
  const Json left_out = document(folder, {"linearize", "stopped.toml"});
  CHECK(left_out["outputs"].size() == 1);
  CHECK(left_out["outputs_left_out"] ==
        Json({{{"name", "reaction.left"}, {"reason", "it belongs to a contact that is open"}}}));
}

TEST_CASE("linearize: a state at a singularity of its coordinates is refused, with other coordinates to take") {
  const Folder folder;
  // A satellite on a circle, held there by constraints that keep multipliers; axis e1 across the orbit at be = pi/2.
  const auto satellite = [&](const std::string& rotation, const std::string& start) {
    folder.write(
        "satellite.toml",
        "format = 1\n[[frame]]\nname = \"orbit\"\nrotation = { axis = \"E3\", angle = \"theta\" }\n[[body]]\nname = "
        "\"S\"\nmass = 1\ninertia = { principal = [0.003, 0.004, 0.005] }\nposition = { spherical = [\"R\", \"phi\", "
        "\"theta\"] }\nrotation = " +
            rotation +
            "\nrelative_to = \"orbit\"\n[[force]]\ncentral_gravity = { GM = 1, order = 2 }\n[[constraint]]\nname = "
            "\"radius\"\nholonomic = \"R^2 - 1\"\n[[constraint]]\nname = \"plane\"\nholonomic = \"phi - pi/2 + "
            "cos(phi)/10\"\n[[constraint]]\nname = \"rate\"\nvelocity = \"theta_dot - 1\"\n[scene.default]\ninitial = "
            "{ " +
            start + " }\n");
  };
  satellite("{ euler = \"321\", angles = [\"al\", \"be\", \"ga\"] }",
            "R = 1, phi = \"pi/2\", theta_dot = 1, be = \"pi/2\"");
  const std::string refused = expect(2, folder, {"linearize", "satellite.toml"}).err;
  CHECK(contains(refused, "the angles 321 of 'S' are singular at be = 1.5708"));
  CHECK(contains(refused, "such as euler = \"323\" or euler_parameters"));
  // With these the same state has eigenvalues, and the entries of A are those of its inertia.
  satellite("{ euler = \"323\", angles = [\"al\", \"be\", \"ga\"] }",
            "R = 1, phi = \"pi/2\", theta_dot = 1, be = \"pi/2\"");
  const Json other = document(folder, {"linearize", "satellite.toml"});
  for (const Json& row : other["A"]) {
    for (const Json& entry : row) CHECK(std::abs(entry.get<double>()) < 10);
  }
  satellite("{ euler = \"321\", angles = [\"al\", \"be\", \"ga\"] }", "R = 1, phi = \"pi/2\", theta_dot = 1, be = 1.5");
  const Json found = document(folder, {"equilibria", "satellite.toml"});
  for (const Json& point : found["points"]) CHECK(std::abs(std::cos(point["values"]["be"].get<double>())) > 1e-6);
}

TEST_CASE("linearize, equilibria: angles written out in energies are refused at their pole, whatever the units") {
  const Folder folder;
  const auto pendulum = [&](const std::string& size, const std::string& start) {
    folder.write("pendulum.toml", "format = 1\n[parameters]\nm = 3\nL = " + size +
                                      "\n[coordinates]\nth = {}\nph = {}\n[energy]\nkinetic = \"m*L^2/2*(th_dot^2 + "
                                      "cos(th)^2*ph_dot^2)\"\npotential = \"-9.81*m*L*sin(th)\"\n[scene.default]\nt = "
                                      "[0, 1]\ninitial = { th = " +
                                      start + ", ph = 0 }\n");
  };
  for (const char* size : {"1e-3", "1", "7e6"}) {
    for (const char* start : {"\"pi/2\"", "1.5707963267948966", "1.570796326794"}) {
      CAPTURE(size);
      CAPTURE(start);
      pendulum(size, start);
      CHECK(contains(expect(2, folder, {"linearize", "pendulum.toml"}).err, "the coordinates are singular there"));
    }
    // The pole is left out by its name, and no eigenvalue is claimed for it. If all starts end there, it is an error.
    const ChildResult found = eomgen::test::eomgen(folder, {"equilibria", "pendulum.toml"});
    CHECK(contains(found.out + found.err, "the coordinates are singular there"));
    CHECK_FALSE(contains(found.out, "eigenvalues"));
    pendulum(size, "1.57");
    document(folder, {"linearize", "pendulum.toml"});  // 8e-4 from the pole 13 digits are left
  }
}
