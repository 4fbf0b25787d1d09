// SPDX-License-Identifier: GPL-3.0-or-later
// MJCF files against the recursion on the same numbers, and against closed forms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import/imported.hpp"

using namespace eomgen;
using import::ImportedModel;
using import::ImportOptions;
using test::difference;
using test::Imported;
using test::RobotJoint;
using test::rounding;

namespace {

constexpr double pi = std::numbers::pi;

std::string mujoco(const std::string& world, const std::string& more = "", const std::string& compiler = "") {
  return "<mujoco model=\"m\">\n<compiler " + compiler + "/>\n" + more + "<worldbody>\n" + world +
         "</worldbody>\n</mujoco>\n";
}

/// A body on a hinge about y at the origin.
std::string swing(const std::string& inside, const std::string& joint = "") {
  return "<body name=\"b\">\n<joint name=\"q\" axis=\"0 1 0\" " + joint + "/>\n" + inside + "</body>\n";
}
const std::string unit_inertia = "<inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"2 2 2\"/>\n";

const std::string weightless = "<option gravity=\"0 0 0\"/>\n";

double acceleration(const std::string& file, double q = 0, double qdot = 0, const std::vector<double>& u = {}) {
  return Imported(file).accelerations({q}, {qdot}, u)[0];
}

std::string error_of_mjcf(const std::string& bytes, const ImportOptions& options = {}) {
  try {
    import::import_text("m.xml", bytes, options);
  } catch (const Error& error) {
    CHECK_FALSE(error.remedy().empty());
    return error.what();
  }
  return "";
}

const import::Finding* finding(const ImportedModel& model, const std::string& what) {
  for (const import::Finding& entry : model.findings.entries())
    if (entry.what == what) return &entry;
  return nullptr;
}

}  // namespace

TEST_CASE("MJCF: a tree of bodies has the accelerations of the Newton-Euler recursion") {
  const Imported imported(test::mjcf_of(test::tree(), test::base));
  CHECK(imported.text.format == "mjcf");
  CHECK(imported.text.coordinates == std::vector<std::string>{"j0", "j1", "j3", "j5", "j6"});
  CHECK(imported.model->warnings.empty());
  CHECK(difference(imported, test::tree(), 5) < rounding);
}

TEST_CASE("MJCF: a free body has the accelerations of a chain of three prismatic and three revolute joints") {
  const Imported imported(test::mjcf_of(test::tree(), test::base, true));
  CHECK(imported.text.coordinates.front() == "base_x");
  CHECK(difference(imported, test::floating_tree(), 11) < rounding);
}

TEST_CASE("MJCF: the place of a free joint is that in the world, whatever its attitude") {
  const Imported imported(
      mujoco("<body name=\"c\" pos=\"1 0 2\" quat=\"0.5 0.5 0.5 0.5\"><freejoint/>" + unit_inertia + "</body>"));
  for (const char* part :
       {"c_free_x = 1\n", "c_free_y = 0\n", "c_free_z = 2\n", "c_free_x*E1 + c_free_y*E2 + c_free_z*E3"}) {
    CAPTURE(part);
    CHECK(imported.text.text.find(part) != std::string::npos);
  }
}

TEST_CASE("MJCF: a body has several joints, each at its own place, and a ball joint") {
  const std::string body =
      "<body name=\"a\" pos=\"0.1 0.2 0.3\">\n<joint name=\"s\" type=\"slide\" axis=\"0 0 1\"/>\n"
      "<joint name=\"h\" axis=\"0 1 0\" pos=\"0.1 0 0.05\"/>\n<joint name=\"k\" axis=\"1 0 0\" pos=\"0 0.05 0.2\"/>\n"
      "<inertial pos=\"0.3 -0.1 0.2\" mass=\"2\" fullinertia=\"0.03 0.04 0.05 0.001 -0.002 0.003\"/>\n"
      "<body name=\"b\" pos=\"0.5 0 0.1\">\n<joint name=\"ball\" type=\"ball\" pos=\"0 0.1 0\"/>\n"
      "<inertial pos=\"0 0 0.4\" mass=\"1\" diaginertia=\"0.02 0.03 0.01\"/>\n</body>\n</body>\n";
  std::vector<RobotJoint> robot(6);
  robot[0] = {"prismatic", -1, {0.1, 0.2, 0.3}, {}, {0, 0, 1}, 0, {}, {}, {}, 0};
  robot[1] = {"revolute", 0, {0.1, 0, 0.05}, {}, {0, 1, 0}, 0, {}, {}, {}, 0};
  robot[2] = {"revolute",
              1,
              {-0.1, 0.05, 0.15},
              {},
              {1, 0, 0},
              2,
              {0.3, -0.15, 0},
              {},
              {0.03, 0.001, -0.002, 0.04, 0.003, 0.05},
              0};
  // Anchors count from the origin of the body: (0.5, 0, 0.1) + (0, 0.1, 0) - (0, 0.05, 0.2).
  robot[3] = {"revolute", 2, {0.5, 0.05, -0.1}, {}, {0, 0, 1}, 0, {}, {}, {}, 0};
  robot[4] = {"revolute", 3, {}, {}, {0, 1, 0}, 0, {}, {}, {}, 0};
  robot[5] = {"revolute", 4, {}, {}, {1, 0, 0}, 1, {0, -0.1, 0.4}, {}, {0.02, 0, 0, 0.03, 0, 0.01}, 0};
  const Imported imported(mujoco(body));
  CHECK(imported.text.coordinates == std::vector<std::string>{"s", "h", "k", "ball_yaw", "ball_pitch", "ball_roll"});
  CHECK(difference(imported, robot, 6) < rounding);
}

TEST_CASE("MJCF: masses and moments of geoms are those of homogeneous solids") {
  struct Case {
    const char* geom;
    double volume, moment;  // about y, for a mass of 1
  };
  const double r = 0.1, h = 0.3, ball = 4.0 / 3 * pi * r * r * r, tube = pi * r * r * 2 * h;
  const double of_ball = 2 * r * r / 5 + h * h + 2 * h * 3 * r / 8, of_tube = (3 * r * r + 4 * h * h) / 12;
  const Case cases[] = {
      {"type=\"sphere\" size=\"0.1\"", ball, 0.4 * r * r},
      {"size=\"0.1\"", ball, 0.4 * r * r},
      {"type=\"box\" size=\"0.1 0.2 0.3\"", 8 * 0.006, (0.01 + 0.09) / 3},
      {"type=\"ellipsoid\" size=\"0.1 0.2 0.3\"", 4.0 / 3 * pi * 0.006, (0.01 + 0.09) / 5},
      {"type=\"cylinder\" size=\"0.1 0.3\"", tube, of_tube},
      {"type=\"cylinder\" size=\"0.1 0.3\" euler=\"90 0 0\"", tube, r * r / 2},
      {"type=\"capsule\" size=\"0.1 0.3\"", ball + tube, (ball * of_ball + tube * of_tube) / (ball + tube)},
      {"type=\"capsule\" size=\"0.1\" fromto=\"-0.3 0 -1 0.3 0 -1\"", ball + tube,
       (ball * of_ball + tube * of_tube) / (ball + tube)},
      // Between two points a box is square: MuJoCo ignores its second size.
      {"type=\"box\" size=\"0.1 0.7\" fromto=\"0 0.3 -1 0 -0.3 -1\"", 8 * 0.003, (0.01 + 0.01) / 3},
      {"type=\"capsule\" size=\"0.1\" fromto=\"0 0.3 -1 0 -0.3 -1\"", ball + tube,
       (ball * 0.4 + tube * 0.5) * r * r / (ball + tube)}};
  const double q = 0.4, L = 1;
  for (const Case& c : cases) {
    CAPTURE(std::string(c.geom));
    const std::string place = std::string(c.geom).find("fromto") == std::string::npos ? " pos=\"0 0 -1\"" : "";
    for (const std::string mass : {"", " mass=\"3\"", " density=\"500\""}) {
      CAPTURE(mass);
      const Imported imported(mujoco(swing("<geom " + std::string(c.geom) + place + mass + "/>\n")));
      CHECK(imported.accelerations({q}, {0})[0] ==
            doctest::Approx(-test::g * L * std::sin(q) / (L * L + c.moment)).epsilon(1e-12));
      const double expected = mass.empty() ? 1000 * c.volume : mass == " mass=\"3\"" ? 3 : 500 * c.volume;
      const std::size_t at = imported.text.text.find("mass = \"");
      REQUIRE(at != std::string::npos);
      CHECK(std::stod(imported.text.text.substr(at + 8)) == doctest::Approx(expected).epsilon(1e-13));
    }
  }
}

TEST_CASE("MJCF: <inertial> replaces geoms unless the compiler says otherwise") {
  const std::string both = swing(
      "<inertial pos=\"0 0 -0.5\" mass=\"1\" diaginertia=\"2 2 2\"/>\n<geom type=\"box\" size=\"0.1 0.1 0.1\" "
      "mass=\"3\" pos=\"0 0 -1\"/>\n");
  const double q = 0.3, of_geom = -test::g * std::sin(q) / (1 + 0.02 / 3);
  CHECK(acceleration(mujoco(both), q) == doctest::Approx(-0.5 * test::g * std::sin(q) / 2.25));
  CHECK(acceleration(mujoco(both, "", "inertiafromgeom=\"true\""), q) == doctest::Approx(of_geom));
  CHECK(error_of_mjcf(mujoco(swing("<geom size=\"1\"/>\n"), "", "inertiafromgeom=\"false\"")).find("nothing moves") !=
        std::string::npos);
}

TEST_CASE("MJCF: every way to state an orientation gives the same rotation") {
  const double angle = 1.1, s = std::sin(angle / 2) / 3;
  // 1.1 rad about (1, 2, -2)/3 by Rodrigues' formula.
  const double c = std::cos(angle), w = std::sin(angle), n[3] = {1.0 / 3, 2.0 / 3, -2.0 / 3};
  double R[3][3];
  const double skew[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) R[i][k] = (i == k ? c : 0) + w * skew[i][k] + (1 - c) * n[i] * n[k];
  const std::vector<std::string> forms{
      fmt::format("quat=\"{} {} {} {}\"", std::cos(angle / 2), s, 2 * s, -2 * s),
      fmt::format("quat=\"{} {} {} {}\"", 7 * std::cos(angle / 2), 7 * s, 14 * s, -14 * s), "axisangle=\"2 4 -4 1.1\"",
      fmt::format("xyaxes=\"{} {} {} {} {} {}\"", 2 * R[0][0], 2 * R[1][0], 2 * R[2][0], R[0][1] + R[0][0],
                  R[1][1] + R[1][0], R[2][1] + R[2][0]),
      // Moving axes x, y, z: R = Rx(a) Ry(b) Rz(c).
      fmt::format("euler=\"{} {} {}\"", std::atan2(-R[1][2], R[2][2]), std::asin(R[0][2]),
                  std::atan2(-R[0][1], R[0][0]))};
  std::vector<double> expected;
  for (const std::string& form : forms) {
    CAPTURE(form);
    const Imported imported(mujoco("<body name=\"b\" " + form +
                                       ">\n<joint name=\"q\" axis=\"0.6 0 0.8\"/>\n<inertial "
                                       "pos=\"0.1 0.2 0.3\" mass=\"1\" diaginertia=\"0.1 0.2 0.25\"/>\n</body>\n",
                                   "", "angle=\"radian\""));
    expected.push_back(imported.accelerations({0.7}, {0.5})[0]);
    CHECK(expected.back() == doctest::Approx(expected.front()).epsilon(1e-13));
  }
  // zaxis: the shortest turn, here by asin(0.6) about y.
  const auto of = [](const std::string& form) {
    return acceleration(mujoco("<body name=\"b\">\n<joint name=\"q\" axis=\"0 1 0\"/>\n<inertial pos=\"0 0 -1\" "
                               "mass=\"1\" diaginertia=\"0.1 0.2 0.25\" " +
                               form + "/>\n<inertial2/></body>\n"),
                        0.7);
  };
  CHECK(of("zaxis=\"6 0 8\"") == doctest::Approx(of("axisangle=\"0 1 0 36.86989764584402\"")).epsilon(1e-13));
}

TEST_CASE("MJCF: default classes, childclass and class give values, and the element's own comes first") {
  const std::string defaults =
      "<default><joint damping=\"1\" axis=\"0 1 0\"/><default class=\"arm\"><joint damping=\"3\"/><default "
      "class=\"wrist\"><joint armature=\"2\"/></default></default></default>\n";
  const auto body = [](const std::string& childclass, const std::string& joint) {
    return "<body name=\"b\" " + childclass + ">\n<joint name=\"q\" " + joint + "/>\n" + unit_inertia + "</body>\n";
  };
  const auto of = [&](const std::string& childclass, const std::string& joint) {
    return acceleration(mujoco(body(childclass, joint), weightless + defaults), 0, 1);
  };
  CHECK(of("", "") == doctest::Approx(-1.0 / 2));
  CHECK(of("childclass=\"arm\"", "") == doctest::Approx(-3.0 / 2));
  CHECK(of("childclass=\"arm\"", "class=\"wrist\"") == doctest::Approx(-3.0 / 4));
  CHECK(of("childclass=\"arm\"", "class=\"main\"") == doctest::Approx(-1.0 / 2));
  CHECK(of("childclass=\"wrist\"", "damping=\"7\"") == doctest::Approx(-7.0 / 4));
}

TEST_CASE("MJCF: damping, springs, armature, friction and gravity are forces of the joint") {
  CHECK(acceleration(mujoco(swing(unit_inertia, "damping=\"3\""), weightless), 0.5, 0.7) ==
        doctest::Approx(-3 * 0.7 / 2));
  CHECK(acceleration(mujoco(swing(unit_inertia, "stiffness=\"4\" springref=\"90\" armature=\"0.5\""), weightless),
                     0.5) == doctest::Approx(-4 * (0.5 - pi / 2) / 2.5));
  // A smooth law of friction, linear below 0.01 rad/s.
  CHECK(acceleration(mujoco(swing(unit_inertia, "frictionloss=\"3\""), weightless), 0, 5) ==
        doctest::Approx(-1.5).epsilon(1e-4));
  const std::string mass = swing("<inertial pos=\"0 0 -1\" mass=\"1\" diaginertia=\"1 1 1\"/>\n");
  CHECK(acceleration(mujoco(mass, "<option gravity=\"0 0 -2\"/>\n"), 0.3) == doctest::Approx(-2 * std::sin(0.3) / 2));
  CHECK(acceleration(mujoco(mass, "<option gravity=\"3 0 -2\"/>\n"), 0.3) ==
        doctest::Approx((-3 * std::cos(0.3) - 2 * std::sin(0.3)) / 2));
  CHECK(acceleration(mujoco(mass, "<option gravity=\"0 0 0\"/>\n"), 0.3) == doctest::Approx(0));
}

TEST_CASE("MJCF: gravity is left out where joints turn about the vertical and slide along the horizontal") {
  const std::string arm = "<body name=\"a\" euler=\"0 0 30\"><joint name=\"q\" axis=\"0 0 -1\"/>" + unit_inertia +
                          "<body name=\"b\" pos=\"1 0 0\"><joint name=\"s\" type=\"slide\" axis=\"1 1 0\"/>" +
                          unit_inertia + "</body></body>\n";
  const Imported imported(mujoco(arm));
  CHECK(finding(imported.text, "gravity") != nullptr);
  // No force: the motion of a free body in the plane. A point of mass 1 at (1 + s/sqrt(2), s/sqrt(2)) of a turning arm.
  const double s = 0.4, x = 1 + s / std::sqrt(2.0), y = s / std::sqrt(2.0);
  const std::vector<double> a = imported.accelerations({0, s}, {0.7, 0});
  CHECK(finding(import::import_text("m.xml", mujoco(swing(unit_inertia)), {}), "gravity") == nullptr);
  // s'' + q'' c = w^2 (x + y)/sqrt(2) and (4 + x^2 + y^2) q'' + c s'' = 0 with c = (y - x)/-sqrt(2); w = -q' about E3.
  const double c = -(x - y) / std::sqrt(2.0), r = x * x + y * y, w2 = 0.49;
  const double drive = w2 * (x + y) / std::sqrt(2.0), inertia = 4 + r;
  CHECK(a[1] == doctest::Approx(drive / (1 - c * c / inertia)));
  CHECK(a[0] == doctest::Approx(-c * a[1] / inertia));
}

TEST_CASE("MJCF: limits are in degrees or radians, with or without autolimits, and count from the pose of the file") {
  const auto comment = [](const std::string& joint, const std::string& compiler) {
    return import::import_text("m.xml", mujoco(swing(unit_inertia, joint), "", compiler), {}).text;
  };
  CHECK(comment("range=\"-1 2\"", "angle=\"radian\"").find("lower -1, upper 2") != std::string::npos);
  CHECK(comment("range=\"-1 2\"", "angle=\"radian\" autolimits=\"false\"").find("lower") == std::string::npos);
  CHECK(comment("range=\"-1 2\" limited=\"true\"", "angle=\"radian\" autolimits=\"false\"").find("lower -1") !=
        std::string::npos);
  CHECK(comment("range=\"-1 2\" limited=\"false\"", "angle=\"radian\"").find("lower") == std::string::npos);
  CHECK(comment("range=\"-1 2\" ref=\"0.5\"", "angle=\"radian\"").find("lower -1.5, upper 1.5") != std::string::npos);
  CHECK(comment("range=\"-180 90\"", "").find("lower -3.14159265") != std::string::npos);
  ImportOptions options;
  options.stops = {"q"};
  CHECK(import::import_text("m.xml", mujoco(swing(unit_inertia, "range=\"-90 90\"")), options).constraints == 2);
}

TEST_CASE("MJCF: actuators are inputs with gear, gain and feedback") {
  const auto with_actuator = [](const std::string& actuator, const std::string& joint = "") {
    return mujoco(swing(unit_inertia, joint), weightless + "<actuator>" + actuator + "</actuator>\n",
                  "angle=\"radian\"");
  };
  const double q = 0.4, v = 0.3, u = 0.9;
  const auto of = [&](const std::string& actuator, const std::string& joint = "") {
    return 2 * acceleration(with_actuator(actuator, joint), q, v, {u});
  };
  CHECK(of("<motor joint=\"q\"/>") == doctest::Approx(u));
  CHECK(of("<motor joint=\"q\" gear=\"-50\"/>") == doctest::Approx(-50 * u));
  CHECK(of("<position joint=\"q\" kp=\"20\"/>") == doctest::Approx(20 * (u - q)));
  CHECK(of("<position joint=\"q\" kp=\"20\" kv=\"3\" gear=\"2\"/>") ==
        doctest::Approx(2 * (20 * (u - 2 * q) - 3 * 2 * v)));
  // The length of the actuator is gear times the position, which is 0.1 in the pose of the file.
  CHECK(of("<position joint=\"q\" kp=\"20\"/>", "ref=\"0.1\"") == doctest::Approx(20 * (u - (q + 0.1))));
  CHECK(of("<velocity joint=\"q\" kv=\"20\"/>") == doctest::Approx(20 * (u - v)));
  CHECK(of("<general joint=\"q\" gainprm=\"5\" biastype=\"affine\" biasprm=\"1 -2 -3\"/>") ==
        doctest::Approx(5 * u + 1 - 2 * q - 3 * v));
  CHECK(of("<general joint=\"q\" gainprm=\"5\" biasprm=\"1 -2 -3\"/>") == doctest::Approx(5 * u));
  const ImportedModel two = import::import_text(
      "m.xml",
      with_actuator("<motor name=\"left\" joint=\"q\" ctrlrange=\"-1 1\"/><position name=\"hold\" joint=\"q\"/>"
                    "<muscle joint=\"q\"/><motor tendon=\"t\"/>"),
      {});
  CHECK(two.inputs == std::vector<std::string>{"u_left", "u_hold"});
  CHECK(two.text.find("u_left = { unit = \"N*m\" }  # line 4, 'motor' of 'q', ctrlrange '-1 1'") != std::string::npos);
  CHECK(two.text.find("u_hold = { unit = \"rad\" }") != std::string::npos);
  CHECK(finding(two, "<muscle> of <actuator>") != nullptr);
  CHECK(finding(two, "<motor> of <actuator>") != nullptr);
  CHECK(finding(two, "ctrlrange of actuators") != nullptr);
  ImportOptions none;
  none.actuation = import::Actuation::none;
  CHECK(import::import_text("m.xml", with_actuator("<motor joint=\"q\"/>"), none).inputs.empty());
}

TEST_CASE("MJCF: an equality of joints couples them") {
  const std::string bodies =
      swing(unit_inertia) +
      "<body name=\"c\">\n<joint name=\"p\" axis=\"0 1 0\"/>\n<inertial pos=\"0 0 0\" mass=\"1\" "
      "diaginertia=\"5 5 5\"/>\n</body>\n";
  const auto file = [&](const std::string& equality) {
    return mujoco(bodies,
                  weightless + "<actuator><motor joint=\"p\"/></actuator><equality>" + equality + "</equality>\n");
  };
  const Imported coupled(file("<joint joint1=\"q\" joint2=\"p\" polycoef=\"0.1 -3 0 0 0\"/>"));
  CHECK(coupled.text.constraints == 1);
  const std::vector<double> a = coupled.accelerations({0.1 - 3 * 0.2, 0.2}, {-3, 1}, {46});
  CHECK(a[1] == doctest::Approx(46.0 / (5 + 9 * 2)));  // q = 0.1 - 3 p
  CHECK(a[0] == doctest::Approx(-6));
  for (const char* other : {"<joint joint1=\"q\" joint2=\"p\" polycoef=\"0 1 2 0 0\"/>", "<joint joint1=\"q\"/>",
                            "<weld body1=\"b\" body2=\"c\"/>", "<joint joint1=\"q\" joint2=\"p\" active=\"false\"/>"}) {
    CAPTURE(std::string(other));
    const ImportedModel left_out = import::import_text("m.xml", file(other), {});
    CHECK(left_out.constraints == 0);
    CHECK(finding(left_out, std::string(other).starts_with("<weld") ? "<weld> of <equality>"
                                                                    : "<joint> of <equality>") != nullptr);
  }
}

TEST_CASE(
    "MJCF: sites are points, frames move what is in them, shapes are drawn, and the rest is reported with lines") {
  const ImportedModel imported = import::import_text(
      "m.xml",
      mujoco(
          "<geom type=\"plane\" size=\"1 1 1\"/>\n<light/>\n" +
              swing(
                  "<frame pos=\"0 0 -1\"><geom type=\"capsule\" size=\"0.1 0.2\" mass=\"1\"/><site name=\"tip\" "
                  "pos=\"0 0 "
                  "-0.5\"/></frame>\n<geom type=\"mesh\" mesh=\"hand\"/>\n<geom group=\"3\" size=\"1\" mass=\"0\"/>\n"),
          "<tendon/><sensor/><contact/><keyframe/><asset><texture/></asset>\n<option timestep=\"0.001\"/>\n"),
      {});
  const auto has = [&](const char* part) { return imported.text.find(part) != std::string::npos; };
  CHECK(has("name = \"tip\"\nposition = \"origin - 1.5[m]*b.e3\""));
  CHECK(has("cylinder = [\"0.1 m\""));
  CHECK(has("sphere = \"0.1 m\", at = [0, 0, \"0.2"));
  for (const char* what :
       {"<tendon>", "<sensor>", "<contact>", "<keyframe>", "<texture>", "<option>", "<light>", "plane of <geom>",
        "mesh of <geom>", "masses of meshes", "geoms of groups 3 to 5", "contacts of <geom>"}) {
    CAPTURE(std::string(what));
    REQUIRE(finding(imported, what) != nullptr);
    CHECK(finding(imported, what)->first.line > 0);
  }
  CHECK(finding(imported, "<tendon>")->first.line == 3);
}

TEST_CASE("MJCF: wrong files are refused with their place") {
  const std::string body = swing(unit_inertia);
  struct Wrong {
    std::string bytes;
    const char* message;
  };
  ImportOptions floating;
  floating.floating = true;
  CHECK(error_of_mjcf(mujoco(body), floating).find("states itself which bodies are free") != std::string::npos);
  for (const Wrong& wrong : {
           Wrong{mujoco("<include file=\"/etc/passwd\"/>"), "m.xml:4:2: error: other files are not included"},
           {mujoco(""), "the file has no body"},
           {mujoco(body + body), "the name 'b' comes twice"},
           {mujoco(swing(unit_inertia, "class=\"arm\"")), "m.xml:5:30: error: there is no class 'arm'"},
           {mujoco(swing(unit_inertia, "type=\"hing\"")), "did you mean 'hinge'?"},
           {mujoco(swing(unit_inertia, "range=\"2 1\"")), "the range of the joint 'q' is empty"},
           {mujoco(swing(unit_inertia, "damping=\"-1\"")), "the damping of the joint 'q' is negative"},
           {mujoco(swing(unit_inertia, "axis2=\"\"")), ""},
           {mujoco(swing("<geom type=\"bx\" size=\"1\"/>")), "did you mean 'box'?"},
           {mujoco(swing("<geom type=\"box\"/>")), "the box has no size"},
           {mujoco(swing("<geom type=\"box\" size=\"1 1\"/>")), "'size' has 2 numbers"},
           {mujoco(swing("<geom size=\"0\"/>")), "a size that is not above 0"},
           {mujoco(swing("<geom size=\"1\" mass=\"-1\"/>")), "the mass of the geom is negative"},
           {mujoco(swing("<geom type=\"capsule\" size=\"1\" fromto=\"0 0 1 0 0 1\"/>")),
            "both ends of 'fromto' are equal"},
           {mujoco(swing("<inertial mass=\"1\" pos=\"0 0 0\"/>")), "one of diaginertia and fullinertia"},
           {mujoco(swing("<inertial mass=\"1\" diaginertia=\"-1 1 1\"/>")), "is not positive definite"},
           {mujoco("<body quat=\"0 0 0 0\"><joint/>" + unit_inertia + "</body>"), "'quat' has no direction"},
           {mujoco("<body quat=\"1 0 0 0\" euler=\"0 0 0\"><joint/>" + unit_inertia + "</body>"),
            "'quat' and 'euler' both state the orientation"},
           {mujoco(swing("<body name=\"c\"><freejoint/>" + unit_inertia + "</body>")), "a free joint is the only one"},
           {mujoco(body, "", "angle=\"grad\""), "'angle' is 'grad'"},
           {mujoco(body, "", "eulerseq=\"xyw\""), "'eulerseq' is 'xyw'"},
           {mujoco(body, "", "coordinate=\"global\""), "the file has global coordinates"},
           {mujoco(body, "<actuator><motor joint=\"r\"/></actuator>"), "there is no joint 'r'"},
           {mujoco(body, "<equality><joint joint1=\"q\" joint2=\"r\"/></equality>"), "there is no joint 'r'"},
       }) {
    const std::string message = error_of_mjcf(wrong.bytes);
    CAPTURE(wrong.bytes);
    CAPTURE(message);
    CHECK(message.find(wrong.message) != std::string::npos);
  }
}

TEST_CASE("MJCF: a chain of 150 nested bodies is read, and names of joints are made") {
  std::string bodies;
  for (int i = 0; i < 150; ++i) bodies += "<body pos=\"0 0 -0.1\"><joint axis=\"0 1 0\"/>" + unit_inertia;
  for (int i = 0; i < 150; ++i) bodies += "</body>";
  const ImportedModel chain = import::import_text("m.xml", mujoco(bodies), {});
  CHECK(chain.bodies == 150);
  CHECK(chain.coordinates[0] == "body_joint");
  CHECK(chain.coordinates[149] == "body150_joint");
}
