// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/units.hpp"

#include <doctest/doctest.h>

#include "model_support.hpp"

using namespace eomgen::model;

namespace {

Rational si(const std::string& quantity) {
  const Model model = with_parameters("p = \"" + quantity + "\"");
  return exact(model, model.parameters[0].value);
}

bool only_unused(const Model& model) {
  for (const eomgen::Warning& warning : model.warnings) {
    if (!warning.message.ends_with("is not used")) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("units are converted to SI exactly") {
  CHECK(si("5 mm") == ratio(5, 1000));
  CHECK(si("9.81 m/s^2") == ratio(981, 100));
  CHECK(si("72 km/h") == 20);
  CHECK(si("250 g") == ratio(1, 4));
  CHECK(si("3 kN*cm") == 30);
  CHECK(si("2 uN/mm^2") == 2);
  CHECK(si("1 dag") == ratio(1, 100));
  CHECK(si("1 L") == ratio(1, 1000));
  CHECK(si("2 min") == 120);
  CHECK(si("1 kg/(m*s^2)") == 1);
  CHECK(si("4 s^-2") == 4);
  CHECK(si("5 1/ms") == 5000);
  CHECK(si("1.7e-5[km]") == ratio(17, 1000));
  CHECK(si("2[cm] + 1[mm]") == ratio(21, 1000));
}

TEST_CASE("degrees and turns contain pi exactly") {
  const Model model =
      with_parameters("a = \"30 deg\"\nb = \"60 rpm\"\nc = \"1 rev/s\"\nd = \"-2*pi rad/s\"\ne = \"1 deg^2\"");
  const double pi = std::acos(-1.0);
  const auto value = [&](std::size_t k) { return approximate(model, model.parameters[k].value); };
  CHECK(value(0) == doctest::Approx(pi / 6).epsilon(1e-15));
  CHECK(value(1) == doctest::Approx(2 * pi).epsilon(1e-15));
  CHECK(value(2) == doctest::Approx(2 * pi).epsilon(1e-15));
  CHECK(value(3) == doctest::Approx(-2 * pi).epsilon(1e-15));
  CHECK(model.arena[model.arena[model.parameters[4].value].args[1]].op == Op::power);
}

TEST_CASE("a unit is kept as written if it is SI, and is canonical otherwise") {
  const Model model = with_parameters(
      "a = \"2 N*s/m\"\nb = \"2 mm\"\nc = \"a*b\"\nd = 3\ne = { value = 2, unit = \"kN/m\" }\nf = { value = 1, unit = "
      "\"1\" }");
  CHECK(model.parameters[0].unit.text == "N*s/m");
  CHECK(model.parameters[1].unit.text == "m");
  CHECK(model.parameters[2].unit.text == "N*s");
  CHECK(model.parameters[3].unit.text.empty());
  CHECK(!model.parameters[3].unit.dimension);
  CHECK(model.parameters[4].unit.text == "N/m");
  CHECK(exact(model, model.parameters[4].value) == 2000);
  CHECK(model.parameters[5].unit.text == "1");
}

TEST_CASE("dimensions are printed in customary units") {
  CHECK(text_of(dimension_of("kg*m/s^2")) == "N");
  CHECK(text_of(dimension_of("kg*m^2")) == "kg*m^2");
  CHECK(text_of(dimension_of("rad")) == "1");
  CHECK(text_of(dimension_of("m^3/(kg*s^2)")) == "m^3/(kg*s^2)");
  CHECK(text_of(raised(dimension_of("m"), ratio(1, 2))) == "m^(1/2)");
  CHECK(same(dimension_of("m^(1/2)"), raised(dimension_of("m"), ratio(1, 2))));
  CHECK(same(dimension_of("kg^(-3/2)*m^2"), product(raised(dimension_of("kg"), ratio(-3, 2)), dimension_of("m^2"))));
}

TEST_CASE("invalid units are rejected") {
  for (const char* text : {"", "mm m", "foo", "m^", "m^0", "m^12", "m//s", "(m", "m)", "2", "kdeg", "m^(1/2", "m^(1/0)",
                           "m^-(1/2)", "mm^(1/2)", "m^1.5", "m-s"}) {
    CAPTURE(text);
    CHECK(!parse_unit(text));
  }
}

TEST_CASE("a bare number is compatible with every dimension") {
  CHECK(refusal(particle("[[constraint]]\nname = \"c\"\nholonomic = \"R - 2\"\n")) == "accepted");
  CHECK(refusal(particle("[definitions]\na = \"R + 1\"\nb = \"a + L\"\n")) == "accepted");
  CHECK(refusal(particle("[[force]]\non = \"P\"\nforce = [0, 0, 3]\n")) == "accepted");
}

TEST_CASE("sums, arguments and required values must agree in dimension") {
  const auto sum = [](const std::string& expression) {
    return refusal(particle("[definitions]\na = \"" + expression + "\"\n"));
  };
  CHECK(sum("R + t") == "the units clash: m on one side and s on the other side of '+'");
  CHECK(sum("R/L + theta") == "accepted");
  CHECK(sum("sqrt(R^2 + L^2) - R") == "accepted");
  CHECK(sum("R^(1/2)*R^1.5 - L^2") == "accepted");
  CHECK(sum("exp(R)") == "the units clash: exp() takes a pure number, and this is in m");
  CHECK(sum("atan2(R, L) + atan2(R, t)") == "the units clash: m on one side and s on the other side of atan2()");
  CHECK(sum("if(R < t, 1, 2)") == "the units clash: m on one side and s on the other side of the comparison");
  CHECK(sum("2^R") == "the units clash: an exponent is a pure number, and this is in m");
  CHECK(sum("R_dot - ddt(R)") == "accepted");
  CHECK(sum("R_dot - dot(velocity(P), P.e_R)") == "accepted");
  CHECK(sum("dot(P.g_theta, P.a_theta) - 1") == "accepted");
  CHECK(sum("norm(P.a_theta) - R*sin(phi)") == "accepted");
}

TEST_CASE("with a factor that may have a unit, a mismatch is a warning") {
  const Model model = read(particle("[[force]]\non = \"P\"\nforce = \"-0.3*R*P.e_R\"\n"));
  REQUIRE(model.warnings.size() == 3);  // and L, k are not used
  CHECK(model.warnings[0].message == "this force must be in N, and this is in m");
  CHECK(refusal(particle("[[force]]\non = \"P\"\nforce = \"-R/2*P.e_R\"\n")) ==
        "the units clash: this force must be in N, and this is in m");
}

TEST_CASE("in sin(2*t) the 2 has the unit, and unit vectors have none") {
  CHECK(refusal(particle("[functions]\nd = \"L + L/10*sin(2*t)\"\n")) == "accepted");
  CHECK(refusal(particle("[functions]\nd = \"L*sin(L*t)\"\n")) ==
        "the units clash: sin() takes a pure number, and this is in m*s");
  CHECK(refusal(particle("[[force]]\non = \"P\"\nforce = \"E1 + 2*P.e_theta\"\n")) == "accepted");
  CHECK(refusal(particle("[[force]]\non = \"2*E1\"\nforce = \"m*g*unit(P)\"\n")) == "accepted");
  CHECK(refusal(particle("[[force]]\non = \"P\"\nforce = \"m*dot(E1, P)*E2\"\n")) ==
        "the units clash: this force must be in N, and this is in kg*m");
}

TEST_CASE("a model that states no unit is not checked for units") {
  const std::string model = R"toml(format = 1
title = "a bead on a parabola, 2 m"
[parameters]
m = 1
[[particle]]
name = "P"
mass = "m"
position = { cartesian = ["x", "y", "z"] }
[[constraint]]
name = "bowl"
holonomic = "z - x^2 - y^2 - sin(x)"
)toml";
  CHECK(refusal(model) == "accepted");
  CHECK(read(model).warnings.empty());
  CHECK(refusal(model + "[functions]\nd = \"2 m\"\n") ==
        "the units clash: m on one side and m^2 on the other side of '-'");
}

TEST_CASE("multiples of pi count as numbers everywhere") {
  const Model model = read(particle(
      "[functions]\nf = \"min(t, pi)\"\ng2 = \"L + pi*L\"\n[definitions]\nd = \"max(R, pi/2) + pi\"\n"
      "[scene.default]\ninitial = { R = \"pi\", phi = \"pi/2\", phi_dot = \"2*pi\", theta_dot = \"-sqrt(pi)\" }\n"));
  CHECK(only_unused(model));
  CHECK(model.definitions[0].unit.text == "m");
  CHECK(model.functions[0].unit.text == "s");
  CHECK_THROWS(read(particle("[definitions]\nd = \"R + L^2*pi\"\n")));  // the other factor keeps its dimension
}

TEST_CASE("a file whose only units are angles counts as a file without units") {
  const std::string text =
      "format = 1\n[parameters]\nm = 1\nL = 2\na = \"30 deg\"\nb = \"0.1[rad]\"\n[coordinates]\nphi = \"rad\"\nx = {}\n"
      "[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cylindrical = [\"r\", \"phi\", \"x\"] }\n"
      "[definitions]\nd = \"r + r^2 + sin(r)\"\n[scene.default]\ninitial = { phi = \"45 deg\" }\n";
  CHECK(only_unused(read(text)));
  std::string other = text;
  other.replace(other.find("m = 1"), 5, "m = \"1 kg\"");
  CHECK_THROWS(read(other));
}

TEST_CASE("a parameter above one turn without a unit warns where a trigonometric function takes it") {
  const auto warnings = [](const std::string& value) {
    const Model model = with_parameters("alpha = " + value + "\nb = \"cos(alpha)\"\nc = \"sin(b - alpha)\"");
    std::vector<std::string> found;
    for (const eomgen::Warning& warning : model.warnings) {
      if (!warning.message.ends_with("is not used")) found.push_back(warning.message + ": " + warning.remedy);
    }
    return found;
  };
  REQUIRE(warnings("30").size() == 1);
  CHECK(warnings("30")[0] ==
        "the parameter 'alpha' is 30 without a unit, and cos() takes radians: write alpha = \"30 deg\" if degrees are "
        "meant, or alpha = \"30 rad\"");
  CHECK(warnings("\"30 deg\"").empty());
  CHECK(warnings("\"30 rad\"").empty());
  CHECK(warnings("0.5").empty());
  CHECK(warnings("6.28").empty());
}

TEST_CASE("gravity beside a potential with the same parameter warns") {
  const auto warnings = [](const std::string& potential) {
    const Model model = read(particle("[energy]\npotential = \"" + potential + "\"\n"));
    std::vector<std::string> found;
    for (const eomgen::Warning& warning : model.warnings) {
      if (warning.message.starts_with("gravity and")) found.push_back(warning.message + ": " + warning.remedy);
    }
    return found;
  };
  REQUIRE(warnings("m*g*R*cos(theta)").size() == 1);
  CHECK(warnings("m*g*R*cos(theta)")[0] ==
        "gravity and the potential of [energy] both contain 'g': both act: leave out one of them if the potential is "
        "that of the weights");
  // The value of g, written out.
  REQUIRE(warnings("9.81*m*R*cos(theta)").size() == 1);
  CHECK(warnings("9.81*m*R*cos(theta)")[0].starts_with("gravity and the potential of [energy] both contain 9.81: "));
  CHECK(warnings("k*R^2/2").empty());
  CHECK(warnings("1.5*k*R^2").empty());
}

TEST_CASE("units: formulas in a range or an armature of a coordinate state no unit") {
  const std::string model =
      "format = 1\n[parameters]\nL = 2\n[coordinates]\nq = KEYS\n[[particle]]\nname = \"P\"\nmass = \"1 + t\"\n"
      "position = [\"L*sin(q)\", 0, \"-L*cos(q)\"]\n";
  const auto with_keys = [&](const std::string& keys) {
    std::string text = model;
    return text.replace(text.find("KEYS"), 4, keys);
  };
  for (const char* keys : {"{}", "\"rad\"", "{ range = [\"-pi\", \"L*pi\"] }", "{ armature = \"L/3\" }"}) {
    CAPTURE(std::string(keys));
    CHECK(read(with_keys(keys)).coordinates.size() == 1);
  }
  CHECK_THROWS_WITH_AS(read(with_keys("{ unit = \"m\" }")), doctest::Contains("the units clash"), eomgen::Error);
}

TEST_CASE("units: a literal zero fits any unit, also as the vector to a point of contact") {
  const auto sliding_at = [](const std::string& at) {
    return read(
               "format = 1\n[parameters]\nM = \"3 kg\"\n[[body]]\nname = \"W\"\nmass = \"M\"\n"
               "inertia = \"1 kg*m^2\"\nposition = { cartesian = [\"X\", \"Y\"] }\n"
               "rotation = { axis = \"E3\", angle = \"q\" }\n[[constraint]]\nname = \"floor\"\n"
               "sliding = { body = \"W\", at = " +
               at + ", on = { point = \"origin\", normal = \"E2\" } }\n")
        .constraints.size();
  };
  CHECK(sliding_at("0") == sliding_at("\"0[m]*E2\""));
  CHECK_THROWS_WITH_AS(sliding_at("\"1[s]*E2\""), doctest::Contains("the units clash"), eomgen::Error);
}
